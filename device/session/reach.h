// SPDX-License-Identifier: MIT
// Limits on measurements that no gripper's guard has checked.
#pragma once

#include <cmath>
#include <cstdint>

#include "device/session/tick.h"

namespace wholehand {

constexpr std::int64_t LAST_TICK = std::int64_t{1} << 53;  // a time is this number over the rate, as a double
// m: the limit of a scene's points. No arm reaches further, and differences lose their digits there.
constexpr double FURTHEST_POSITION = 25;
constexpr double WIDEST_GAP = 10;  // m, either way

// Whether a finite measurement is within reach.
inline bool is_in_reach(const GripperState& state) noexcept {
  for (const double x : state.position)
    if (std::abs(x) > FURTHEST_POSITION) return false;
  return std::abs(state.gap) <= WIDEST_GAP;
}

}  // namespace wholehand
