// SPDX-License-Identifier: MIT
#include "statistics/logistic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wholehand {
namespace {

// One term of two values: the log odds of both groups have a closed form. 3 of 4 hold at 1, 1 of 4 at 0.
TEST(Logistic, OneTermByHand) {
  const std::vector<double> terms{1, 0, 1, 0, 1, 0, 1, 0};
  const std::vector<char> success{1, 1, 1, 0, 1, 0, 0, 0};
  const LogisticModel model = fit_logistic_model(terms, 1, success);
  ASSERT_TRUE(model.is_fitted);
  EXPECT_FALSE(model.has_ridge);
  EXPECT_NEAR(model.coefficients[0], 2 * std::log(3), 1e-9);
  EXPECT_NEAR(model.intercept, -std::log(3), 1e-9);
  // of a log odds ratio: the root of the sum of 1 / each of the four counts
  EXPECT_NEAR(model.errors[0], std::sqrt(1 / 3.0 + 1 + 1 / 3.0 + 1), 1e-9);
  EXPECT_NEAR(model.interval(0).high - model.interval(0).low, 2 * NORMAL_95 * model.errors[0], 1e-12);
}

// The minimum of the likelihood by scipy.optimize, and numpy's inverse of its curvature there.
TEST(Logistic, OfAnotherProgram) {
  const std::vector<double> terms{0.4, 1.6, 0.8, 2, 0.8, 3, 1.2, 0, 1.2, 3, 1.6, 3, 1.6, 4, 2.2, 0, 2.2, 2, 0, 0, 0.4, 0, 1.2, 4};
  const std::vector<char> success{0, 0, 0, 1, 0, 1, 0, 1, 1, 0, 1, 1};
  const LogisticModel model = fit_logistic_model(terms, 2, success);
  ASSERT_TRUE(model.is_fitted);
  EXPECT_NEAR(model.coefficients[0], 4.565694563821, 1e-8);
  EXPECT_NEAR(model.coefficients[1], -1.4587770921978125, 1e-8);
  EXPECT_NEAR(model.intercept, -1.5704311764603582, 1e-8);
  EXPECT_NEAR(model.errors[0], 3.0810416099436, 1e-7);
  EXPECT_NEAR(model.errors[1], 1.0968772602019183, 1e-7);
}

TEST(Logistic, WhatCannotBeFittedHasNoErrors) {
  const std::vector<double> terms{0, 5, 1, 5, 2, 5, 3, 5};
  const LogisticModel separated = fit_logistic_model(terms, 2, std::vector<char>{0, 0, 1, 1});
  EXPECT_TRUE(separated.has_ridge);
  EXPECT_GT(separated.coefficients[0], 0);
  EXPECT_TRUE(std::isnan(separated.errors[0]));
  const LogisticModel mixed = fit_logistic_model(terms, 2, std::vector<char>{0, 1, 0, 1});
  EXPECT_EQ(mixed.coefficients[1], 0) << "does not vary";
  EXPECT_TRUE(std::isnan(mixed.errors[1]));
  EXPECT_FALSE(std::isnan(mixed.errors[0]));
  const LogisticModel never = fit_logistic_model(terms, 2, std::vector<char>{0, 0, 0, 0});
  EXPECT_FALSE(never.is_fitted);
  EXPECT_EQ(never.coefficients, (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace wholehand
