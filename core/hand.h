// SPDX-License-Identifier: MIT
// Kernel 1: 24 joints from one number. Every finger is a planar chain: from its metacarpal base it runs along `forward` and curls towards `palmward`,
// so that a segment at the cumulative angle a points along cos a forward + sin a palmward.
#pragma once

#include <array>
#include <vector>

#include "core/real.h"

namespace CORE_NS {

// Plane of a finger in the hand frame, or placed in the vessel frame.
struct FingerFrame {
  Vec3 base{};      // metacarpal base, m
  Vec3 forward{};   // unit: along the straight finger
  Vec3 palmward{};  // unit: the way it curls
};

// The prepared hand (core/prepare.h) at scale 1: lengths, radii, angles at closure 0 and their swing to closure 1.
struct Hand {
  std::array<FingerFrame, FINGERS> frame{};           // hand frame
  std::array<std::array<Real, 4>, FINGERS> length{};  // m
  std::array<std::array<Real, 5>, FINGERS> radius{};  // m
  Vec3 thumb_open{}, thumb_swing{};                   // abduction, MCP, IP: rad
  Vec3 finger_open{}, finger_swing{};                 // MCP, PIP, DIP: rad
  Vec3 joint_limit{};                                 // MCP, PIP, DIP: rad
  Real max_angle = 0, paper_max_angle = 0;            // rad
  Real contact_tolerance = 0, depth_limit = 0;        // m, not scaled
  int between = 0;                                    // spheres on a bone between its joints
  Real scale = 1;
  Real gap_open = 0, gap_closed = 0;  // g(0), g(1) at scale 1, m
  std::vector<Real> gap_table;        // closure at equal steps of the gap from g(0) to g(1), two entries or more
  Limits limits;
};

// Positions of the three joints beyond the MCP.
struct FingerPoints {
  Vec3 pip{}, dip{}, tip{};
};

// Joint angles on the predefined trajectory at a closure in [0, 1], rad.
Vec3 thumb_angles(const Hand& hand, Real closure);
Vec3 finger_angles(const Hand& hand, Real closure);
// End of a segment of `length` m that starts at `start` at the cumulative angle `angle`.
Vec3 segment_end(FingerFrame frame, Vec3 start, Real length, Real angle);
// PIP, DIP and tip for the joint angles (MCP, PIP, DIP), from the MCP at `mcp`; lengths L1, L2, L3 in m.
FingerPoints finger_points(FingerFrame frame, Vec3 mcp, Vec3 lengths, Vec3 angles);
// MCP, IP and tip of a thumb (in `pip`, `dip`, `tip`) for the joint angles (abduction, MCP, IP); lengths L0, L1, L2 in m.
FingerPoints thumb_points(FingerFrame frame, Vec3 lengths, Vec3 angles);
// Thumb tip to index tip in the hand frame at scale 1, m, and its derivative by closure.
Vec3 tip_to_tip(const Hand& hand, Real closure, Vec3& slope);
// The gap g(c) = |T(c)| at scale 1, m.
inline Real gap_at(const Hand& hand, Real closure) {
  Vec3 slope{};
  return glm::length(tip_to_tip(hand, closure, slope));
}
// The closure whose gap is `gap` (scale 1, m, within [g(1), g(0)]), to `tolerance` m: Newton from the table, kept in its bracket. With gap_steps 0,
// the table's interpolated value.
Real closure_of_gap(const Hand& hand, Real gap, Real tolerance);

}  // namespace CORE_NS
