// SPDX-License-Identifier: MIT
// sanitizers: address
#include "evidence/trials/logistic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

using Terms = std::array<double, SCORE_TERM_COUNT>;

double drawn_unit(std::uint64_t& state) { return unit_interval(split_mix(state)); }

// Successes with the probabilities of a model that is known.
std::vector<TermedGrip> drawn_grips(std::size_t count, const Terms& coefficients, double intercept, std::uint64_t seed) {
  std::vector<TermedGrip> grips(count);
  for (TermedGrip& grip : grips) {
    double at = intercept;
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
      grip.terms[k] = drawn_unit(seed);
      at += coefficients[k] * grip.terms[k];
    }
    grip.success = drawn_unit(seed) < 1 / (1 + std::exp(-at));
  }
  return grips;
}

// One term of two values: the log odds of both groups have a closed form. 3 of 4 hold at 1, 1 of 4 at 0. The other terms do not vary
// and get the least: 0.02 of the sum.
TEST(TrialWeights, OneTermByHand) {
  std::vector<TermedGrip> grips;
  for (int i = 0; i < 4; ++i) {
    grips.push_back({{1, 0.5, 0.5, 0.5, 0.5, 0.5}, i < 3});
    grips.push_back({{0, 0.5, 0.5, 0.5, 0.5, 0.5}, i < 1});
  }
  const LogisticFit fit = fit_logistic(grips);
  ASSERT_TRUE(fit.is_fitted);
  EXPECT_FALSE(fit.has_ridge);
  EXPECT_NEAR(fit.coefficients[0], 2 * std::log(3), 1e-9);
  EXPECT_FALSE(fit.is_least[0]);
  double at_zero = fit.intercept;
  const Terms weights = weights_of(fit);
  EXPECT_NEAR(weights[0], 0.9, 1e-12);
  for (std::size_t k = 1; k < SCORE_TERM_COUNT; ++k) {
    at_zero += 0.5 * fit.coefficients[k];
    EXPECT_TRUE(fit.is_least[k]) << "does not vary";
    EXPECT_NEAR(weights[k], 0.02, 1e-12);
  }
  EXPECT_NEAR(at_zero, -std::log(3), 1e-9);
}

// The slope of the log-likelihood along each coefficient, and last along the intercept.
std::array<double, SCORE_TERM_COUNT + 1> slope_at(const std::vector<TermedGrip>& grips, const LogisticFit& fit) {
  std::array<double, SCORE_TERM_COUNT + 1> slope{};
  for (const TermedGrip& grip : grips) {
    double at = fit.intercept;
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) at += fit.coefficients[k] * grip.terms[k];
    const double rest = (grip.success ? 1 : 0) - 1 / (1 + std::exp(-at));
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) slope[k] += rest * grip.terms[k];
    slope[SCORE_TERM_COUNT] += rest;
  }
  return slope;
}

// At the largest likelihood within the bounds no step that the bounds allow climbs (Karush, Kuhn and Tucker's conditions; the
// likelihood is concave, so they are enough). Coefficient k grows with the amount j by 0.88 if k = j, and by 0.02 in any case.
TEST(TrialWeights, LikelihoodIsLargestWithinTheBounds) {
  int bound = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto grips = drawn_grips(300, {2, 1, -1, 0.1, 3, 4}, -4, seed);
    const LogisticFit fit = fit_logistic(grips);
    ASSERT_FALSE(fit.has_ridge) << seed;
    const auto slope = slope_at(grips, fit);
    EXPECT_NEAR(slope[SCORE_TERM_COUNT], 0, 1e-6);
    double all = 0;
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) all += slope[k];
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
      const double along = 0.88 * slope[k] + 0.02 * all;
      if (fit.is_least[k]) {
        EXPECT_LE(along, 1e-6) << seed << " " << k;  // at most so in units of a regressor's deviation, which is below 1
      } else {
        EXPECT_NEAR(along, 0, 1e-6) << seed << " " << k;
      }
      bound += fit.is_least[k] ? 1 : 0;
    }
    const Terms weights = weights_of(fit);
    double sum = 0;
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) {
      EXPECT_GE(weights[k], 0.02 - 1e-12);
      EXPECT_EQ(fit.is_least[k], weights[k] < 0.02 + 1e-9) << seed << " " << k;
      sum += weights[k];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
  EXPECT_GT(bound, 40) << "the third term lowers success: it is at its bound in every draw";
}

TEST(TrialWeights, FindsTheModelOfManyGrips) {
  const Terms truth{2, 1, 1.5, 0.5, 3, 4};
  const LogisticFit fit = fit_logistic(drawn_grips(40'000, truth, -6, 17));
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) EXPECT_NEAR(fit.coefficients[k], truth[k], 0.25) << k;
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) EXPECT_NEAR(weights_of(fit)[k], truth[k] / 12, 0.02) << k;
}

// Grips whose first term is small cannot be tried. So that term predicts which grips hold, though among tried grips it predicts nothing.
TEST(TrialWeights, DiscardedGripsAreFailuresOfTheFit) {
  auto grips = drawn_grips(400, {0, 0, 0, 0, 0, 8}, -4, 41);
  EXPECT_TRUE(try_weights(grips, {1, 0, 0, 0, 0, 0}, 1).fit.is_least[0])
      << "the first term tells nothing of those that can be tried";
  for (TermedGrip& grip : grips) {
    grip.discarded = grip.terms[0] < 0.3;
    grip.success = grip.success && !grip.discarded;
  }
  const WeightTrial trial = try_weights(grips, {0, 0, 0, 0, 0, 1}, 1);
  EXPECT_GT(trial.weights[0], 0.2);
  EXPECT_EQ(trial.fitted_on + trial.judged_on, 400u) << "the discarded ones too";
  EXPECT_TRUE(trial.is_better());
  const auto discarded = std::count_if(grips.begin(), grips.end(), [](const TermedGrip& grip) { return grip.discarded; });
  EXPECT_NEAR(static_cast<double>(trial.tried.fitted.successes + trial.tried.fitted.failures),
              static_cast<double>(400 - discarded) / 2, 2);
  EXPECT_EQ(trial.all.fitted.successes + trial.all.fitted.failures, trial.judged_on);
  EXPECT_GT(trial.all.difference.difference, trial.tried.difference.difference);
}

// Outcomes of one grip stay together: the same grips ten times over leave the halves and the intervals as they were.
TEST(TrialWeights, OutcomesOfAGripAreDrawnTogether) {
  const auto grips = drawn_grips(200, {0, 0, 4, 0, 0, 4}, -4, 11);
  std::vector<TermedGrip> repeated;
  for (const TermedGrip& grip : grips) repeated.insert(repeated.end(), 10, grip);
  const WeightTrial once = try_weights(grips, {1, 0, 0, 0, 0, 0}, 3), ten = try_weights(repeated, {1, 0, 0, 0, 0, 0}, 3, 10);
  EXPECT_EQ(ten.fitted_on, once.fitted_on);
  EXPECT_EQ(ten.judged_on, once.judged_on);
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) EXPECT_NEAR(ten.weights[k], once.weights[k], 1e-6) << k;
  EXPECT_NEAR(ten.all.difference.interval.low, once.all.difference.interval.low, 1e-9);
  EXPECT_NEAR(ten.all.difference.interval.high, once.all.difference.interval.high, 1e-9);
  EXPECT_EQ(ten.all.fitted.successes, 10 * once.all.fitted.successes);
}

TEST(TrialWeights, SeparableGripsAreFittedWithARidge) {
  std::vector<TermedGrip> grips;
  for (int i = 0; i < 20; ++i) grips.push_back({{i / 20.0, 0.3, 0, 0, 0, 0}, i >= 10});
  const LogisticFit fit = fit_logistic(grips);
  EXPECT_TRUE(fit.is_fitted);
  EXPECT_TRUE(fit.has_ridge);
  EXPECT_TRUE(std::isfinite(fit.coefficients[0]));
  EXPECT_GT(fit.coefficients[0], 1);
}

TEST(TrialWeights, TermsThatDependOnOneAnotherAreFittedWithARidge) {
  auto grips = drawn_grips(200, {2, 0, 0, 0, 0, 0}, -1, 3);
  for (TermedGrip& grip : grips) grip.terms[1] = grip.terms[0];
  const LogisticFit fit = fit_logistic(grips);
  EXPECT_TRUE(fit.has_ridge);
  EXPECT_NEAR(fit.coefficients[0], fit.coefficients[1], 1e-6) << "shared alike";
}

TEST(TrialWeights, WithoutBothOutcomesNothingIsFitted) {
  auto grips = drawn_grips(20, {}, 0, 3);
  for (TermedGrip& grip : grips) grip.success = true;
  EXPECT_FALSE(fit_logistic(grips).is_fitted);
  EXPECT_FALSE(try_weights(grips, {1, 0, 0, 0, 0, 0}, 1).fit.is_fitted);
  EXPECT_FALSE(fit_logistic({}).is_fitted);
}

TEST(TrialWeights, BetterWeightsAreFoundBetterOnTheOtherHalf) {
  const auto grips = drawn_grips(600, {0, 0, 0, 0, 0, 12}, -6, 29);
  const WeightTrial trial = try_weights(grips, {1, 0, 0, 0, 0, 0}, 1);
  EXPECT_NEAR(static_cast<double>(trial.fitted_on), static_cast<double>(trial.judged_on), 2);
  EXPECT_EQ(trial.fitted_on + trial.judged_on, 600u);
  EXPECT_GT(trial.all.fitted.auc, 0.9);
  EXPECT_LT(trial.all.given.auc, 0.6);
  EXPECT_EQ(trial.tried.difference.difference, trial.all.difference.difference) << "none was discarded";
  EXPECT_TRUE(trial.is_better());
  // weights that are as good are not better
  EXPECT_FALSE(try_weights(grips, trial.weights, 1).is_better());
}

}  // namespace
}  // namespace wholehand
