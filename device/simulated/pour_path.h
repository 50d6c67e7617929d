// SPDX-License-Identifier: MIT
// How a held vessel is brought over a target and tilted there: as low as it and the hand keep clear of the target's wall.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/real.h"
#include "core/result.h"
#include "core/scene.h"

namespace wholehand {

// A ball that moves with the tips' middle, from it in the gripper's axes as they are while the vessel stands upright, m; world of the right hand.
struct HeldBall {
  core_f64::Vec3 place{};
  double radius = 0;
};

// The hand's 24 points at a grip, and points of the vessel's outer surface, a few millimeters apart. A mesh has them all over:
// no place on its surface is further than 5 mm from a point.
std::vector<HeldBall> held_hand(const HandData& hand, const GripInput& grip, const GripResult& result);
std::vector<HeldBall> held_vessel(const VesselData& vessel, const GripInput& grip, Handedness handedness);

// A copy allocates nothing.
class PourPath {
 public:
  // Tilted away from the user (top towards -z), the lip's lowest point is over the target's mouth, nearer to the user than its middle. `task` has
  // the target; what is held keeps off its wall, and over the table that the vessel stood on.
  PourPath(const TaskData& task, const VesselData& vessel, const HandData& hand, const GripInput& grip, const GripResult& result);
  // Nothing is poured: as high as the table.
  PourPath() = default;

  // The middle of the tips, world of the right hand, m; continuous in the tilt (rad). Beyond SIM_LARGEST_TILT it stays as there.
  core_f64::Vec3 middle(double tilt) const noexcept;

 private:
  core_f64::Vec3 lip_{};  // of the middle of the tips where the gripper is not tilted: the lip's point on the side where it pours
  core_f64::Vec3 aim_{};  // where it is to be, but for the height
  static constexpr std::size_t DEGREES = 141;  // 0 to SIM_LARGEST_TILT
  std::array<double, DEGREES> up_{};           // heights of the middle, m, by whole degrees of tilt
  bool is_empty_ = true;                       // nothing is poured
};

constexpr double SIM_LARGEST_TILT = radians(140);

}  // namespace wholehand
