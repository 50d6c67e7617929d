// SPDX-License-Identifier: MIT
// Stands between the method and the fingers: any fault ends in zero force, and valid forces are kept within limits.
#pragma once

#include <cstdint>
#include <string>

#include "core/scene.h"
#include "device/loop/gripper.h"

namespace wholehand::device {

// Checks every read and limits every write of a session. Neither allocates nor throws.
class Guard {
 public:
  Guard(const LiveData& live, const GripperLimits& limits);

  // Why the tick of that number must not proceed; Fault::none: it may. Checks, in this order: the read failed; the previous measurement was repeated;
  // a number is not finite or a rotation is invalid (its columns must be unit and right-handed to ROTATION_TOLERANCE); the arm or the gap moved
  // faster than [live] jump_m_s, or the rotation faster than JUMP_TURN. After missed ticks of CALL_PATIENCE or longer, a measurement may predate
  // them, so its motion is compared with the whole time.
  Fault check(ReadOutcome read, const GripperState& state, std::int64_t number) noexcept;

  // What jumped, how fast, and what is allowed, for the fault `jump`.
  std::string jump() const;

  // The force to write: `wanted` clamped to the device's limits (the arm keeps its direction, and so does what is across, limited as the grip; a device
  // that cannot push each tip gets none of it), times the ramp from zero over the first ramp_s of ticks, and no further from the previous force than
  // slew_N_s allows, each of the three. A force that is not finite counts as zero. After missed ticks of STALL or longer, in which a device's own
  // watchdog may have acted, the first force is zero, whatever the ramp, and the ramp restarts.
  GripperForce limit(const GripperForce& wanted, std::int64_t number) noexcept;

  // The smallest number of periods that counts as a stall.
  std::int64_t stall_periods() const noexcept;

 private:
  double force_, grip_, across_;                           // N
  double period_, ramp_;                                   // s
  double slew_, jump_;                                     // N/s, m/s
  bool has_state_ = false;                                 // a measurement came before
  GripperState state_;                                     // it
  std::int64_t number_ = 0;                                // its tick
  std::int64_t taken_ = 0;                                 // the earliest tick in which the measurement may have been taken
  std::int64_t first_ = -1;                                // tick of the first force; -1: none yet
  std::int64_t limited_ = 0;                               // tick of the previous force
  GripperForce written_;                                   // that force
  double arm_speed_ = 0, gap_speed_ = 0, turn_speed_ = 0;  // m/s, m/s, rad/s: of the last two measurements
};

// Angle between two rotations, rad: accurate for small ones.
double turned_by(const Rotation& a, const Rotation& b) noexcept;

constexpr double STALL = 15e-3;    // s: less than the watchdog period of a device
constexpr double JUMP_TURN = 100;  // rad/s: a quick wrist turns at 30

}  // namespace wholehand::device
