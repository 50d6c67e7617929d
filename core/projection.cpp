// SPDX-License-Identifier: MIT
#include "core/projection.h"

#include <algorithm>
#include <cmath>

#include "core/body.h"
#include "core/trig.h"

namespace CORE_NS {

Vec3 segment_rates(Vec3 swing, int joint) {
  if (joint < 0) return Vec3(swing.x, swing.x + swing.y, swing.x + swing.y + swing.z);
  return Vec3(joint == 0 ? Real(1) : Real(0), joint <= 1 ? Real(1) : Real(0), Real(1));
}

Vec3 quarter_turn(FingerFrame frame, Vec3 segment) {
  return glm::dot(segment, frame.forward) * frame.palmward - glm::dot(segment, frame.palmward) * frame.forward;
}

// Speeds and accelerations add up along the chain: |p'| <= sum of rate times length, |p''| <= sum of rate^2 times length.
Real finger_step(FingerFrame frame, Vec3 mcp, FingerPoints points, Watch watch, Vec3 lengths, Vec3 rates) {
  const Vec3 sweep = glm::abs(rates) * lengths;
  const Vec3 bend = rates * rates * lengths;
  const Vec3 pip_velocity = rates.x * quarter_turn(frame, points.pip - mcp);
  const Vec3 dip_velocity = pip_velocity + rates.y * quarter_turn(frame, points.dip - points.pip);
  const Vec3 tip_velocity = dip_velocity + rates.z * quarter_turn(frame, points.tip - points.dip);
  const Real pip = safe_step(watch.pip, watch.separations.x, pip_velocity, sweep.x, bend.x);
  const Real dip = safe_step(watch.dip, watch.separations.y, dip_velocity, sweep.x + sweep.y, bend.x + bend.y);
  const Real tip = safe_step(watch.tip, watch.separations.z, tip_velocity, sweep.x + sweep.y + sweep.z, bend.x + bend.y + bend.z);
  return std::min(pip, std::min(dip, tip));
}

int nearest_point(Vec3 separations, int first) {
  int nearest = 2;
  Real smallest = separations.z;
  if (first <= 1 && separations.y <= smallest) {
    nearest = 1;
    smallest = separations.y;
  }
  if (first <= 0 && separations.x <= smallest) nearest = 0;
  return nearest;
}

FingerMotion start_motion(const Hand& hand, Real limit) {
  FingerMotion motion;
  motion.angles = finger_angles(hand, 0);
  motion.limit = limit;
  return motion;
}

Watch watch_points(const Vessel& vessel, FingerPoints points, Vec3 radii) {
  Watch watch;
  watch.pip = support_at(vessel, points.pip);
  watch.dip = support_at(vessel, points.dip);
  watch.tip = support_at(vessel, points.tip);
  watch.separations = Vec3(watch.pip.distance, watch.dip.distance, watch.tip.distance) - radii;
  watch.clear = watch.separations;
  return watch;
}

// A sphere moves as its place on the bone does: velocities and the bounds of speed and acceleration go evenly from end to end. Bones
// before the joint that turns rest, and advance_finger asks nothing of them.
void watch_between(const Hand& hand, const Vessel& vessel, FingerFrame frame, Vec3 mcp, FingerPoints points,
                   const std::array<Real, 4>& radii, Vec3 lengths, int joint, Watch& watch) {
  const Vec3 rates = segment_rates(hand.finger_swing, joint);
  const Vec3 sweep = glm::abs(rates) * lengths;
  const Vec3 bend = rates * rates * lengths;
  Vec3 start = mcp;
  Vec3 velocity(0);
  Real speed = 0;
  Real acceleration = 0;
  for (int bone = 0; bone < 3; ++bone) {
    const Vec3 end = bone == 0 ? points.pip : bone == 1 ? points.dip : points.tip;
    const Vec3 turn = rates[bone] * quarter_turn(frame, end - start);
    for (int k = 1; bone >= joint && k <= hand.between; ++k) {
      const Real share = Real(k) / Real(hand.between + 1);
      const Ball ball = ball_between(start, end, radii[bone], radii[bone + 1], share);
      const Support support = support_at(vessel, ball.place);
      const Real separation = support.distance - ball.radius;
      watch.clear[bone] = std::min(watch.clear[bone], separation);
      const Real step =
          safe_step(support, separation, velocity + share * turn, speed + share * sweep[bone], acceleration + share * bend[bone]);
      watch.between_step = std::min(watch.between_step, step);
    }
    start = end;
    velocity += turn;
    speed += sweep[bone];
    acceleration += bend[bone];
  }
}

FingerMotion turn_joint(const Hand& hand, FingerMotion motion, int joint) {
  FingerMotion next = motion;
  next.joint = joint;
  next.turned = 0;
  next.steps = 0;
  if (joint < 3) {
    const Real stop = joint == 0 ? hand.joint_limit.x : joint == 1 ? hand.joint_limit.y : hand.joint_limit.z;
    next.start = joint == 0 ? motion.angles.x : joint == 1 ? motion.angles.y : motion.angles.z;
    next.room = std::max(Real(0), std::min(hand.max_angle, stop - next.start));
  }
  return next;
}

// No step passes through the wall, whichever watched point is meant. Several stages may end at one position (a touch whose joint has no
// room left, say), so they are decided in turn until one of them moves.
FingerMotion advance_finger(const Hand& hand, FingerMotion motion, FingerFrame frame, Vec3 mcp, FingerPoints points, Watch watch,
                            Vec3 lengths) {
  FingerMotion next = motion;
  const Vec3 separations = watch.clear;
  if (next.joint < 0) {
    const int nearest = nearest_point(separations, 0);
    const Real clear = std::min(separations.x, std::min(separations.y, separations.z));
    next.before = watch.separations;
    if (next.closure == 0 && clear < 0) {
      next.blocked = true;
      next.joint = 3;
    } else if (clear < hand.limits.stop_tolerance) {
      next = turn_joint(hand, next, nearest + 1);
    } else if (next.closure >= next.limit) {
      next = turn_joint(hand, next, 0);
    }
  }
  for (int stage = 0; stage < 3; ++stage) {
    if (next.joint >= 0 && next.joint < 3) {
      const int nearest = nearest_point(separations, next.joint);
      const Real clear = nearest == 0 ? separations.x : nearest == 1 ? separations.y : separations.z;
      if (clear < hand.limits.stop_tolerance) {
        next = turn_joint(hand, next, nearest + 1);
      } else if (next.turned >= next.room) {
        next = turn_joint(hand, next, next.joint + 1);
      }
    }
  }
  if (next.joint >= 3 || (hand.between > 0 && next.joint != motion.joint)) return next;
  if (next.steps >= hand.limits.advance_steps) {
    next.unsettled = true;
    next.joint = 3;
    return next;
  }
  const Vec3 rates = segment_rates(hand.finger_swing, next.joint);
  const Real step = std::min(finger_step(frame, mcp, points, watch, lengths, rates), watch.between_step);
  next.steps = next.steps + 1;
  if (next.joint < 0) {
    next.closure = std::min(next.closure + step, next.limit);
    next.angles = finger_angles(hand, next.closure);
    return next;
  }
  next.turned = std::min(next.turned + step, next.room);
  const Real angle = next.start + next.turned;
  if (next.joint == 0) next.angles.x = angle;
  if (next.joint == 1) next.angles.y = angle;
  if (next.joint == 2) next.angles.z = angle;
  return next;
}

PaperAxis paper_axis(Vec3 index_mcp, Vec3 little_mcp, Vec3 index_tip, Vec3 thumb_tip) {
  PaperAxis axis;
  const Vec3 across = little_mcp - index_mcp;
  const Real width = glm::length(across);
  axis.exists = width > Real(AXIS_DISTANCE);
  if (!axis.exists) return axis;
  axis.direction = across / width;
  const Real sense = glm::dot(glm::cross(axis.direction, index_tip - index_mcp), thumb_tip - index_tip);
  if (sense < 0) axis.direction = -axis.direction;
  return axis;
}

// Rodrigues: the part along the axis stays, the rest turns.
Vec3 turned_point(Vec3 p, Vec3 pivot, Vec3 axis, Real angle) {
  const Vec3 arm = p - pivot;
  const Vec3 along = glm::dot(arm, axis) * axis;
  const Vec3 out = arm - along;
  Real s = 0;
  Real c = 0;
  sine_cosine(angle, s, c);
  return pivot + along + c * out + s * glm::cross(axis, out);
}

Vec3 project_point(const Vessel& vessel, Vec3 p, Real radius, Vec3 pivot, PaperAxis axis, Real max_angle, bool& unsettled) {
  unsettled = false;
  if (!axis.exists) return p;
  const Vec3 arm = p - pivot;
  const Real reach = glm::length(arm - glm::dot(arm, axis.direction) * axis.direction);
  if (reach <= Real(AXIS_DISTANCE)) return p;
  Real angle = 0;
  Vec3 place = p;
  for (int step = 0; step < vessel.limits.advance_steps; ++step) {
    const Support support = support_at(vessel, place);
    const Real separation = support.distance - radius;
    if (separation < vessel.limits.stop_tolerance) return place;
    if (angle >= max_angle) return p;
    const Vec3 velocity = glm::cross(axis.direction, place - pivot);
    angle = std::min(angle + safe_step(support, separation, velocity, reach, reach), max_angle);
    place = turned_point(p, pivot, axis.direction, angle);
  }
  unsettled = true;
  return p;
}

int projection_role(int point, int before) {
  const bool is_tip = point == 4;
  if (is_tip && (before & 0xF) != 0) return 0;
  if (before == 0) return 1;
  return 2;
}

}  // namespace CORE_NS
