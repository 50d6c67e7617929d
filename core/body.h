// SPDX-License-Identifier: MIT
// Kernel 8: the hand between its joints. A bone is a rounded cone: its radius goes evenly from that of one joint to that of the next.
#pragma once

#include "core/hand.h"

namespace CORE_NS {

// A sphere of the hand, m.
struct Ball {
  Vec3 place{};
  Real radius = 0;
};

// The sphere of a bone at `share` of the way, in [0, 1], from its joint at `start` to that at `end`. m.
Ball ball_between(Vec3 start, Vec3 end, Real start_radius, Real end_radius, Real share);
// A sphere that the bone between two joints lies in.
Ball around_bone(Ball start, Ball end);
// Whether two spheres lie deeper in each other than `deepest`, m.
bool overlap_more(Ball a, Ball b, Real deepest);
// The number of [0, 1] that is nearest to x; 0 where x is not a number.
Real nearest_share(Real x);
// How deep two bones lie in each other, m, or `deepest` where that is more: radii less the distance of the axes, where these are nearest
// and at the four ends. Negative: they are apart. A bone of no length counts as its start. After C. Ericson, Real-Time Collision
// Detection, 2005, section 5.1.9.
Real bones_overlap(Vec3 a, Vec3 a_end, Vec2 a_radii, Vec3 b, Vec3 b_end, Vec2 b_radii, Real deepest);

}  // namespace CORE_NS
