// SPDX-License-Identifier: MIT
// Two tips in space as a gripper: the line between them, and what a gripper's force is on each of them. Device frame.
#pragma once

#include <array>

#include "core/scene.h"
#include "device/session/tick.h"

namespace wholehand::device {

// The direction of the closing line, from the left tip to the right one. Tips that touch have none, so that it follows the tips the more slowly the
// nearer they are: at most at TURN, and at CLEAR or less between them by the square of their distance slower.
class ClosingLine {
 public:
  static constexpr double TURN = 50;      // rad/s: faster than a wrist (30), and below the jump of the guard (100)
  static constexpr double CLEAR = 20e-3;  // m

  // The next `seconds`, with the right tip at `between` from the left one, m.
  void follow(const Triple& between, double seconds) noexcept;
  const Triple& direction() const noexcept { return direction_; }

 private:
  Triple direction_{1, 0, 0};
};

// The smallest rotation that takes +x to a unit vector: roll about it is not measured. Within 2.6 degrees of -x it has no definite axis, and the
// rotation is `previous`.
Rotation rotation_along(const Triple& direction, const Rotation& previous) noexcept;

// The force, or one of its direction that is not larger than `most`, N.
Triple capped(const Triple& force, double most) noexcept;

// Forces on the left and the right tip, N, by the unit vector from left to right (see GripperForce). Each is capped.
std::array<Triple, 2> tip_forces(const GripperForce& force, const Triple& direction, double most) noexcept;

}  // namespace wholehand::device
