// SPDX-License-Identifier: MIT
// Kernel 5: middle, ring and little finger come to rest on the vessel.
#pragma once

#include <array>

#include "core/hand.h"
#include "core/sdf.h"

namespace CORE_NS {

// A finger on its way (pose `articulated`): where it stands, and what it does next.
struct FingerMotion {
  Vec3 angles{};              // MCP, PIP, DIP, rad
  Real closure = 0;           // while it follows its trajectory
  Real limit = 0;             // the index finger's closure
  int joint = -1;             // -1: on the trajectory; 0..2: this joint turns alone; 3: at rest
  Real start = 0;             // angle at which the turning joint set out, rad
  Real turned = 0, room = 0;  // rad
  int steps = 0;              // of this stage
  Vec3 before{};              // separations of PIP, DIP, tip when it left the trajectory, m
  bool blocked = false;       // a watched point was inside when open
  bool unsettled = false;     // took all its steps
};

// The axis about which the points of pose `paper` turn, the same for all but its origin.
struct PaperAxis {
  Vec3 direction{};  // unit, signed so that positive angles carry the index tip towards the thumb tip
  bool exists = false;
};

// What surrounds the three watched points PIP, DIP and tip, and the spheres on the bones that end there.
struct Watch {
  Support pip, dip, tip;
  Vec3 separations{};               // distance less radius, m
  Vec3 clear{};                     // the least separation of a point and the spheres of the bone that ends there, m
  Real between_step = NO_DISTANCE;  // the spheres' smallest safe step
};

// Rates at which the segments beyond PIP, DIP and DIP's end turn: cumulative joint swings along the trajectory (joint -1; rad per unit
// of closure), or 1 for the segments that a joint turns alone (joint 0..2).
Vec3 segment_rates(Vec3 swing, int joint);
// A segment turned a quarter in its finger's plane: the velocity of its end for a unit rate.
Vec3 quarter_turn(FingerFrame frame, Vec3 segment);
// The smallest safe step of the three points for these rates.
Real finger_step(FingerFrame frame, Vec3 mcp, FingerPoints points, Watch watch, Vec3 lengths, Vec3 rates);
// Number (0..2) of the smallest separation among those from `first` on; of equal ones the innermost.
int nearest_point(Vec3 separations, int first);
// A finger at closure 0 that may go up to `limit`.
FingerMotion start_motion(const Hand& hand, Real limit);
// PIP, DIP and tip among the surroundings, with the radii given.
Watch watch_points(const Vessel& vessel, FingerPoints points, Vec3 radii);
// Adds the spheres between the joints to the watch: hand.between on each of the bones from `joint` on, which turns (-1: all three swing).
// radii: MCP, PIP, DIP, tip. Their step has the unit of the motion's: closure in a swing, and otherwise radians.
void watch_between(const Hand& hand, const Vessel& vessel, FingerFrame frame, Vec3 mcp, FingerPoints points,
                   const std::array<Real, 4>& radii, Vec3 lengths, int joint, Watch& watch);
// The motion with `joint` about to turn alone (3: at rest).
FingerMotion turn_joint(const Hand& hand, FingerMotion motion, int joint);
// One step of conservative advancement: given the points at the motion's angles and what surrounds them, the motion after its next move.
// Where spheres are watched and another joint's turn comes, it does not move yet: their step was that of the joint before.
FingerMotion advance_finger(const Hand& hand, FingerMotion motion, FingerFrame frame, Vec3 mcp, FingerPoints points, Watch watch,
                            Vec3 lengths);
// Pose `paper`: the axis through MCPs, and a point turned about it.
PaperAxis paper_axis(Vec3 index_mcp, Vec3 little_mcp, Vec3 index_tip, Vec3 thumb_tip);
Vec3 turned_point(Vec3 p, Vec3 pivot, Vec3 axis, Real angle);
// The point at the first angle in [0, max_angle] at which its separation is 0; p itself where there is none.
Vec3 project_point(const Vessel& vessel, Vec3 p, Real radius, Vec3 pivot, PaperAxis axis, Real max_angle, bool& unsettled);
// Role of a newly touching point 2..4 (PIP, DIP, tip) of a finger whose five points touched as `before` (bit k: point k):
// 0 tip, 1 finger, 2 inner.
int projection_role(int point, int before);

}  // namespace CORE_NS
