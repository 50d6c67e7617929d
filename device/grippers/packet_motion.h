// SPDX-License-Identifier: MIT
// Interpolates measurements that come a few dozen times a second to one in each tick.
#pragma once

#include <array>
#include <cstdint>

#include "core/quaternion.h"
#include "core/real.h"
#include "device/session/tick.h"

namespace wholehand::device {

// Moves evenly to the newest measurement, and rests there until the next. A move takes as long as the longest of the last INTERVALS between
// measurements; a longer earlier one is forgotten slowly. So a sender of one measurement per tick is followed at once, and one of 60 Hz a sixtieth of
// a second late. If packets bunch, the motion is at most about twice as fast as the sender. Nothing is extrapolated, so the motion never passes the
// measurements. The ticks are the only clock.
class PacketMotion {
 public:
  // `rate`: ticks a second.
  explicit PacketMotion(double rate) : period_(1 / rate), span_(LONGEST) {}

  // The hand is there from this tick on.
  void start(const GripperState& state, std::int64_t tick) noexcept;
  // A measurement has arrived by this tick; finite, with a rotation. Its buttons count at once.
  void aim(const GripperState& goal, std::int64_t tick) noexcept;
  // Place, rotation, gap and buttons at a tick, ticks ascending.
  void move(GripperState& state, std::int64_t tick) noexcept;

  // Time since the last measurement, s.
  double silence(std::int64_t tick) const noexcept { return period_ * static_cast<double>(tick - heard_); }
  // The duration of the move to the newest measurement, s.
  double span() const noexcept { return span_; }

  static constexpr double LONGEST = 50e-3;  // s: a sender that is silent for longer counts as gone
  static constexpr double FORGETS =
      0.2;  // s: in this time the span falls at most to 1/e, and the hand moves at most a third faster than its sender
  static constexpr int INTERVALS = 16;  // in which whole ticks show an interval's fraction

 private:
  struct Pose {
    core_f64::Vec3 place{};
    glm::dquat turn{1, 0, 0, 0};
    double gap = 0;  // m
  };
  static Pose pose_of(const GripperState& state) noexcept;
  Pose at(std::int64_t tick) const noexcept;

  double period_, span_;                       // s
  std::array<double, INTERVALS> intervals_{};  // s, in a ring
  std::uint32_t next_ = 0;                     // in it
  Pose from_, goal_;
  std::uint32_t buttons_ = 0;
  std::int64_t began_ = 0;  // tick at from_
  std::int64_t moved_ = 0;  // the last requested tick
  std::int64_t heard_ = 0;  // tick of the last measurement
};

// Detects a sender that jumps, which PacketMotion would turn into a quick move. A step between two measurements must not exceed the allowed speed
// over the time between them or the mean of the last INTERVALS, whichever is longer, because late measurements come in bunches. One more tick is
// added, because arrivals are known in whole ticks. Until INTERVALS have come, a missing one counts as LONGEST.
class PacketSteps {
 public:
  // `rate`: ticks per second; `jump` in m/s for place and gap, `turn` in rad/s.
  PacketSteps(double rate, double jump, double turn) noexcept;

  void start(const GripperState& state, std::int64_t tick) noexcept;
  // Whether the step from the previous measurement is allowed. Every measurement counts, even several in a tick; finite, with a rotation.
  bool allows(const GripperState& state, std::int64_t tick) noexcept;

 private:
  double period_, jump_, turn_;
  std::array<double, PacketMotion::INTERVALS> intervals_{};  // s, in a ring
  std::uint32_t next_ = 0;                                   // in it
  GripperState before_;
  std::int64_t heard_ = 0;  // its tick
};

}  // namespace wholehand::device
