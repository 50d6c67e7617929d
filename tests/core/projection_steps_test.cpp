// SPDX-License-Identifier: MIT
// Kernel 5, the steps by which a finger advances: they are safe, counted and bounded.
#include "core/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/body.h"
#include "tests/support/placed_finger.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::FingerFrame;
using core_f64::FingerMotion;
using core_f64::FingerPoints;
using core_f64::Vec3;

TEST(Advance, NearestPointIsTheInnermostOfEqualOnes) {
  EXPECT_EQ(core_f64::nearest_point({3, 2, 1}, 0), 2);
  EXPECT_EQ(core_f64::nearest_point({1, 2, 3}, 0), 0);
  EXPECT_EQ(core_f64::nearest_point({1, 2, 3}, 1), 1);
  EXPECT_EQ(core_f64::nearest_point({1, 2, 2}, 1), 1);
  EXPECT_EQ(core_f64::nearest_point({2, 2, 2}, 0), 0);
  EXPECT_EQ(core_f64::nearest_point({2, 1, 1}, 0), 1);
  EXPECT_EQ(core_f64::nearest_point({-1, -2, 5}, 2), 2);
}

TEST(Advance, MotionStartsOpen) {
  const core_f64::Hand hand = ready_hand(odd_hand());
  const FingerMotion motion = core_f64::start_motion(hand, 0.4);
  EXPECT_EQ(motion.joint, -1);
  EXPECT_EQ(motion.at, 0);
  EXPECT_EQ(motion.end, 0.4);
  const Vec3 open = core_f64::finger_angles(hand, 0), on_its_way = core_f64::finger_angles(hand, 0.3);
  EXPECT_EQ(core_f64::segment_angles(motion), Vec3(open.x, open.x + open.y, open.x + open.y + open.z));
  FingerMotion moved = motion;
  moved.at = 0.3;
  EXPECT_LT(glm::distance(core_f64::segment_angles(moved), core_f64::chain_sums(on_its_way)), 1e-15);
  EXPECT_FALSE(motion.blocked);
  EXPECT_FALSE(motion.unsettled);
}

// Motion of a finger whose joints are at these angles.
FingerMotion motion_at(const core_f64::Hand& hand, Vec3 angles) {
  FingerMotion motion = core_f64::start_motion(hand, 1);
  motion.origin = core_f64::chain_sums(angles);
  return motion;
}

TEST(Advance, JointHasRoomUpToItsLimitOrItsLargestTurn) {
  const core_f64::Hand hand = ready_hand(paper_hand());
  const FingerMotion inside = motion_at(hand, {radians(60), radians(30), radians(18)});
  EXPECT_NEAR(core_f64::turn_joint(hand, inside, 0).end, radians(30), 1e-15);  // to 90
  EXPECT_NEAR(core_f64::turn_joint(hand, inside, 1).end, radians(45), 1e-15);  // max_angle
  EXPECT_NEAR(core_f64::turn_joint(hand, inside, 2).end, radians(45), 1e-15);
  const FingerMotion bent = motion_at(hand, {radians(95), radians(99), radians(80)});
  EXPECT_LE(core_f64::turn_joint(hand, bent, 0).end, 0);
  EXPECT_NEAR(core_f64::turn_joint(hand, bent, 1).end, radians(1), 1e-15);
  EXPECT_LE(core_f64::turn_joint(hand, bent, 2).end, 1e-15);
  EXPECT_EQ(core_f64::turn_joint(hand, bent, 3).joint, 3);
}

TEST(Advance, StageGoesOnFromWhereTheOneBeforeEnded) {
  const core_f64::Hand hand = ready_hand(paper_hand());
  FingerMotion motion = core_f64::start_motion(hand, 1);
  motion.at = 0.1;
  motion.steps = 5;
  Vec3 joints = core_f64::finger_angles(hand, 0.1);
  for (int joint = 0; joint < 3; ++joint) {
    motion = core_f64::turn_joint(hand, motion, joint);
    EXPECT_EQ(motion.steps, 0);
    EXPECT_EQ(motion.at, 0);
    motion.at = 0.2;
    joints[joint] += 0.2;
    EXPECT_LT(glm::distance(core_f64::segment_angles(motion), core_f64::chain_sums(joints)), 1e-15) << "joint " << joint;
  }
}

// A finger beside a vessel, at random.
struct Drawn {
  core_f64::Finger finger;
  Vec3 angles{};
};

Drawn draw_finger(Random& random) {
  const Vec3 forward = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  const FingerFrame frame{{0, 0, 0}, forward, glm::normalize(glm::cross(forward, Vec3{0.2, 0.5, -0.7}))};
  const Vec3 mcp{random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.2), random.uniform(-0.1, 0.1)};
  return {{frame, mcp, {43e-3, 27e-3, 22e-3}, {8e-3, 7e-3, 0, 5e-3}},
          {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)}};
}

// The place of that number after a step of the motion.
core_f64::Place place_after(const core_f64::Hand& hand, const Drawn& drawn, int joint, int number, double step) {
  Vec3 moved = drawn.angles;
  if (joint < 0) {
    moved += step * hand.finger_swing;
  } else {
    moved[joint] += step;
  }
  const core_f64::Finger& finger = drawn.finger;
  const FingerMotion motion = joint < 0 ? core_f64::start_motion(hand, 1) : core_f64::turn_joint(hand, {}, joint);
  return core_f64::watched_place(hand, finger, core_f64::bend_finger(finger.lengths, core_f64::chain_sums(moved)), motion.rates,
                                 number);
}

core_f64::Hand hand_with(int between) {
  core_f64::Hand hand = ready_hand(odd_hand());
  hand.between = between;
  return hand;
}

TEST(Advance, PlacesMoveAsTheirDerivativesSay) {
  Random random(44);
  for (const int between : {0, 2}) {
    const core_f64::Hand hand = hand_with(between);
    for (int n = 0; n < 300; ++n) {
      const Drawn drawn = draw_finger(random);
      const int joint = n % 4 - 1, number = n % (3 * (between + 1));
      const auto at = [&](double step) { return place_after(hand, drawn, joint, number, step); };
      const double h = 1e-4;
      const core_f64::Place place = at(0), before = at(-h), after = at(h);
      const FingerFrame& frame = drawn.finger.frame;
      const Vec3 velocity = (after.ball.place - before.ball.place) / (2 * h);
      const Vec3 acceleration = (after.ball.place - 2.0 * place.ball.place + before.ball.place) / (h * h);
      // h^2 / 6 of the third derivative and h^2 / 12 of the fourth, which are below 1 m; rounding 1e-16 / h and 4e-17 / h^2
      EXPECT_LT(glm::distance(velocity, place.velocity.x * frame.forward + place.velocity.y * frame.palmward), 3e-9);
      EXPECT_LT(glm::distance(acceleration, place.acceleration.x * frame.forward + place.acceleration.y * frame.palmward), 1e-7);
      EXPECT_LE(glm::length(place.velocity), place.speed + 1e-15);
      EXPECT_LE(glm::length(place.acceleration), place.bend + 1e-15);
      EXPECT_LE(glm::distance(after.acceleration, before.acceleration), 2 * h * place.jerk + 1e-15);
      const FingerPoints points = core_f64::finger_points(frame, drawn.finger.mcp, drawn.finger.lengths, drawn.angles);
      const std::array<Vec3, 4> joints{drawn.finger.mcp, points.pip, points.dip, points.tip};
      const int bone = number / (between + 1);
      const core_f64::Ball ball =
          core_f64::ball_between(joints[bone], joints[bone + 1], drawn.finger.radii[bone], drawn.finger.radii[bone + 1],
                                 (number % (between + 1) + 1.0) / (between + 1));
      EXPECT_LT(glm::distance(place.ball.place, ball.place), 1e-15);
      EXPECT_NEAR(place.ball.radius, ball.radius, 1e-17);
      EXPECT_EQ(place.ball.radius == drawn.finger.radii[number / (between + 1) + 1], number % (between + 1) == between);
    }
  }
}

TEST(Advance, StepPassesNoWatchedPlaceThroughTheWall) {
  for (const int between : {0, 2}) {
    const core_f64::Hand hand = hand_with(between);
    for (const VesselData& data : {beaker1(), vase(), ledges(), shell_of(beaker1())}) {
      const core_f64::Vessel vessel = ready_vessel(data);
      Random random(45);
      int steps = 0;
      for (int n = 0; n < 6000; ++n) {
        const Drawn drawn = draw_finger(random);
        const int joint = n % 4 - 1, number = n / 4 % (3 * (between + 1));
        const auto separation = [&](double step) {
          const core_f64::Ball ball = place_after(hand, drawn, joint, number, step).ball;
          return core_f64::signed_distance(vessel, ball.place) - ball.radius;
        };
        const core_f64::Place place = place_after(hand, drawn, joint, number, 0);
        const core_f64::Support support = core_f64::support_at(vessel, place.ball.place);
        EXPECT_EQ(support.distance - place.ball.radius, separation(0));
        if (separation(0) < 1e-9 || !(place.speed > 0)) continue;
        ++steps;
        const double step = core_f64::place_step(support, separation(0), place, drawn.finger.frame);
        ASSERT_GT(step, 0);
        for (int i = 1; i <= 20; ++i)
          ASSERT_GE(separation(std::min(step, 3.0) * i / 20), -1e-12) << data.name << ", joint " << joint << ", step " << step;
      }
      EXPECT_GT(steps, 1000) << data.name;
    }
  }
}

TEST(Advance, PlacesAreSeenInTurn) {
  const core_f64::Hand plain = hand_with(0), with_spheres = hand_with(2);
  EXPECT_EQ(core_f64::place_to_see(plain, 0, -1, -1), 0);
  EXPECT_EQ(core_f64::place_to_see(with_spheres, 3, -1, -1), 3);
  EXPECT_EQ(core_f64::place_to_see(with_spheres, 0, 1, -1), 2) << "of a bone that rests, its end";
  EXPECT_EQ(core_f64::place_to_see(with_spheres, 3, 1, -1), 3);
  EXPECT_EQ(core_f64::place_to_see(with_spheres, 0, 1, 2), 3) << "which has just touched";
  EXPECT_EQ(core_f64::place_to_see(with_spheres, 6, 3, 8), 9) << "all are seen";
}

TEST(Advance, PlaceThatIsDueFirstIsTheInnermostThatMoves) {
  const core_f64::Hand hand = hand_with(0);
  core_f64::FingerWatch watch;
  double due = 0;
  watch.until = {0.1, 0.3, 0.2};
  EXPECT_EQ(core_f64::soonest_place(hand, watch, -1, due), 0);
  EXPECT_EQ(due, 0.1);
  EXPECT_EQ(core_f64::soonest_place(hand, watch, 1, due), 2) << "the first bone rests";
  EXPECT_EQ(due, 0.2);
  watch.until = {0.2, 0.2, 0.2};
  EXPECT_EQ(core_f64::soonest_place(hand, watch, 0, due), 0);
  EXPECT_EQ(core_f64::soonest_place(hand, watch, 1, due), 1);
}

TEST(Advance, DecidesWhichJointTurns) {
  const core_f64::Hand hand = ready_hand(paper_hand());
  FingerMotion motion = core_f64::start_motion(hand, 1);
  bool blocked = true;
  EXPECT_EQ(core_f64::decide_turn(hand, {0.1, 0.1, 0.1}, motion, blocked), -1) << "it goes on";
  EXPECT_FALSE(blocked);
  EXPECT_EQ(core_f64::decide_turn(hand, {0.1, -1e-3, 0.1}, motion, blocked), 3);
  EXPECT_TRUE(blocked);
  motion.at = 0.5;
  EXPECT_EQ(core_f64::decide_turn(hand, {0.1, -1e-12, 0.1}, motion, blocked), 2) << "the PIP's bone touches";
  EXPECT_FALSE(blocked) << "it is not at its start";
  motion.at = motion.end;
  EXPECT_EQ(core_f64::decide_turn(hand, {0.1, 0.1, 0.1}, motion, blocked), 0) << "the stage is at its end";
  EXPECT_EQ(core_f64::decide_turn(hand, {0.1, 0.1, 0}, motion, blocked), 3) << "a touch comes first";
  motion = core_f64::turn_joint(hand, motion, 1);
  motion.end = 0;
  EXPECT_EQ(core_f64::decide_turn(hand, {0, 0.1, 0.1}, motion, blocked), 2) << "no room; a bone that rests does not count";
}

// A plane at the distance 0.02 that a place comes nearer to at the speed 0.1.
TEST(Advance, StepIsTheRootOfItsBound) {
  const FingerFrame frame{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  core_f64::Support support;
  support.distance = 0.03;
  support.other = 10;
  support.normal = {1, 0, 0};
  support.planar = true;
  core_f64::Place place;
  place.ball.radius = 0.01;
  place.velocity = {-0.1, 0};
  place.speed = 0.5;
  place.bend = 1;
  place.jerk = 0.3;
  const double separation = 0.02;
  const auto root = [&](double acceleration) { return 2 * separation / (0.1 + std::sqrt(0.01 + 2 * acceleration * separation)); };
  const auto step = [&] { return core_f64::place_step(support, separation, place, frame); };
  place.acceleration = {-0.2, 7};
  EXPECT_NEAR(step(), root(0.2 + 0.3 * 0.2 / 3), 1e-15);
  place.acceleration = {0.5, 7};
  EXPECT_NEAR(step(), separation / 0.1, 1e-15) << "slows down: no acceleration is counted on";
  place.acceleration = {-0.99, 7};
  EXPECT_NEAR(step(), root(1), 1e-15) << "never more than the bound at any angle";
  place.velocity = {0, 0.1};
  EXPECT_NEAR(step(), std::sqrt(2 * separation), 1e-15) << "at rest towards the plane";
  support.planar = false;
  EXPECT_NEAR(step(), separation / 0.5, 1e-15);
  place.speed = 0;
  EXPECT_GT(step(), 1e300);
}

// A finger beside the wall that closes on it.
TEST(Advance, PastItsStepsAFingerStaysAndIsFlagged) {
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  const FingerFrame frame{{0.06, 0.05, 0.08}, {0, 0, -1}, {-1, 0, 0}};
  const core_f64::Finger finger{frame, {0.06, 0.05, 0.02}, {44e-3, 26e-3, 21e-3}, {7e-3, 7e-3, 7e-3, 7e-3}};
  for (const int steps : {1, 2, ADVANCE_STEPS}) {
    core_f64::Hand hand = ready_hand(paper_hand());
    hand.limits.advance_steps = steps;
    const core_f64::RestingFinger resting = core_f64::rest_finger(hand, vessel, finger, 1);
    EXPECT_FALSE(resting.blocked);
    EXPECT_EQ(resting.unsettled, steps < ADVANCE_STEPS);
    EXPECT_LE(resting.steps, steps);
    EXPECT_GT(resting.steps, std::min(steps, 3) - 1);
    const FingerPoints points = core_f64::finger_points(frame, finger.mcp, finger.lengths, resting.angles);
    EXPECT_EQ(resting.points.tip, points.tip);
    // the places are summed in the finger's plane, and the points along its bones: a few roundings of 0.2 m
    const Vec3 clear{core_f64::signed_distance(vessel, points.pip), core_f64::signed_distance(vessel, points.dip),
                     core_f64::signed_distance(vessel, points.tip)};
    EXPECT_LT(glm::distance(resting.separations, clear - 7e-3), 1e-15);
    for (int k = 0; k < 3; ++k) EXPECT_GT(resting.separations[k], -1e-12) << "it stays outside";
  }
}

}  // namespace
}  // namespace wholehand
