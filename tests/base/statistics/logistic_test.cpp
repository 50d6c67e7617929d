// SPDX-License-Identifier: MIT
#include "base/statistics/logistic.h"

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
  // standard error of a log odds ratio: the root of the sum of 1 / each of the four counts
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

// The sum of 500 times 187.18 / 500 is not 187.18, so that a deviation by the mean is not 0.
TEST(Logistic, AConstantIsNoTermOfAnySize) {
  for (const double constant : {187.18, 0.1, 1e9}) {
    std::vector<double> terms;
    std::vector<char> success;
    for (int i = 0; i < 500; ++i) {
      terms.insert(terms.end(), {i % 7 - 3.0, constant});
      success.push_back(i % 7 + i % 11 > 7);
    }
    const LogisticModel model = fit_logistic_model(terms, 2, success);
    EXPECT_TRUE(model.is_fitted);
    EXPECT_FALSE(model.has_ridge) << constant;
    EXPECT_EQ(model.coefficients[1], 0) << constant;
    EXPECT_GT(model.errors[0], 0) << constant;
    EXPECT_TRUE(std::isnan(model.errors[1]));
  }
}

// A ridge of 1 allows a coefficient of more than 20 deviations where rows are many. At the largest likelihood its slope is 0: the
// terms' sum of what is left is the coefficient itself.
TEST(Logistic, TheRidgeIsClimbedToItsTop) {
  constexpr int COUNT = 20000;
  std::vector<double> terms;
  std::vector<char> success;
  for (int i = 0; i < COUNT; ++i) {
    terms.push_back((i + 0.5) / COUNT);
    success.push_back(i >= COUNT / 2);
  }
  const LogisticModel model = fit_logistic_model(terms, 1, success);
  ASSERT_TRUE(model.is_fitted);
  EXPECT_TRUE(model.has_ridge);
  const double deviation = std::sqrt((1 - 1.0 / COUNT / COUNT) / 12);
  const double own = model.coefficients[0] * deviation;  // in deviations
  EXPECT_GT(own, 20);
  double slope = 0;
  for (int i = 0; i < COUNT; ++i) {
    const double p = 1 / (1 + std::exp(-model.intercept - model.coefficients[0] * terms[i]));
    slope += (success[i] - p) * (terms[i] - 0.5) / deviation;
  }
  // steps end at 1e-9, where the curvature is below that of all rows, 5,000
  EXPECT_NEAR(slope, own, 1e-5);
}

}  // namespace
}  // namespace wholehand
