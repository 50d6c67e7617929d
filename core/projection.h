// SPDX-License-Identifier: MIT
// Kernel 5: brings middle, ring and little finger to rest on the vessel.
#pragma once

#include <algorithm>
#include <array>

#include "core/body.h"
#include "core/hand.h"
#include "core/sdf.h"

namespace CORE_NS {

// A moving finger (pose `articulated`). Its segments lie in a plane, each at the cumulative angle of the joints before it, rad.
struct FingerMotion {
  Vec3 origin{};           // of the segments at the start of this stage, rad
  Vec3 rates{};            // their rates: rad per unit of `at`
  int joint = -1;          // -1: swings along its trajectory; 0..2: this joint turns alone; 3: at rest
  Real at = 0, end = 0;    // how far this stage has gone, and may go: closure in a swing, otherwise rad
  int steps = 0;           // of this stage
  bool blocked = false;    // a watched place was inside when open
  bool unsettled = false;  // took all its steps

  // A step until a place is due, or to the end of the stage. False: all `most` steps are taken, and it stays.
  bool advance(Real due, int most) {
    const bool has_steps = steps < most;
    if (has_steps) at = std::min(due, end);
    unsettled = unsettled || !has_steps;
    ++steps;
    return has_steps;
  }
};

// The axis about which the points of pose `paper` turn; only its origin differs between them.
struct PaperAxis {
  Vec3 direction{};  // unit, signed so that positive angles carry the index tip towards the thumb tip
  bool exists = false;
};

// A finger in the vessel frame, m. Lengths: of the three bones beyond the MCP; radii: at MCP, PIP, DIP and tip.
struct Finger {
  FingerFrame frame;
  Vec3 mcp{};
  Vec3 lengths{};
  std::array<Real, 4> radii{};
};

// A finger's segments from the MCP outward, in its plane: components along `forward` and `palmward`, m.
struct Bend {
  Vec3 along{}, across{};
};

// A place that a finger watches, and its motion in the finger's plane per unit of the stage (closure in a swing, otherwise rad): components along
// `forward` and `palmward`. speed, bend and jerk bound its first three derivatives at all angles.
struct Place {
  Ball ball;
  Vec2 velocity{}, acceleration{};
  Real speed = 0, bend = 0, jerk = 0;
};

// A finger's record of the points that it watches, numbered from the MCP outward: the `between` spheres of a bone, then the joint that ends it. At
// the start of a stage it evaluates the points one by one (a survey), and then moves from one due point to the next.
struct FingerWatch {
  std::array<Real, 3 * (MOST_BETWEEN + 1)> until{};  // how far this stage may go before the point could touch
  Vec3 separations{};                                // of PIP, DIP and tip at their last evaluation, m
  Vec3 before{};                                     // the same when the finger left its trajectory
  Vec3 clear{NO_DISTANCE};                           // the least separation of a bone's points since the survey began, m
  int number = 0;                                    // of the point to evaluate now
  int touched = -1;                                  // point that ended the previous stage, and is not evaluated again; -1: none
  bool looks = true;                                 // a survey is in progress
  bool swings = true;                                // `before` is not final yet
};

// Where a finger came to rest.
struct RestingFinger {
  Vec3 angles{};
  FingerPoints points;
  Vec3 separations{};    // of PIP, DIP and tip, m
  Vec3 before{};         // when it left the trajectory
  int steps = 0;         // of its longest stage
  bool blocked = false;  // see FingerMotion
  bool unsettled = false;
  bool undecided = false;  // it touched or passed the wall at so flat an angle that rounding may decide which
};

// The segments' angles or rates from the joints'.
Vec3 chain_sums(Vec3 joints);
// The segments' current angles, rad.
Vec3 segment_angles(const FingerMotion& motion);
// Segments of these lengths (m) at these angles (rad, of the segments).
Bend bend_finger(Vec3 lengths, Vec3 angles);
// The place of that number, for a finger with these segments and rates.
Place watched_place(const Hand& hand, const Finger& finger, const Bend& bend, Vec3 rates, int number);
// The largest step of the motion in which the place is certain not to pass a surface.
Real place_step(Support support, Real separation, const Place& place, FingerFrame frame);
// Whether a place within CONTACT_MARGIN of the wall moves along it so that rounding may decide if it touches or passes.
bool passes_close(const Vessel& vessel, const Support& support, Real separation, const Place& place, const FingerFrame& frame);
// Number (0..2) of the smallest separation among those from `first` on; the innermost if equal.
int nearest_point(Vec3 separations, int first);
// A finger at closure 0 that may close up to `limit`.
FingerMotion start_motion(const Hand& hand, Real limit);
// The motion with `joint` about to turn alone (3: at rest).
FingerMotion turn_joint(const Hand& hand, const FingerMotion& motion, int joint);
// The place to evaluate for `number`: only the end of a bone that rests (before `joint`); none if it has just touched.
int place_to_see(const Hand& hand, int number, int joint, int touched);
// The moving place that is due first (the innermost if equal), and how far the stage may go until then.
int soonest_place(const Hand& hand, const FingerWatch& watch, int joint, Real& due);
// Stores the evaluation of a point: its separation (m) and its safe step from here.
void see_place(const Hand& hand, Real separation, Real step, const FingerMotion& motion, FingerWatch& watch);
// The joint that turns next after a survey, given the clearances `clear` of its bones; the current joint if it continues. blocked: the finger is at
// its start, and inside.
int decide_turn(const Hand& hand, Vec3 clear, const FingerMotion& motion, bool& blocked);
// The whole motion of a finger that may close up to `limit`.
RestingFinger rest_finger(const Hand& hand, const Vessel& vessel, const Finger& finger, Real limit);
// Pose `paper`: the axis through MCPs, and a point turned about it.
PaperAxis paper_axis(Vec3 index_mcp, Vec3 little_mcp, Vec3 index_tip, Vec3 thumb_tip);
Vec3 turned_point(Vec3 p, Vec3 pivot, Vec3 axis, Real angle);
// The point at the first angle in [0, max_angle] at which its separation is 0; p itself if there is none.
Vec3 project_point(const Vessel& vessel, Vec3 p, Real radius, Vec3 pivot, PaperAxis axis, Real max_angle, bool& unsettled);
// Role of a newly touching point 2..4 (PIP, DIP, tip) of a finger whose five points touched as `before` (bit k: point k):
// 0 tip, 1 finger, 2 inner.
int projection_role(int point, int before);

}  // namespace CORE_NS
