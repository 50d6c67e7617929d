// SPDX-License-Identifier: MIT
#include "core/projection.h"

#include <algorithm>
#include <cmath>

#include "core/trig.h"

namespace CORE_NS {

Vec3 chain_sums(Vec3 joints) { return Vec3(joints.x, joints.x + joints.y, joints.x + joints.y + joints.z); }

Vec3 segment_angles(const FingerMotion& motion) { return motion.origin + motion.at * motion.rates; }

Bend bend_finger(Vec3 lengths, Vec3 angles) {
  Vec3 sines{}, cosines{};
  sine_cosine(angles.x, sines.x, cosines.x);
  sine_cosine(angles.y, sines.y, cosines.y);
  sine_cosine(angles.z, sines.z, cosines.z);
  return {lengths * cosines, lengths * sines};
}

// A segment of direction u turns across itself: u' is u turned a quarter, and u'' is -u. These add up along the chain, and so do the
// bounds of their lengths, which are rate^n times the length.
Place watched_place(const Hand& hand, const Finger& finger, const Bend& bend, Vec3 rates, int number) {
  const int between = hand.between;
  const int bone = number / (between + 1);
  const bool is_end = number % (between + 1) == between;
  const Real share = is_end ? Real(1) : Real(number % (between + 1) + 1) / Real(between + 1);
  const Vec3 parts(bone == 0 ? share : Real(1), bone == 0 ? Real(0) : bone == 1 ? share : Real(1), bone == 2 ? share : Real(0));
  const Vec3 along = parts * bend.along;
  const Vec3 across = parts * bend.across;
  const Vec3 sweep = parts * finger.lengths * glm::abs(rates);
  Place place;
  place.velocity = Vec2(-glm::dot(rates, across), glm::dot(rates, along));
  place.acceleration = Vec2(-glm::dot(rates * rates, along), -glm::dot(rates * rates, across));
  place.speed = sweep.x + sweep.y + sweep.z;
  place.bend = glm::dot(sweep, glm::abs(rates));
  place.jerk = glm::dot(sweep, rates * rates);
  const Real start_radius = finger.radii[bone];
  const Real end_radius = finger.radii[bone + 1];
  place.ball.place =
      finger.mcp + (along.x + along.y + along.z) * finger.frame.forward + (across.x + across.y + across.z) * finger.frame.palmward;
  place.ball.radius = is_end ? end_radius : start_radius + share * (end_radius - start_radius);
  return place;
}

// The motion t brings the place nearer to the plane by at most closing t + towards t^2 / 2 + jerk t^3 / 6. Because `acceleration` is not negative,
// the step is at most separation / closing, and up to there t^3 <= t^2 separation / closing.
Real place_step(Support support, Real separation, const Place& place, FingerFrame frame) {
  const Vec2 normal(glm::dot(support.normal, frame.forward), glm::dot(support.normal, frame.palmward));
  const Real closing = -glm::dot(normal, place.velocity);
  const Real towards = -glm::dot(normal, place.acceleration);
  Real acceleration = place.bend;
  if (closing > 0) {
    const Real most = towards + place.jerk * (separation / closing) / Real(3);
    acceleration = std::min(std::max(most, Real(0)), place.bend);
  }
  return plane_step(support, separation, closing, place.speed, acceleration);
}

// The wall recedes from a place at most as fast as beside an edge, which curves by the ball's radius. If the closing speed is too high for the place
// to leave again within the margin, rounding does not decide.
bool passes_close(const Vessel& vessel, const Support& support, Real separation, const Place& place, const FingerFrame& frame) {
  Vec3 wall = support.normal;  // steps on a lattice need none, and it has none
  if (vessel.is_lattice && std::abs(separation) <= Real(CONTACT_MARGIN)) wall = lattice_gradient(vessel.lattice, place.ball.place);
  const Vec2 normal(glm::dot(wall, frame.forward), glm::dot(wall, frame.palmward));
  const Real closing = glm::dot(normal, place.velocity), leaving = glm::dot(normal, place.acceleration);
  const Real across = glm::dot(place.velocity, place.velocity) - closing * closing;
  const Real most = std::max(Real(0), leaving) + across / std::max(place.ball.radius, Real(1e-3));
  return std::abs(separation) <= Real(CONTACT_MARGIN) && closing * closing < 2 * Real(CONTACT_MARGIN) * most;
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
  motion.origin = chain_sums(finger_angles(hand, 0));
  motion.rates = chain_sums(hand.finger_swing);
  motion.end = limit;
  return motion;
}

FingerMotion turn_joint(const Hand& hand, const FingerMotion& motion, int joint) {
  const Vec3 here = segment_angles(motion);
  const Vec3 stops = hand.joint_limit;
  const Real room = joint == 0 ? stops.x - here.x : joint == 1 ? stops.y - (here.y - here.x) : stops.z - (here.z - here.y);
  FingerMotion next = motion;
  next.origin = here;
  next.rates = Vec3(joint == 0 ? Real(1) : Real(0), joint <= 1 ? Real(1) : Real(0), Real(1));
  next.joint = joint;
  next.at = 0;
  next.end = std::max(Real(0), std::min(hand.max_angle, room));
  next.steps = 0;
  return next;
}

int place_to_see(const Hand& hand, int number, int joint, int touched) {
  const int between = hand.between;
  const int bone = number / (between + 1);
  const int seen = bone < joint ? (bone + 1) * (between + 1) - 1 : number;
  return seen == touched ? seen + 1 : seen;
}

int soonest_place(const Hand& hand, const FingerWatch& watch, int joint, Real& due) {
  const int between = hand.between;
  const int first = std::max(joint, 0) * (between + 1);
  int soonest = first;
  due = NO_DISTANCE;
  for (int k = first; k < 3 * (between + 1); ++k) {
    if (watch.until[k] < due) {
      due = watch.until[k];
      soonest = k;
    }
  }
  return soonest;
}

void see_place(const Hand& hand, Real separation, Real step, const FingerMotion& motion, FingerWatch& watch) {
  const int between = hand.between;
  const int bone = watch.number / (between + 1);
  if (watch.number % (between + 1) == between) watch.separations[bone] = separation;
  watch.clear[bone] = std::min(watch.clear[bone], separation);
  watch.until[watch.number] = motion.at + step;
}

// One joint per turn: a joint without room, or one whose bone touches as well, evaluates all points at the same position and decides again.
int decide_turn(const Hand& hand, Vec3 clear, const FingerMotion& motion, bool& blocked) {
  const int nearest = nearest_point(clear, std::max(motion.joint, 0));
  const Real least = nearest == 0 ? clear.x : nearest == 1 ? clear.y : clear.z;
  blocked = motion.joint < 0 && motion.at == 0 && least < 0;
  if (blocked) return 3;
  if (least < hand.limits.stop_tolerance) return nearest + 1;
  return motion.at >= motion.end ? motion.joint + 1 : motion.joint;
}

// Conservative advancement: no step passes through the wall, for any watched point. Each turn of the loop evaluates one point; then at most one joint
// turns, and the finger moves at most once.
RestingFinger rest_finger(const Hand& hand, const Vessel& vessel, const Finger& finger, Real limit) {
  const int between = hand.between;
  const int places = 3 * (between + 1);
  int most_steps = 0;  // of a stage
  bool undecided = false;
  FingerMotion motion = start_motion(hand, limit);
  FingerWatch watch;
  while (watch.number < places) {
    const Bend bend = bend_finger(finger.lengths, segment_angles(motion));
    const Place place = watched_place(hand, finger, bend, motion.rates, watch.number);
    const Support support = support_at(vessel, place.ball.place);
    const Real separation = support.distance - place.ball.radius;
    see_place(hand, separation, place_step(support, separation, place, finger.frame), motion, watch);
    undecided = undecided || passes_close(vessel, support, separation, place, finger.frame);

    // the next joint to turn is chosen once all points have been evaluated, or where a point that was due touches
    const int moving = std::max(motion.joint, 0);  // first bone that moves
    int next = place_to_see(hand, watch.number + 1, motion.joint, watch.touched);
    const bool seen_all = watch.looks && next >= places;
    const bool meets = !watch.looks && separation < hand.limits.stop_tolerance;
    int joint = motion.joint;
    int from = moving;  // first bone whose end has moved since its evaluation
    if (seen_all) {
      if (watch.swings) watch.before = watch.separations;
      watch.swings = motion.joint < 0;
      if (motion.joint >= 3) break;
      bool blocked = false;
      joint = decide_turn(hand, watch.clear, motion, blocked);
      motion.blocked = motion.blocked || blocked;
      from = joint;
    }
    if (meets) joint = watch.number / (between + 1) + 1;

    // if none does, the finger moves until a place is due, or to the end of its stage
    if (joint == motion.joint && (seen_all || !watch.looks)) {
      Real due = 0;
      next = soonest_place(hand, watch, motion.joint, due);
      const bool has_moved = motion.advance(due, hand.limits.advance_steps);
      if (has_moved) most_steps = std::max(most_steps, motion.steps);
      if (!has_moved || !(due < motion.end)) {
        joint = has_moved ? motion.joint + 1 : 3;
        from = moving;
      }
      watch.looks = false;
    }

    // a new stage first evaluates all points that move from now on, and the ends of the bones that moved
    if (joint != motion.joint) {
      motion = turn_joint(hand, motion, joint);
      watch.touched = meets ? watch.number : -1;
      watch.clear = Vec3(NO_DISTANCE);
      watch.looks = true;
      next = place_to_see(hand, from * (between + 1), joint, watch.touched);
    }
    watch.number = next;
  }
  const Vec3 sums = segment_angles(motion), angles(sums.x, sums.y - sums.x, sums.z - sums.y);
  const FingerPoints points = finger_points(finger.frame, finger.mcp, finger.lengths, angles);
  return {angles, points, watch.separations, watch.before, most_steps, motion.blocked, motion.unsettled, undecided};
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
