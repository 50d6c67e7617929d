// SPDX-License-Identifier: MIT
// sanitizers: address
#include "trials/logistic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random_bits.h"

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

// One term of two values: the log odds of both groups have a closed form. 3 of 4 hold at 1, 1 of 4 at 0.
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
  EXPECT_NEAR(fit.intercept, -std::log(3), 1e-9);
  for (std::size_t k = 1; k < SCORE_TERM_COUNT; ++k) EXPECT_EQ(fit.coefficients[k], 0) << "does not vary";
  EXPECT_EQ(weights_of(fit), (Terms{1, 0, 0, 0, 0, 0}));
}

// At the largest likelihood the slope along every unknown is 0.
TEST(TrialWeights, LikelihoodIsLargestThere) {
  const auto grips = drawn_grips(300, {2, 1, -1, 0, 3, 4}, -4, 5);
  const LogisticFit fit = fit_logistic(grips);
  ASSERT_FALSE(fit.has_ridge);
  std::array<double, SCORE_TERM_COUNT + 1> slope{};
  for (const TermedGrip& grip : grips) {
    double at = fit.intercept;
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) at += fit.coefficients[k] * grip.terms[k];
    const double rest = (grip.success ? 1 : 0) - 1 / (1 + std::exp(-at));
    for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) slope[k] += rest * grip.terms[k];
    slope[SCORE_TERM_COUNT] += rest;
  }
  for (const double one : slope) EXPECT_NEAR(one, 0, 1e-6);
}

TEST(TrialWeights, FindsTheModelOfManyGrips) {
  const Terms truth{2, 1, -1, 0, 3, 4};
  const LogisticFit fit = fit_logistic(drawn_grips(40'000, truth, -4, 17));
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) EXPECT_NEAR(fit.coefficients[k], truth[k], 0.25) << k;
  const Terms weights = weights_of(fit);
  EXPECT_EQ(weights[2], 0) << "negative";
  double sum = 0;
  for (const double weight : weights) sum += weight;
  EXPECT_NEAR(sum, 1, 1e-12);
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
  EXPECT_GT(trial.fitted.auc, 0.9);
  EXPECT_LT(trial.given.auc, 0.6);
  EXPECT_TRUE(trial.is_better());
  // weights that are as good are not better
  EXPECT_FALSE(try_weights(grips, trial.weights, 1).is_better());
}

}  // namespace
}  // namespace wholehand
