// SPDX-License-Identifier: MIT
// The path of a held vessel over a target and tilted there: as low as it and the hand keep clear of the target's wall.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/real.h"
#include "core/result.h"
#include "core/scene.h"

namespace wholehand::device {

// A ball that moves with the tips' middle: its offset in the gripper's axes while the vessel stands upright, m; world of the right hand.
struct HeldBall {
  core_f64::Vec3 place{};
  double radius = 0;
};

// The hand's 24 points at a grip, and points of the vessel's outer surface, a few millimeters apart. A mesh is covered so that no point of its
// surface is further than 5 mm from one.
std::vector<HeldBall> held_hand(const HandData& hand, const GripInput& grip, const GripResult& result);
std::vector<HeldBall> held_vessel(const VesselData& vessel, const GripInput& grip, Handedness handedness);

// A copy allocates nothing.
class PourPath {
 public:
  // Tilted away from the user (top towards -z), the lip's lowest point is over the target's mouth, nearer to the user than its middle. `task` has the
  // target; the held vessel and hand keep clear of its wall, and above the table that the vessel stood on.
  PourPath(const TaskData& task, const VesselData& vessel, const HandData& hand, const GripInput& grip, const GripResult& result);
  // Without pouring: as high as the table requires.
  PourPath() = default;

  // The middle of the tips, world of the right hand, m; continuous in the tilt (rad), constant above SIM_LARGEST_TILT.
  core_f64::Vec3 middle(double tilt) const noexcept;

 private:
  core_f64::Vec3 lip_{};  // of the middle of the tips where the gripper is not tilted: the lip's point on the side where it pours
  core_f64::Vec3 aim_{};  // its target, except for the height
  static constexpr std::size_t DEGREES = 141;  // 0 to SIM_LARGEST_TILT
  std::array<double, DEGREES> up_{};           // heights of the middle, m, by whole degrees of tilt
  bool is_empty_ = true;                       // nothing is poured
};

constexpr double SIM_LARGEST_TILT = radians(140);

}  // namespace wholehand::device
