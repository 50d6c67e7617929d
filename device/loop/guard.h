// SPDX-License-Identifier: MIT
// What stands between the method and the fingers: whatever is wrong ends in no force, and what is right comes within limits.
#pragma once

#include <cstdint>
#include <string>

#include "core/scene.h"
#include "device/loop/gripper.h"

namespace wholehand {

// Checks every read and limits every write of a session. Neither allocates nor throws.
class Guard {
 public:
  Guard(const LiveData& live, const GripperLimits& limits);

  // Why the tick of that number must not go on; Fault::none: it may. In this order: the read failed; the measurement before came once more; a
  // number that is none or a rotation that is none (its columns must be unit and right-handed to ROTATION_TOLERANCE); the arm or the gap
  // moved faster than [live] jump_m_s, or the rotation faster than JUMP_TURN. A measurement that comes after missed ticks of CALL_PATIENCE and
  // longer may have been taken before them. What moved since then is compared with the whole time.
  Fault check(ReadOutcome read, const GripperState& state, std::int64_t number) noexcept;

  // What jumped, how fast, and what is allowed, for the fault of that name.
  std::string jump() const;

  // The force to write: `wanted` no larger than the device's limits (the arm keeps its direction), times the ramp from zero over the first
  // ramp_s of ticks, and no further from the force before than slew_N_s allows, arm and grip each. A force that is no number is none. After
  // ticks that were missed for STALL and longer, in which a device's own watchdog may have let go, the first is zero, whatever the ramp, and it all
  // begins again.
  GripperForce limit(const GripperForce& wanted, std::int64_t number) noexcept;

  // The least number of periods that make a stall.
  std::int64_t stall_periods() const noexcept;

 private:
  double force_, grip_;                                    // N
  double period_, ramp_;                                   // s
  double slew_, jump_;                                     // N/s, m/s
  bool has_state_ = false;                                 // a measurement came before
  GripperState state_;                                     // it
  std::int64_t number_ = 0;                                // its tick
  std::int64_t taken_ = 0;                                 // the earliest tick in which it may have been taken
  std::int64_t first_ = -1;                                // tick of the first force; -1: none yet
  std::int64_t limited_ = 0;                               // tick of the force before
  GripperForce written_;                                   // that force
  double arm_speed_ = 0, gap_speed_ = 0, turn_speed_ = 0;  // m/s, m/s, rad/s: of the last two measurements
};

// Angle between two rotations, rad: for small ones.
double turned_by(const Rotation& a, const Rotation& b) noexcept;

constexpr double ROTATION_TOLERANCE = 1e-3;  // a tenth of a degree of skew is a broken sensor
constexpr double STALL = 15e-3;              // s: less than the watchdog that a device is given
constexpr double JUMP_TURN = 100;            // rad/s: a quick wrist turns at 30

}  // namespace wholehand
