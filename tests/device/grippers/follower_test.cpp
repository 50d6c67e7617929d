// SPDX-License-Identifier: MIT
// Going after a goal: against the closed forms of a critically damped spring, and its bound on speed against every goal there is.
// sanitizers: address
#include "device/grippers/follower.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

using core_f64::Vec3;

constexpr double UNBOUNDED = 1e9;

// x'' = -2 r x' - r^2 x from rest at x = 1: (1 + r t) e^(-rt).
TEST(Follower, TakesAStepAsTheSpringDoes) {
  const Pace pace{50, UNBOUNDED};
  double offset = 1, velocity = 0;
  for (int k = 1; k <= 400; ++k) {
    offset += follow(offset, velocity, pace, 1e-3);
    const double s = 50e-3 * k;
    // 400 steps, each rounded to 1e-16 of what it moves
    EXPECT_NEAR(offset, (1 + s) * std::exp(-s), 1e-13);
    EXPECT_NEAR(velocity, -50 * s * std::exp(-s), 1e-11) << "r times as much";
  }
}

TEST(Follower, OneStepEndsWhereManyDo) {
  const Pace pace{60, UNBOUNDED};
  Vec3 one{0.3, -0.2, 0.1}, many = one, velocity_one{0.5, 1, -2}, velocity_many = velocity_one;
  one += follow(one, velocity_one, pace, 0.037);
  for (int k = 0; k < 37; ++k) many += follow(many, velocity_many, pace, 1e-3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(one[k], many[k], 1e-14);
    EXPECT_NEAR(velocity_one[k], velocity_many[k], 1e-12);
  }
}

// The lag of a second-order follower behind an even motion is 2 v / r; what is left of the steps in which the goal comes is their
// first harmonic, step / pi, times 1 / (1 + (2 pi 60 / r)^2) = 1 / 40.5, and less of the others.
TEST(Follower, MakesTheStepsOfAMouseSmooth) {
  const Pace pace{60, UNBOUNDED};
  constexpr double SPEED = 0.5, STEP = SPEED / 60;
  constexpr int TICKS = 100;  // from one step to the next
  double place = 0, velocity = 0, worst = 0;
  for (int k = 0; k < 60 * TICKS; ++k) {
    const double goal = k / TICKS * STEP;
    place += follow(place - goal, velocity, pace, 1.0 / (60 * TICKS));
    const double time = (k + 1.0) / (60 * TICKS);
    // the steps are half a step behind an even motion on the average
    if (time > 0.5) worst = std::max(worst, std::abs(place - (SPEED * time - STEP / 2 - 2 * SPEED / 60)));
  }
  EXPECT_LT(worst, 0.01 * STEP);
  EXPECT_GT(worst, 0.005 * STEP) << "of the size that theory gives: this test sees it";
}

// Whatever the goal does, in steps of any length.
TEST(Follower, IsNeverFasterThanAllowed) {
  Random random(3);
  const Pace pace{60, 2};
  Vec3 place{}, velocity{}, goal{};
  double fastest = 0;
  for (int k = 0; k < 200000; ++k) {
    if (k % 17 == 0) goal = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double seconds = k % 1000 == 0 ? 0.4 : random.uniform(1e-4, 4e-3);
    const Vec3 move = follow(place - goal, velocity, pace, seconds);
    place += move;
    ASSERT_LE(glm::length(move), 2 * seconds * (1 + 1e-12));
    ASSERT_LE(glm::length(velocity), 2 * (1 + 1e-12));
    fastest = std::max(fastest, glm::length(velocity));
  }
  EXPECT_GT(fastest, 1.5) << "and near to that";
}

// Far away each step is that from 2 speed / r, so the speed's fixed point is k (v (1 - s) - 2 s speed) = v with s = r dt, k =
// e^(-s): 1.5 % under what is allowed at 1 kHz.
TEST(Follower, FarAwayItGoesAtItsSpeedAndArrivesAtRest) {
  const Pace pace{60, 2};
  const double s = 0.06, k = std::exp(-s), speed = 2 * 2 * s * k / (1 - k + k * s);
  double offset = 10, velocity = 0;
  for (int step = 0; step < 1000; ++step) offset += follow(offset, velocity, pace, 1e-3);
  EXPECT_NEAR(velocity, -speed, 1e-9);
  EXPECT_NEAR(speed, 2, 0.04);
  for (int step = 0; step < 6000; ++step) {
    offset += follow(offset, velocity, pace, 1e-3);
    ASSERT_GE(offset, -1e-12) << "never beyond, but for rounding";
  }
  EXPECT_NEAR(offset, 0, 1e-12);
  EXPECT_NEAR(velocity, 0, 1e-12);
}

TEST(Follower, NoTimeIsNoMove) {
  double velocity = 0.3;
  EXPECT_EQ(follow(1.0, velocity, Pace{60, 2}, 0), 0);
  EXPECT_EQ(velocity, 0.3);
}

}  // namespace
}  // namespace wholehand::device
