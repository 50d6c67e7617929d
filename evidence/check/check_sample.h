// SPDX-License-Identifier: MIT
// The grips that `wholehand check` compares: the scene's own and, if these are few, others between and around them.
#pragma once

#include <cstddef>
#include <vector>

#include "core/result.h"
#include "sweeps/plan/plan.h"

namespace wholehand {

constexpr std::size_t MOST_CHECKED_GRIPS = 1536;    // of a vessel: a larger plan is sampled evenly down to this
constexpr std::size_t FEWEST_CHECKED_GRIPS = 1024;  // of a vessel: a smaller plan is filled up to this

struct CheckSample {
  std::vector<GripInput> grips;  // the scene's own first
  std::size_t own = 0;
};

// The sample of one vessel. Grips beyond the scene's own are Sobol points of the box from each axis's smallest value to its largest. An axis of one
// value is widened to both sides: height by 5 % of the vessel's height (a height_fraction stays within 0..1), azimuth and roll by 15 degrees,
// obliquity by 5 (within -90..90), offset by 5 % of the hand's 100 mm times its scale, hand_scale by 5 % (within float's domain, and not upwards if a
// vessel is a mesh, whose lattice is made for the scene's hands).
CheckSample check_sample(const Scene& scene, const sweeps::Plan& plan, std::size_t vessel);

}  // namespace wholehand
