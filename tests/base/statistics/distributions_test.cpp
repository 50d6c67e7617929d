// SPDX-License-Identifier: MIT
#include "base/statistics/distributions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/normal.h"

namespace wholehand {
namespace {

TEST(IncompleteBeta, OfClosedForms) {
  for (const double x : {0.0, 1e-6, 0.2, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(incomplete_beta(1, 1, x), x, 1e-15);
    EXPECT_NEAR(incomplete_beta(3, 1, x), x * x * x, 1e-14);
    EXPECT_NEAR(incomplete_beta(1, 4, x), 1 - std::pow(1 - x, 4), 1e-14);
    EXPECT_NEAR(incomplete_beta(2.5, 7, x) + incomplete_beta(7, 2.5, 1 - x), 1, 1e-14);
  }
}

TEST(IncompleteBeta, OfNoNumberIsNone) { EXPECT_TRUE(std::isnan(incomplete_beta(2, 3, std::nan("")))); }

// scipy.special.betainc
TEST(IncompleteBeta, OfAnotherProgram) {
  const auto expect_share = [](double a, double b, double x, double value, double tolerance) {
    EXPECT_NEAR(incomplete_beta(a, b, x) / value, 1, tolerance) << a << " " << b << " " << x;
  };
  expect_share(0.5, 0.5, 0.3, 0.3690101195655454, 1e-12);
  expect_share(2, 3, 0.7, 0.9163, 1e-12);
  expect_share(35, 0.5, 0.98, 0.23603137843810348, 1e-12);
  expect_share(1000, 2000, 0.34, 0.781215091161411, 1e-9);
  expect_share(1e5, 1e5, 0.501, 0.8144532553270518, 1e-9);
}

// scipy.stats.f.sf
TEST(FTail, OfAnotherProgram) {
  EXPECT_NEAR(f_tail(3.2, 2, 69) / 0.04687941655103914, 1, 1e-11);
  EXPECT_NEAR(f_tail(55.5, 2, 69) / 4.299245094221946e-15, 1, 1e-11);
  EXPECT_NEAR(f_tail(0.4, 1, 10) / 0.5412795170748117, 1, 1e-11);
  EXPECT_NEAR(f_tail(1000, 3, 20) / 5.986006215689513e-22, 1, 1e-11);
  EXPECT_EQ(f_tail(0, 3, 20), 1);
}

TEST(ChiSquareQuantile, OfClosedForms) {
  for (const double p : {1e-6, 0.025, 0.5, 0.975, 0.999999}) {
    EXPECT_NEAR(chi_square_quantile(p, 2) / (-2 * std::log1p(-p)), 1, 1e-9) << p;
    EXPECT_NEAR(std::sqrt(chi_square_quantile(p, 1)) / normal_quantile((1 + p) / 2), 1, 1e-8) << p;
    const double x = chi_square_quantile(p, 4);
    EXPECT_NEAR(-std::expm1(-x / 2) - x / 2 * std::exp(-x / 2), p, 1e-9) << p;
  }
}

// Any table of the distribution.
TEST(ChiSquareQuantile, OfTables) {
  EXPECT_NEAR(chi_square_quantile(0.975, 5), 12.8325, 5e-5);
  EXPECT_NEAR(chi_square_quantile(0.025, 5), 0.8312, 5e-5);
  EXPECT_NEAR(chi_square_quantile(0.975, 100), 129.561, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.025, 100), 74.222, 5e-4);
  // the normal distribution of the cube root (Wilson & Hilferty 1931) is off by 1e-6 there
  EXPECT_NEAR(chi_square_quantile(0.975, 1e4) / (1e4 * std::pow(1 - 2 / 9e4 + normal_quantile(0.975) * std::sqrt(2 / 9e4), 3)), 1,
              1e-5);
}

TEST(FTail, OfNoNumberIsNone) { EXPECT_TRUE(std::isnan(f_tail(std::nan(""), 3, 20))); }

}  // namespace
}  // namespace wholehand
