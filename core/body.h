// SPDX-License-Identifier: MIT
// Kernel 8: the hand between its joints. A bone is a rounded cone whose radius varies linearly from one joint to the next.
#pragma once

#include "core/hand.h"

namespace CORE_NS {

// A sphere of the hand, m.
struct Ball {
  Vec3 place{};
  Real radius = 0;
};

// The sphere at `share` (0 to 1) of the way along a bone, from its joint at `start` to that at `end`. m.
Ball ball_between(Vec3 start, Vec3 end, Real start_radius, Real end_radius, Real share);
// A sphere that encloses the bone between two joints.
Ball around_bone(Ball start, Ball end);
// Whether two spheres overlap by more than `deepest`, m.
bool overlap_more(Ball a, Ball b, Real deepest);
// Clamps x to [0, 1]; NaN gives 0.
Real nearest_share(Real x);
// The overlap of two bones, m, or `deepest` if that is more: radii less the distance of the axes, at the nearest points and at the four ends.
// Negative: a gap. A bone without length counts as its start. After C. Ericson, Real-Time Collision Detection, 2005, section 5.1.9.
Real bones_overlap(Vec3 a, Vec3 a_end, Vec2 a_radii, Vec3 b, Vec3 b_end, Vec2 b_radii, Real deepest);

}  // namespace CORE_NS
