// SPDX-License-Identifier: MIT
// The loop of a held grip against theory.
// sanitizers: none
#include "device/loop/grip_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace wholehand::device {
namespace {

TEST(GripLoop, AnOrdinaryUserHolds) {
  const GripLoopResult result = hold_and_tilt({});
  EXPECT_EQ(result.outcome, GripOutcome::settles);
  EXPECT_GT(result.response_time, 0.075);
  EXPECT_LT(result.response_time, 1);
  // finger and spring yield to the torque's increase until the user answers: at most by all of it at once
  EXPECT_LT(result.opened, 3.0 / (500 + 600));
  EXPECT_GT(result.opened, 0);
}

// At rest the user's force is F_base + excess, so that k_open x = excess.
TEST(GripLoop, RestsWhereTheGripForceIsTheWantedOne) {
  GripLoop loop;
  loop.tilt = 0;
  loop.excess = 0;
  EXPECT_EQ(hold_and_tilt(loop).outcome, GripOutcome::settles);
  loop.base = 5;
  loop.excess = 4;  // beyond F_max: never felt
  EXPECT_EQ(hold_and_tilt(loop).outcome, GripOutcome::saturates);
}

// With a user who hardly answers, what is left is a spring that is sampled.
TEST(GripLoop, LargestSpringIsThatOfTheSampledTheory) {
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    GripLoop loop;
    loop.rate = rate;
    loop.response = 1e4;
    EXPECT_NEAR(largest_k_open(loop) / sampled_k_open(loop), 1, 0.01) << rate;
  }
}

// With a finger that is quick beside the user, what is left is an integral that is delayed: its limit is pi / 2 over the loop's
// gain. The finger's own lag, (b / (k_f + k_open)) against the reaction, and half a sample come on top.
TEST(GripLoop, LargestSpringOfASlowUserIsThatOfTheDelayedIntegral) {
  for (const double reaction : {0.3, 0.4, 0.6, 0.8}) {
    GripLoop loop;
    loop.reaction = reaction;
    const double theory = reaction_k_open(loop), simulated = largest_k_open(loop);
    const double lag = (loop.device_damping + loop.finger_damping) / (loop.finger_stiffness + simulated) + 0.5 / loop.rate;
    EXPECT_LT(simulated, 1.005 * theory) << reaction;
    // the limit moves by (1 + k_open / k_f) per share of delay
    EXPECT_GT(simulated, theory * (1 - 1.5 * (1 + theory / loop.finger_stiffness) * lag / reaction)) << reaction;
  }
  EXPECT_TRUE(std::isinf(reaction_k_open({})));
}

TEST(GripLoop, OutcomesAreToldApart) {
  GripLoop shaking;
  shaking.k_open = 3 * sampled_k_open(shaking);
  EXPECT_EQ(hold_and_tilt(shaking).outcome, GripOutcome::oscillates);
  EXPECT_TRUE(std::isnan(hold_and_tilt(shaking).response_time));
  GripLoop slow_and_soft;  // the tilt is over before the user answers, and nothing but the finger holds against it
  slow_and_soft.reaction = 0.4;
  slow_and_soft.response = 0.6;
  slow_and_soft.k_open = 50;
  slow_and_soft.finger_stiffness = 200;
  slow_and_soft.range = 6;
  slow_and_soft.excess = 0;
  slow_and_soft.tilt_speed = 30;
  const GripLoopResult lost = hold_and_tilt(slow_and_soft);
  EXPECT_EQ(lost.outcome, GripOutcome::lost) << lost.opened;
  EXPECT_GT(lost.opened, slow_and_soft.band);
}

TEST(GripLoop, TableHasARowASessionAndTheSameEveryTime) {
  const auto rows = grip_loop_rows(true);
  EXPECT_GT(rows.size(), 1000u);
  const std::string csv = grip_loop_csv(rows, "a,b,c,d");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(rows.size()) + 1);
  EXPECT_EQ(csv, grip_loop_csv(grip_loop_rows(true), "a,b,c,d"));
  for (int outcome = 0; outcome < GRIP_OUTCOMES; ++outcome)
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [outcome](const GripLoopRow& row) {
      return static_cast<int>(row.result.outcome) == outcome;
    })) << GRIP_OUTCOME_NAMES[outcome];
}

}  // namespace
}  // namespace wholehand::device
