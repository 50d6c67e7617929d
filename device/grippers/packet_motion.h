// SPDX-License-Identifier: MIT
// From measurements that come a few dozen times a second to one in each tick.
#pragma once

#include <array>
#include <cstdint>

#include "core/quaternion.h"
#include "core/real.h"
#include "device/session/tick.h"

namespace wholehand {

// Goes evenly to the newest measurement, and rests there until the next: in as much time as lay between two of them, the longest of the last
// INTERVALS, and a longer one before them is forgotten slowly. So a sender of one measurement a tick is followed at once, and one of 60 Hz a
// sixtieth of a second late. Where packets bunch, the motion is no faster than about twice that of the sender. Nothing is extrapolated: the motion
// never passes what was measured. The ticks are the only clock.
class PacketMotion {
 public:
  // `rate`: ticks a second.
  explicit PacketMotion(double rate) : period_(1 / rate), span_(LONGEST) {}

  // It is there from this tick on.
  void start(const GripperState& state, std::int64_t tick) noexcept;
  // A measurement has come by this tick; finite, with a rotation. Its buttons count at once.
  void aim(const GripperState& goal, std::int64_t tick) noexcept;
  // Place, rotation, gap and buttons at a tick, ticks ascending.
  void move(GripperState& state, std::int64_t tick) noexcept;

  // Since the last measurement, s.
  double silence(std::int64_t tick) const noexcept { return period_ * static_cast<double>(tick - heard_); }
  // The time that it takes to the newest measurement, s.
  double span() const noexcept { return span_; }

  static constexpr double LONGEST = 50e-3;  // s: a sender that is silent for longer is gone
  static constexpr double FORGETS =
      0.2;  // s: the span falls by no larger share than 1/e in it, and the hand by a third faster than its sender
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
  std::int64_t moved_ = 0;  // the last tick that was asked for
  std::int64_t heard_ = 0;  // tick of the last measurement
};

// Finds a sender that jumps: PacketMotion would make a quick move of it. A step between two measurements must not be faster than is
// allowed, in the time between them or in the mean of the last INTERVALS, whichever is longer: measurements that were late come in
// bunches. A tick more, as arrivals are known in whole ticks. Until INTERVALS have come, a missing one counts as LONGEST.
class PacketSteps {
 public:
  // `rate`: ticks a second; `jump` in m/s of place and gap, `turn` in rad/s.
  PacketSteps(double rate, double jump, double turn) noexcept;

  void start(const GripperState& state, std::int64_t tick) noexcept;
  // Whether the step from the measurement before is allowed. Each measurement counts, also several of a tick; finite, with a rotation.
  bool allows(const GripperState& state, std::int64_t tick) noexcept;

 private:
  double period_, jump_, turn_;
  std::array<double, PacketMotion::INTERVALS> intervals_{};  // s, in a ring
  std::uint32_t next_ = 0;                                   // in it
  GripperState before_;
  std::int64_t heard_ = 0;  // its tick
};

}  // namespace wholehand
