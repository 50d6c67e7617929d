// SPDX-License-Identifier: MIT
// Scores: every term at its ends, the weights, and whole scores against states evaluated one by one.
#include "core/score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "tests/support/hard_scene.h"
#include "tests/support/scenes.h"
#include "tests/support/special_values.h"

namespace wholehand {
namespace {

constexpr double SCORE_ROUNDING = 1e-14;  // sums of a few numbers up to 1

// ---- terms ----

TEST(Score, FingersTermIsTheShareOfFive) {
  EXPECT_EQ(core_f64::fingers_term(0), 0);
  EXPECT_DOUBLE_EQ(core_f64::fingers_term(2), 0.4);
  EXPECT_EQ(core_f64::fingers_term(5), 1);
}

TEST(Score, ContactsTermIsTheShareOfTwentyFour) {
  EXPECT_EQ(core_f64::contacts_term(0), 0);
  EXPECT_DOUBLE_EQ(core_f64::contacts_term(6), 0.25);
  EXPECT_EQ(core_f64::contacts_term(24), 1);
}

TEST(Score, DepthTermFallsToZeroAtTenMillimeters) {
  EXPECT_EQ(core_f64::depth_term(0, 0), 1);
  EXPECT_DOUBLE_EQ(core_f64::depth_term(2e-3, 1e-3), 0.8);
  EXPECT_DOUBLE_EQ(core_f64::depth_term(1e-3, 4e-3), 0.6);  // the deeper of the two
  EXPECT_EQ(core_f64::depth_term(10e-3, 0), 0);
  EXPECT_EQ(core_f64::depth_term(0, 50e-3), 0);
}

TEST(Score, PostureTermPrefersTheMiddle) {
  EXPECT_EQ(core_f64::posture_term(0.5), 1);
  EXPECT_EQ(core_f64::posture_term(0), 0);
  EXPECT_EQ(core_f64::posture_term(1), 0);
  EXPECT_DOUBLE_EQ(core_f64::posture_term(0.75), 0.5);
  EXPECT_DOUBLE_EQ(core_f64::posture_term(0.1), 0.2);
}

TEST(Score, ForceTermFallsToZeroAtTheLargest) {
  EXPECT_EQ(core_f64::force_term(0, 8), 1);
  EXPECT_DOUBLE_EQ(core_f64::force_term(2, 8), 0.75);
  EXPECT_EQ(core_f64::force_term(8, 8), 0);
  EXPECT_EQ(core_f64::force_term(0, 0), 0);
}

TEST(Score, HoldTermFallsOnceTheGripStrengthIsNotEnough) {
  EXPECT_EQ(core_f64::hold_term(0, 40), 1);
  EXPECT_EQ(core_f64::hold_term(40, 40), 1);
  EXPECT_DOUBLE_EQ(core_f64::hold_term(80, 40), 0.5);
  EXPECT_EQ(core_f64::hold_term(INFINITE, 40), 0);
  EXPECT_EQ(core_f64::hold_term(5, 0), 0);
  EXPECT_FALSE(std::isnan(core_f64::hold_term(0, 0)));
}

// ---- weights ----

double weighted(const Scene& scene, const ScoreTerms& t) {
  const ScoreWeights& w = scene.score;
  const double still = w.fingers * t.fingers + w.contacts * t.contacts + w.depth * t.depth + w.posture * t.posture;
  if (scene.tilts.empty()) return still / (w.fingers + w.contacts + w.depth + w.posture);
  return still + w.force * t.force + w.hold * t.hold;
}

TEST(Score, WeightsAreTheScenes) {
  const std::array<double, 6> standard{0.02, 0.02, 0.69, 0.02, 0.13, 0.12};
  EXPECT_EQ(effective_weights(three_beakers()), standard);
  Scene scene = three_beakers();
  scene.score = {1, 2, 3, 4, 5, 6};  // they need not sum to 1
  const std::array<double, 6> own{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(effective_weights(scene), own);
}

TEST(Score, WithoutTiltsTheRemainingWeightsSumToOne) {
  const auto weights = effective_weights(scene_of({beaker1()}));
  const std::array<double, 6> expected{0.02 / 0.75, 0.02 / 0.75, 0.69 / 0.75, 0.02 / 0.75, 0, 0};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(weights[k], expected[k], SCORE_ROUNDING) << k;
  EXPECT_EQ(weights[4], 0);
  EXPECT_EQ(weights[5], 0);
}

TEST(Score, WeightsThatAreAllOnForceAndHoldLeaveNothingWithoutTilts) {
  Scene scene = scene_of({beaker1()});
  scene.score = {0, 0, 0, 0, 0.5, 0.5};
  for (const double weight : effective_weights(scene)) EXPECT_EQ(weight, 0);  // and no division by zero
}

// ---- whole scores ----

void expect_score(const Scene& scene, const Evaluator& evaluator, std::size_t v, const GripInput& grip, const GripResult& result,
                  const std::string& where) {
  const GripScore score = evaluator.score(v, grip, result);
  if (result.reason != Reason::none) {
    EXPECT_EQ(score.score, 0) << where;
    return;
  }
  EXPECT_NEAR(score.terms.fingers, std::popcount(result.used_mask) / 5.0, SCORE_ROUNDING) << where;
  EXPECT_NEAR(score.terms.contacts, std::popcount(result.touch_mask) / 24.0, SCORE_ROUNDING) << where;
  EXPECT_NEAR(score.terms.depth, 1 - std::min(1.0, std::max(result.phalanx_depth, result.palm_depth) / 0.01), SCORE_ROUNDING)
      << where;
  EXPECT_NEAR(score.terms.posture, 1 - std::abs(2 * result.closure - 1), SCORE_ROUNDING) << where;

  const std::vector<double> fills = scene.liquid ? scene.liquid->fills : std::vector<double>{0};
  double largest_force = 0, largest_hold = 0;
  ASSERT_EQ(score.fills.size(), scene.tilts.empty() ? 0 : fills.size()) << where;
  for (std::size_t f = 0; f < score.fills.size(); ++f) {
    double peak = -1, peak_tilt = 0, hold = 0, safe = std::numeric_limits<double>::quiet_NaN();
    bool still_safe = true;
    for (const double tilt : scene.tilts) {
      const LiquidResult liquid = scene.liquid ? evaluator.liquid(v, fills[f], tilt) : LiquidResult{};
      const StateResult state = evaluator.state(v, grip, result, liquid, tilt);
      if (state.feedback_force > peak) {
        peak = state.feedback_force;
        peak_tilt = tilt;
      }
      hold = std::max(hold, state.hold_force);
      still_safe = still_safe && state.normal_force < scene.force.max && state.hold_force <= scene.force.grip_strength;
      if (still_safe) safe = tilt;
    }
    EXPECT_NEAR(score.fills[f].peak_force, peak, 1e-12) << where;  // N: the liquid may have been solved with another start
    EXPECT_EQ(score.fills[f].peak_tilt, peak_tilt) << where;
    if (std::isinf(hold)) {
      EXPECT_EQ(score.fills[f].largest_hold, INFINITE) << where;
    } else {
      EXPECT_NEAR(score.fills[f].largest_hold, hold, 1e-10) << where;
    }
    if (std::isnan(safe)) {
      EXPECT_TRUE(std::isnan(score.fills[f].safe_tilt)) << where;
    } else {
      EXPECT_EQ(score.fills[f].safe_tilt, safe) << where;
    }
    largest_force = std::max(largest_force, peak);
    largest_hold = std::max(largest_hold, hold);
  }
  if (scene.tilts.empty()) {
    EXPECT_EQ(score.terms.force, 0) << where;
    EXPECT_EQ(score.terms.hold, 0) << where;
  } else {
    EXPECT_NEAR(score.terms.force, 1 - largest_force / scene.force.max, 1e-12) << where;
    EXPECT_NEAR(score.terms.hold, largest_hold > 0 ? std::min(1.0, scene.force.grip_strength / largest_hold) : 1, 1e-12) << where;
  }
  if (result.plausible) {
    EXPECT_NEAR(score.score, weighted(scene, score.terms), SCORE_ROUNDING) << where;
  } else {
    EXPECT_EQ(score.score, 0) << where;
  }
}

TEST(Score, ScoresAreTheWeightedTermsOverAllStates) {
  int feasible = 0, infeasible = 0, implausible = 0, pinched = 0, unsafe = 0, ends_early = 0;
  for (const Scene& scene : {hard_scene(), three_beakers()}) {
    const auto evaluator = make_core_evaluator(scene);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      int i = 0;
      for (const GripInput& grip : grips_with_hopeless_ones(scene.vessels[v], 21 + v, 40)) {
        GripResult result;
        evaluator->grip(v, grip, result);
        expect_score(scene, *evaluator, v, grip, result, scene.vessels[v].name + " grip " + std::to_string(i++));
        (result.reason == Reason::none ? feasible : infeasible) += 1;
        if (result.reason != Reason::none) continue;
        implausible += !result.plausible;
        pinched += !result.antipodal;
        for (const FillTerms& fill : evaluator->score(v, grip, result).fills) {
          unsafe += std::isnan(fill.safe_tilt);
          ends_early += fill.safe_tilt < scene.tilts.back();
        }
      }
    }
  }
  // the samples hold every kind
  EXPECT_GT(feasible, 100);
  EXPECT_GT(infeasible, 10);
  EXPECT_GT(implausible, 10);
  EXPECT_GT(pinched, 10);
  EXPECT_GT(unsafe, 10);
  EXPECT_GT(ends_early, 10);
}

TEST(Score, WithoutLiquidThereIsOneFillTheEmptyGlass) {
  Scene scene = three_beakers();
  scene.liquid.reset();
  const auto evaluator = make_core_evaluator(scene);
  for (const GripInput& grip : sample_grips(scene.vessels[0], 10, 31)) {
    GripResult result;
    evaluator->grip(0, grip, result);
    expect_score(scene, *evaluator, 0, grip, result, "no liquid");
    if (result.reason == Reason::none) {
      EXPECT_EQ(evaluator->score(0, grip, result).fills.size(), 1u);
    }
  }
}

TEST(Score, WithoutTiltsThereAreNoFillTerms) {
  Scene scene = three_beakers();
  scene.tilts.clear();
  const auto evaluator = make_core_evaluator(scene);
  double best = 0;
  for (const GripInput& grip : sample_grips(scene.vessels[0], 20, 32)) {
    GripResult result;
    evaluator->grip(0, grip, result);
    expect_score(scene, *evaluator, 0, grip, result, "no tilts");
    best = std::max(best, evaluator->score(0, grip, result).score);
  }
  EXPECT_GT(best, 0.3);
  EXPECT_LE(best, 1);
}

TEST(Score, LoneTiltZeroIsAllThatCounts) {
  Scene scene = three_beakers();
  scene.tilts = {0};
  const auto evaluator = make_core_evaluator(scene);
  GripInput grip;
  grip.height = 50e-3;
  GripResult result;
  evaluator->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  for (const FillTerms& fill : evaluator->score(0, grip, result).fills) {
    EXPECT_EQ(fill.peak_force, 0.8);  // no tilt, no torque: the base
    EXPECT_EQ(fill.peak_tilt, 0);
    EXPECT_EQ(fill.safe_tilt, 0);
  }
  EXPECT_NEAR(evaluator->score(0, grip, result).terms.force, 0.9, SCORE_ROUNDING);
}

TEST(Score, SafeUpToTheGripStrengthAndShortOfTheLargestForce) {
  Scene scene = three_beakers();
  scene.tilts = linspace(0, radians(60), 4);
  scene.liquid->fills = {0};
  GripInput grip;
  grip.height = 60e-3;
  GripResult result;
  const auto evaluator = make_core_evaluator(scene);
  evaluator->grip(0, grip, result);
  ASSERT_TRUE(result.antipodal);
  const StateResult third = evaluator->state(0, grip, result, evaluator->liquid(0, 0, scene.tilts[2]), scene.tilts[2]);
  const StateResult last = evaluator->state(0, grip, result, evaluator->liquid(0, 0, scene.tilts[3]), scene.tilts[3]);
  ASSERT_LT(third.normal_force, last.normal_force);
  const auto safe_tilt = [&](double largest, double strength) {
    scene.force.max = largest;
    scene.force.grip_strength = strength;
    return make_core_evaluator(scene)->score(0, grip, result).fills[0].safe_tilt;
  };
  EXPECT_EQ(safe_tilt(100, 1000), scene.tilts[3]);
  EXPECT_EQ(safe_tilt(last.normal_force, 1000), scene.tilts[2]);  // at F_max the rendered force no longer grows: not safe
  EXPECT_EQ(safe_tilt(std::nextafter(last.normal_force, 100), 1000), scene.tilts[3]);
  double largest_hold = 0;
  for (const double tilt : scene.tilts) {
    largest_hold = std::max(largest_hold, evaluator->state(0, grip, result, evaluator->liquid(0, 0, tilt), tilt).hold_force);
  }
  EXPECT_EQ(safe_tilt(100, largest_hold), scene.tilts[3]);  // as strong as it takes is enough
  EXPECT_NE(safe_tilt(100, std::nextafter(largest_hold, 0)), scene.tilts[3]);
}

}  // namespace
}  // namespace wholehand
