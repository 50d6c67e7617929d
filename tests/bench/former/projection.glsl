// SPDX-License-Identifier: MIT
// As of commit 289a04a, a twin of core/projection.cpp.
#ifndef PROJECTION_GLSL
#define PROJECTION_GLSL

#include "hand.glsl"
#include "sdf.glsl"

struct FingerMotion {
  Vec3 angles;
  Real closure;
  Real limit;
  int joint;
  Real start;
  Real turned, room;
  int steps;
  Vec3 before;
  bool blocked;
  bool unsettled;
};

struct Watch {
  Support pip, dip, tip;
  Vec3 separations;
};

struct PaperAxis {
  Vec3 direction;
  bool exists;
};

Vec3 segment_rates(Vec3 swing, int joint) {
  if (joint < 0) return Vec3(swing.x, swing.x + swing.y, swing.x + swing.y + swing.z);
  return Vec3(joint == 0 ? Real(1) : Real(0), joint <= 1 ? Real(1) : Real(0), Real(1));
}

Vec3 quarter_turn(FingerFrame frame, Vec3 segment) {
  return dot(segment, frame.forward) * frame.palmward - dot(segment, frame.palmward) * frame.forward;
}

Real finger_step(FingerFrame frame, Vec3 mcp, FingerPoints points, Watch watch, Vec3 lengths, Vec3 rates) {
  Vec3 sweep = abs(rates) * lengths;
  Vec3 bend = rates * rates * lengths;
  Vec3 pip_velocity = rates.x * quarter_turn(frame, points.pip - mcp);
  Vec3 dip_velocity = pip_velocity + rates.y * quarter_turn(frame, points.dip - points.pip);
  Vec3 tip_velocity = dip_velocity + rates.z * quarter_turn(frame, points.tip - points.dip);
  Real pip = safe_step(watch.pip, watch.separations.x, pip_velocity, sweep.x, bend.x);
  Real dip = safe_step(watch.dip, watch.separations.y, dip_velocity, sweep.x + sweep.y, bend.x + bend.y);
  Real tip = safe_step(watch.tip, watch.separations.z, tip_velocity, sweep.x + sweep.y + sweep.z, bend.x + bend.y + bend.z);
  return min(pip, min(dip, tip));
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

FingerMotion start_motion(Real limit) {
  FingerMotion motion;
  motion.angles = finger_angles(Real(0));
  motion.closure = Real(0);
  motion.limit = limit;
  motion.joint = -1;
  motion.start = Real(0);
  motion.turned = Real(0);
  motion.room = Real(0);
  motion.steps = 0;
  motion.before = Vec3(0);
  motion.blocked = false;
  motion.unsettled = false;
  return motion;
}

Watch watch_points(FingerPoints points, Vec3 radii) {
  Watch watch;
  watch.pip = support_at(points.pip);
  watch.dip = support_at(points.dip);
  watch.tip = support_at(points.tip);
  watch.separations = Vec3(watch.pip.distance, watch.dip.distance, watch.tip.distance) - radii;
  return watch;
}

FingerMotion turn_joint(FingerMotion motion, int joint) {
  FingerMotion next = motion;
  next.joint = joint;
  next.turned = Real(0);
  next.steps = 0;
  if (joint < 3) {
    Vec3 limits = hand_table[HAND_JOINT_LIMIT].xyz;
    Real stop = joint == 0 ? limits.x : joint == 1 ? limits.y : limits.z;
    next.start = joint == 0 ? motion.angles.x : joint == 1 ? motion.angles.y : motion.angles.z;
    next.room = max(Real(0), min(HAND_MAX_ANGLE, stop - next.start));
  }
  return next;
}

FingerMotion advance_finger(FingerMotion motion, FingerFrame frame, Vec3 mcp, FingerPoints points, Watch watch, Vec3 lengths) {
  FingerMotion next = motion;
  Vec3 separations = watch.separations;
  if (next.joint < 0) {
    int nearest = nearest_point(separations, 0);
    Real clear = min(separations.x, min(separations.y, separations.z));
    next.before = separations;
    if (next.closure == Real(0) && clear < Real(0)) {
      next.blocked = true;
      next.joint = 3;
    } else if (clear < STOP_TOLERANCE) {
      next = turn_joint(next, nearest + 1);
    } else if (next.closure >= next.limit) {
      next = turn_joint(next, 0);
    }
  }
  for (int stage = 0; stage < 3; ++stage) {
    if (next.joint >= 0 && next.joint < 3) {
      int nearest = nearest_point(separations, next.joint);
      Real clear = nearest == 0 ? separations.x : nearest == 1 ? separations.y : separations.z;
      if (clear < STOP_TOLERANCE) {
        next = turn_joint(next, nearest + 1);
      } else if (next.turned >= next.room) {
        next = turn_joint(next, next.joint + 1);
      }
    }
  }
  if (next.joint >= 3) return next;
  if (next.steps >= LIMIT_ADVANCE_STEPS) {
    next.unsettled = true;
    next.joint = 3;
    return next;
  }
  Real step = finger_step(frame, mcp, points, watch, lengths, segment_rates(hand_table[HAND_FINGER_SWING].xyz, next.joint));
  next.steps = next.steps + 1;
  if (next.joint < 0) {
    next.closure = min(next.closure + step, next.limit);
    next.angles = finger_angles(next.closure);
    return next;
  }
  next.turned = min(next.turned + step, next.room);
  Real angle = next.start + next.turned;
  if (next.joint == 0) next.angles.x = angle;
  if (next.joint == 1) next.angles.y = angle;
  if (next.joint == 2) next.angles.z = angle;
  return next;
}

PaperAxis paper_axis(Vec3 index_mcp, Vec3 little_mcp, Vec3 index_tip, Vec3 thumb_tip) {
  PaperAxis axis;
  Vec3 across = little_mcp - index_mcp;
  Real width = length(across);
  axis.exists = width > AXIS_DISTANCE;
  axis.direction = axis.exists ? across / width : Vec3(0);
  Real sense = dot(cross(axis.direction, index_tip - index_mcp), thumb_tip - index_tip);
  if (sense < Real(0)) axis.direction = -axis.direction;
  return axis;
}

Vec3 turned_point(Vec3 p, Vec3 pivot, Vec3 axis, Real angle) {
  Vec3 arm = p - pivot;
  Vec3 along = dot(arm, axis) * axis;
  Vec3 out_of_axis = arm - along;
  Real s, c;
  sine_cosine(angle, s, c);
  return pivot + along + c * out_of_axis + s * cross(axis, out_of_axis);
}

Vec3 project_point(Vec3 p, Real radius, Vec3 pivot, PaperAxis axis, Real max_angle, out bool unsettled) {
  unsettled = false;
  if (!axis.exists) return p;
  Vec3 arm = p - pivot;
  Real reach = length(arm - dot(arm, axis.direction) * axis.direction);
  if (reach <= AXIS_DISTANCE) return p;
  Real angle = Real(0);
  Vec3 place = p;
  for (int step = 0; step < LIMIT_ADVANCE_STEPS; ++step) {
    Support support = support_at(place);
    Real separation = support.distance - radius;
    if (separation < STOP_TOLERANCE) return place;
    if (angle >= max_angle) return p;
    Vec3 velocity = cross(axis.direction, place - pivot);
    angle = min(angle + safe_step(support, separation, velocity, reach, reach), max_angle);
    place = turned_point(p, pivot, axis.direction, angle);
  }
  unsettled = true;
  return p;
}

int projection_role(int point, int before) {
  bool is_tip = point == 4;
  if (is_tip && (before & 0xF) != 0) return 0;
  if (before == 0) return 1;
  return 2;
}

#endif
