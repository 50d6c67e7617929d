// SPDX-License-Identifier: MIT
#include "device/loop/guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/vectors.h"
#include "device/loop/call_watch.h"

namespace wholehand::device {
// The length of their difference over the root of two.
double turned_by(const Rotation& a, const Rotation& b) noexcept {
  double squares = 0;
  for (int k = 0; k < 9; ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(0.5 * squares);
}

namespace {

// `wanted` cut to a length of `limit`, times the ramp, and no further than `most` from the force before.
void approach(Triple& written, const Triple& wanted, double limit, double ramp, double most) noexcept {
  const double size = norm(wanted);
  const double factor = ramp * (size > limit ? limit / size : 1);
  Triple change{};
  for (int k = 0; k < 3; ++k) change[k] = factor * wanted[k] - written[k];
  const double changed = norm(change);
  const double part = changed > most ? most / changed : 1;
  for (int k = 0; k < 3; ++k) written[k] += part * change[k];
}

}  // namespace

Guard::Guard(const LiveData& live, const GripperLimits& limits)
    : force_(limits.force),
      grip_(limits.grip),
      across_(limits.pushes_each_tip ? limits.grip : 0),
      period_(1 / live.rate),
      ramp_(live.ramp),
      slew_(live.slew),
      jump_(live.jump) {}

Fault Guard::check(ReadOutcome read, const GripperState& state, std::int64_t number) noexcept {
  if (read == ReadOutcome::error) return Fault::read_error;
  if (read == ReadOutcome::timeout) return Fault::timeout;
  if (has_state_ && state.sequence == state_.sequence) return Fault::stale;
  if (!is_finite(state) || !is_rotation(state.rotation, ROTATION_TOLERANCE)) return Fault::not_finite;
  if (has_state_) {
    const double seconds = period_ * static_cast<double>(std::max<std::int64_t>(1, number - taken_));
    arm_speed_ = distance(state.position, state_.position) / seconds;
    gap_speed_ = std::abs(state.gap - state_.gap) / seconds;
    turn_speed_ = turned_by(state.rotation, state_.rotation) / seconds;
    if (arm_speed_ > jump_ || gap_speed_ > jump_ || turn_speed_ > JUMP_TURN) return Fault::jump;
  }
  // A process that stalls inside a read gets its measurement late. A replay sees that from the tick numbers.
  const bool is_after_gap = has_state_ && period_ * static_cast<double>(number - number_) >= CALL_PATIENCE;
  taken_ = is_after_gap ? number_ : number;
  has_state_ = true;
  state_ = state;
  number_ = number;
  return Fault::none;
}

std::string Guard::jump() const {
  if (arm_speed_ > jump_) return fmt::format("its place by {:.3g} m/s; allowed: up to {:g}, [live] jump_m_s", arm_speed_, jump_);
  if (gap_speed_ > jump_) return fmt::format("its gap by {:.3g} m/s; allowed: up to {:g}, [live] jump_m_s", gap_speed_, jump_);
  return fmt::format("its rotation by {:.3g} rad/s; allowed: up to {:g}", turn_speed_, JUMP_TURN);
}

std::int64_t Guard::stall_periods() const noexcept {
  auto periods = static_cast<std::int64_t>(STALL / period_);
  while (period_ * static_cast<double>(periods) < STALL) ++periods;
  return periods;
}

GripperForce Guard::limit(const GripperForce& wanted, std::int64_t number) noexcept {
  if (first_ >= 0 && number - limited_ >= stall_periods()) {
    first_ = limited_ = number;
    return written_ = {};
  }
  const bool is_first = first_ < 0;
  if (is_first) first_ = number;
  const double ramp = ramp_ > 0 ? std::clamp(period_ * static_cast<double>(number - first_) / ramp_, 0.0, 1.0) : 1;
  const double seconds = period_ * static_cast<double>(is_first ? 1 : std::max<std::int64_t>(1, number - limited_));
  limited_ = number;
  const double most = slew_ * seconds;
  if (!is_finite(wanted)) return written_ = {};
  approach(written_.arm, wanted.arm, force_, ramp, most);
  approach(written_.across, wanted.across, across_, ramp, most);
  const double grip = ramp * std::clamp(wanted.grip, -grip_, grip_);
  written_.grip += std::clamp(grip - written_.grip, -most, most);
  return written_;
}

}  // namespace wholehand::device
