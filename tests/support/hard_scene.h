// SPDX-License-Identifier: MIT
// A scene and grips in which every way to fail and every term of a score comes up.
#pragma once

#include <vector>

#include "tests/support/scenes.h"

namespace wholehand {

// Scene with every kind of grip: a lopsided glass among the beakers, low friction so that some pinches do not hold, a small largest
// force and grip strength so that tilts become unsafe.
inline Scene hard_scene() {
  Scene scene = three_beakers();
  scene.vessels.push_back(lopsided());
  scene.liquid->fills = {0, 0.4, 1};
  scene.tilts = linspace(0, radians(150), 7);
  scene.force.max = 3.2;
  scene.force.grip_strength = 12;
  scene.force.friction = 0.35;
  scene.hand.depth_limit = 2e-3;
  return scene;
}

inline std::vector<GripInput> grips_with_hopeless_ones(const VesselData& vessel, std::uint64_t seed, int count = 17) {
  std::vector<GripInput> grips = sample_grips(vessel, count, seed);
  grips[3].obliquity = PI / 2;           // degenerate
  grips[7].height = 10 * vessel.height;  // misses
  grips[11].hand_scale = 0.2;            // too wide
  grips[11].offset = 0;
  grips[13] = {};  // beside the widest part: the tips of 7 and 8 mm are nearer than they are wide
  grips[13].height = 42.5e-3;
  grips[13].offset = largest_radius(vessel) + 6.9e-3;
  return grips;
}

}  // namespace wholehand
