// SPDX-License-Identifier: MIT
// Twin of core/projection.cpp.
#ifndef PROJECTION_GLSL
#define PROJECTION_GLSL

#include "body.glsl"
#include "hand.glsl"
#include "sdf.glsl"

struct FingerMotion {
  Vec3 origin, rates;
  int joint;
  Real at, end;
  int steps;
  bool blocked, unsettled;
};

const int BONE_PLACES = BETWEEN + 1;
const int PLACES = 3 * BONE_PLACES;

struct Finger {
  FingerFrame frame;
  Vec3 mcp, lengths;
  Vec4 radii;
};

struct Bend {
  Vec3 along, across;
};

struct Place {
  Ball ball;
  Vec2 velocity, acceleration;
  Real speed, bend, jerk;
};

struct FingerWatch {
  Vec3 separations, before, clear;
  int number, touched;
  bool looks, swings;
};

// Part of FingerWatch in the core; outside the struct here, because the struct is copied.
Real until[PLACES];

struct RestingFinger {
  Vec3 angles;
  FingerPoints points;
  Vec3 separations, before;
  bool blocked, unsettled, undecided;
};

struct PaperAxis {
  Vec3 direction;
  bool exists;
};

Vec3 chain_sums(Vec3 joints) { return Vec3(joints.x, joints.x + joints.y, joints.x + joints.y + joints.z); }
Vec3 segment_angles(FingerMotion motion) { return motion.origin + motion.at * motion.rates; }

Bend bend_finger(Vec3 lengths, Vec3 angles) {
  Vec3 sines, cosines;
  UNROLL_PRECISE for (int k = 0; k < 3; ++k) {
    Real s, c;
    sine_cosine(angles[k], s, c);
    sines[k] = s;
    cosines[k] = c;
  }
  return Bend(lengths * cosines, lengths * sines);
}

Place watched_place(Finger finger, Bend bend, Vec3 rates, int number) {
  int bone = number / BONE_PLACES;
  bool is_end = number % BONE_PLACES == BETWEEN;
  Real share = is_end ? Real(1) : Real(number % BONE_PLACES + 1) / Real(BONE_PLACES);
  Vec3 places = Vec3(Real(number + 1), Real(number + 1 - BONE_PLACES), Real(number + 1 - 2 * BONE_PLACES));
  Vec3 parts = clamp(places / Real(BONE_PLACES), Vec3(0), Vec3(1));
  Vec3 along = parts * bend.along;
  Vec3 across = parts * bend.across;
  Vec3 sweep = parts * finger.lengths * abs(rates);
  Place place;
  place.velocity = Vec2(-dot(rates, across), dot(rates, along));
  place.acceleration = Vec2(-dot(rates * rates, along), -dot(rates * rates, across));
  place.speed = sweep.x + sweep.y + sweep.z;
  place.bend = dot(sweep, abs(rates));
  place.jerk = dot(sweep, rates * rates);
  Real start_radius = finger.radii[bone];
  Real end_radius = finger.radii[bone + 1];
  precise Vec3 center = finger.mcp + (along.x + along.y + along.z) * finger.frame.forward +
                        (across.x + across.y + across.z) * finger.frame.palmward;
  place.ball = Ball(center, is_end ? end_radius : start_radius + share * (end_radius - start_radius));
  return place;
}

Real place_step(Support support, Real separation, Place place, FingerFrame frame) {
  Vec2 normal = Vec2(dot(support.normal, frame.forward), dot(support.normal, frame.palmward));
  Real closing = -dot(normal, place.velocity);
  Real towards = -dot(normal, place.acceleration);
  Real most = towards + place.jerk * (separation / closing) / Real(3);
  Real acceleration = closing > Real(0) ? smaller(larger(most, Real(0)), place.bend) : place.bend;
  return plane_step(support, separation, closing, place.speed, acceleration);
}

bool passes_close(Support support, Real separation, Place place, FingerFrame frame) {
  Vec3 wall = support.normal;
  if (SDF_KIND == SDF_LATTICE && abs(separation) <= CONTACT_MARGIN) wall = lattice_gradient(place.ball.place);
  Vec2 normal = Vec2(dot(wall, frame.forward), dot(wall, frame.palmward));
  Real closing = dot(normal, place.velocity), leaving = dot(normal, place.acceleration);
  Real across = dot(place.velocity, place.velocity) - closing * closing;
  Real most = larger(Real(0), leaving) + across / larger(place.ball.radius, RATIO(1, 1000));
  return abs(separation) <= CONTACT_MARGIN && closing * closing < Real(2) * CONTACT_MARGIN * most;
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
  return FingerMotion(chain_sums(finger_angles(Real(0))), chain_sums(hand_vectors[HAND_FINGER_SWING].xyz), -1, Real(0), limit, 0, false, false);
}

FingerMotion turn_joint(FingerMotion motion, int joint) {
  Vec3 here = segment_angles(motion);
  Vec3 stops = hand_vectors[HAND_JOINT_LIMIT].xyz;
  Real room = joint == 0 ? stops.x - here.x : joint == 1 ? stops.y - (here.y - here.x) : stops.z - (here.z - here.y);
  Vec3 rates = Vec3(joint == 0 ? Real(1) : Real(0), joint <= 1 ? Real(1) : Real(0), Real(1));
  return FingerMotion(here, rates, joint, Real(0), larger(Real(0), smaller(HAND_MAX_ANGLE, room)), 0, motion.blocked, motion.unsettled);
}

int place_to_see(int number, int joint, int touched) {
  int bone = number / BONE_PLACES;
  int seen = bone < joint ? (bone + 1) * BONE_PLACES - 1 : number;
  return seen == touched ? seen + 1 : seen;
}

int soonest_place(FingerWatch watch, int joint, out Real due) {
  int first = max(joint, 0) * BONE_PLACES;
  int soonest = first;
  due = NO_DISTANCE;
  UNROLL_PRECISE for (int k = 0; k < PLACES; ++k) {
    bool is_sooner = k >= first && until[k] < due;
    due = is_sooner ? until[k] : due;
    soonest = is_sooner ? k : soonest;
  }
  return soonest;
}

void see_place(Real separation, Real step, FingerMotion motion, inout FingerWatch watch) {
  int bone = watch.number / BONE_PLACES;
  bool is_end = watch.number % BONE_PLACES == BETWEEN;
  if (is_end) watch.separations[bone] = separation;
  if (BETWEEN > 0) watch.clear[bone] = smaller(watch.clear[bone], separation);
  until[watch.number] = motion.at + step;
}

int decide_turn(Vec3 clear, FingerMotion motion, out bool blocked) {
  int nearest = nearest_point(clear, max(motion.joint, 0));
  Real least = nearest == 0 ? clear.x : nearest == 1 ? clear.y : clear.z;
  blocked = motion.joint < 0 && motion.at == Real(0) && least < Real(0);
  int joint = motion.at >= motion.end ? motion.joint + 1 : motion.joint;
  joint = least < STOP_TOLERANCE ? nearest + 1 : joint;
  return blocked ? 3 : joint;
}

// Uses selection where the core branches: in nearly every turn of the loop some lane takes each branch, and all lanes wait for it. SwiftShader does
// not compile selection chains that are much longer.
RestingFinger rest_finger(Finger finger, Real limit) {
  bool undecided = false;
  FingerMotion motion = start_motion(limit);
  FingerWatch watch = FingerWatch(Vec3(0), Vec3(0), Vec3(NO_DISTANCE), 0, -1, true, true);
  UNROLL_PRECISE for (int k = 0; k < PLACES; ++k) until[k] = Real(0);
  // The loop ends only at its head: llvmpipe gives every lane the last lane's value of a variable that a loop computes and later code reads.
  [[dont_unroll]] for (bool ends_here = false; !ends_here;) {
    Place place = watched_place(finger, bend_finger(finger.lengths, segment_angles(motion)), motion.rates, watch.number);
    Support support = support_at(place.ball.place);
    Real separation = support.distance - place.ball.radius;
    see_place(separation, place_step(support, separation, place, finger.frame), motion, watch);
    undecided = undecided || passes_close(support, separation, place, finger.frame);
    int next = place_to_see(watch.number + 1, motion.joint, watch.touched);
    bool seen_all = watch.looks && next >= PLACES;
    bool meets = !watch.looks && separation < STOP_TOLERANCE;
    watch.before = seen_all && watch.swings ? watch.separations : watch.before;
    watch.swings = watch.swings && !(seen_all && motion.joint >= 0);
    ends_here = seen_all && motion.joint >= 3;
    if (ends_here) continue;
    bool blocked;
    int decided = decide_turn(BETWEEN > 0 ? watch.clear : watch.separations, motion, blocked);
    motion.blocked = motion.blocked || seen_all && blocked;
    int joint = meets ? watch.number / BONE_PLACES + 1 : seen_all ? decided : motion.joint;
    bool moves = joint == motion.joint && (seen_all || !watch.looks);
    Real due;
    int soonest = soonest_place(watch, motion.joint, due);
    bool is_spent = moves && motion.steps >= LIMIT_ADVANCE_STEPS;
    bool ends = moves && (is_spent || !(due < motion.end));
    motion.at = moves && !is_spent ? smaller(due, motion.end) : motion.at;
    motion.steps += moves ? 1 : 0;
    motion.unsettled = motion.unsettled || is_spent;
    int from = seen_all && !ends ? joint : max(motion.joint, 0);
    joint = ends ? is_spent ? 3 : motion.joint + 1 : joint;
    bool turns = joint != motion.joint;
    watch.touched = meets ? watch.number : turns ? -1 : watch.touched;
    if (turns) {
      motion = turn_joint(motion, joint);
      if (BETWEEN > 0) watch.clear = Vec3(NO_DISTANCE);
    }
    motion.joint = joint;
    watch.looks = turns || watch.looks && !seen_all;
    watch.number = turns ? place_to_see(from * BONE_PLACES, joint, watch.touched) : moves ? soonest : next;
    ends_here = watch.number >= PLACES;
  }
  Vec3 angles = segment_angles(motion);
  angles = Vec3(angles.x, angles.y - angles.x, angles.z - angles.y);
  FingerPoints points = finger_points(finger.frame, finger.mcp, finger.lengths, angles);
  return RestingFinger(angles, points, watch.separations, watch.before, motion.blocked, motion.unsettled, undecided);
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
