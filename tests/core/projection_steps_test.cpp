// SPDX-License-Identifier: MIT
// Kernel 5, the steps by which a finger advances: they are safe, counted and bounded.
#include "core/projection.h"

#include <gtest/gtest.h>

#include <algorithm>

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
  EXPECT_EQ(motion.closure, 0);
  EXPECT_EQ(motion.limit, 0.4);
  EXPECT_EQ(motion.angles, core_f64::finger_angles(hand, 0));
  EXPECT_FALSE(motion.blocked);
  EXPECT_FALSE(motion.unsettled);
}

TEST(Advance, JointHasRoomUpToItsLimitOrItsLargestTurn) {
  const core_f64::Hand hand = ready_hand({});
  FingerMotion motion = core_f64::start_motion(hand, 1);
  motion.angles = {radians(60), radians(30), radians(18)};
  EXPECT_NEAR(core_f64::turn_joint(hand, motion, 0).room, radians(30), 1e-15);  // to 90
  EXPECT_NEAR(core_f64::turn_joint(hand, motion, 1).room, radians(45), 1e-15);  // max_angle
  EXPECT_NEAR(core_f64::turn_joint(hand, motion, 2).room, radians(45), 1e-15);
  motion.angles = {radians(95), radians(99), radians(80)};
  EXPECT_LE(core_f64::turn_joint(hand, motion, 0).room, 0);
  EXPECT_NEAR(core_f64::turn_joint(hand, motion, 1).room, radians(1), 1e-15);
  EXPECT_LE(core_f64::turn_joint(hand, motion, 2).room, 1e-15);
  EXPECT_EQ(core_f64::turn_joint(hand, motion, 1).start, motion.angles.y);
  EXPECT_EQ(core_f64::turn_joint(hand, motion, 3).joint, 3);
}

TEST(Advance, StepsAreCountedByTheStage) {
  const core_f64::Hand hand = ready_hand({});
  FingerMotion motion = core_f64::start_motion(hand, 1);
  motion.steps = ADVANCE_STEPS;
  for (int joint = 0; joint < 3; ++joint) {
    motion = core_f64::turn_joint(hand, motion, joint);
    EXPECT_EQ(motion.steps, 0);
    EXPECT_EQ(motion.turned, 0);
    motion.steps = ADVANCE_STEPS;
    motion.turned = 0.1;
  }
}

TEST(Advance, QuarterTurnIsTheDerivativeOfASegment) {
  const FingerFrame frame{{0, 0, 0}, glm::normalize(Vec3{1, 2, -2}), glm::normalize(Vec3{2, 1, 2})};
  const double h = 1e-6;
  for (const double angle : {0.0, 0.4, 1.9, 3.0}) {
    const auto segment = [&](double at) { return core_f64::segment_end(frame, {}, 0.05, at); };
    const Vec3 difference = (segment(angle + h) - segment(angle - h)) / (2 * h);
    EXPECT_LT(glm::distance(core_f64::quarter_turn(frame, segment(angle)), difference), 1e-10);  // h^2 / 6 and rounding 1e-17 / h
  }
}

TEST(Advance, StepPassesNoWatchedPointThroughTheWall) {
  const core_f64::Hand hand = ready_hand(odd_hand());
  for (const VesselData& data : {beaker1(), vase(), ledges(), shell_of(beaker1())}) {
    const core_f64::Vessel vessel = ready_vessel(data);
    Random random(45);
    int steps = 0;
    for (int n = 0; n < 4000; ++n) {
      const Vec3 forward = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      const FingerFrame frame{{0, 0, 0}, forward, glm::normalize(glm::cross(forward, Vec3{0.2, 0.5, -0.7}))};
      const Vec3 mcp{random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.2), random.uniform(-0.1, 0.1)},
          lengths{43e-3, 27e-3, 22e-3}, radii{7e-3, 0, 5e-3};
      Vec3 angles{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
      const int joint = n % 4 - 1;
      const auto at = [&](double step) {
        Vec3 moved = angles;
        if (joint < 0) {
          moved += step * hand.finger_swing;
        } else {
          moved[joint] += step;
        }
        return core_f64::finger_points(frame, mcp, lengths, moved);
      };
      const auto separations = [&](const FingerPoints& points) {
        Vec3 s{};
        s.x = core_f64::signed_distance(vessel, points.pip) - radii.x;
        s.y = core_f64::signed_distance(vessel, points.dip) - radii.y;
        s.z = core_f64::signed_distance(vessel, points.tip) - radii.z;
        return s;
      };
      const FingerPoints points = at(0);
      const core_f64::Watch watch = core_f64::watch_points(vessel, points, radii);
      EXPECT_EQ(watch.separations, separations(points));
      if (std::min({watch.separations.x, watch.separations.y, watch.separations.z}) < 1e-9) continue;
      ++steps;
      const double step =
          core_f64::finger_step(frame, mcp, points, watch, lengths, core_f64::segment_rates(hand.finger_swing, joint));
      ASSERT_GT(step, 0);
      for (int i = 1; i <= 20; ++i) {
        const Vec3 s = separations(at(std::min(step, 3.0) * i / 20));
        ASSERT_GE(std::min({s.x, s.y, s.z}), -1e-12) << data.name << ", joint " << joint << ", step " << step;  // m: rounding
      }
    }
    EXPECT_GT(steps, 500) << data.name;
  }
}

TEST(Advance, PastItsStepsAFingerStaysAndIsFlagged) {
  const core_f64::Hand hand = ready_hand({});
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  const FingerFrame frame{{0.2, 0.05, 0}, {0, 0, -1}, {-1, 0, 0}};
  const Vec3 mcp{0.2, 0.05, -0.06}, lengths{44e-3, 26e-3, 21e-3}, radii{7e-3, 7e-3, 7e-3};
  for (const int joint : {-1, 0, 1, 2}) {
    for (const int steps : {ADVANCE_STEPS - 1, ADVANCE_STEPS}) {
      FingerMotion motion = core_f64::start_motion(hand, 1);
      if (joint >= 0) motion = core_f64::turn_joint(hand, motion, joint);
      motion.steps = steps;
      const FingerPoints points = core_f64::finger_points(frame, mcp, lengths, motion.angles);
      const FingerMotion next =
          core_f64::advance_finger(hand, motion, frame, mcp, points, core_f64::watch_points(vessel, points, radii), lengths);
      EXPECT_EQ(next.unsettled, steps == ADVANCE_STEPS) << joint;
      if (steps == ADVANCE_STEPS) {
        EXPECT_EQ(next.joint, 3);
        EXPECT_EQ(next.angles, motion.angles);
      }
    }
  }
}

}  // namespace
}  // namespace wholehand
