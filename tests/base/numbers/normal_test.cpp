// SPDX-License-Identifier: MIT
#include "base/numbers/normal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace wholehand {
namespace {

TEST(Normal, QuantilesInvertTheErrorFunction) {
  for (double p = 1e-12; p < 1; p = p < 0.01 ? p * 1.7 : p + 0.0031) {
    const double x = normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)), p, 1e-12 * std::max(p, 1e-3)) << p;
    if (p > 1e-3) {
      EXPECT_NEAR(normal_quantile(1 - p), -x, 1e-11);
    }
  }
  EXPECT_EQ(normal_quantile(0.5), 0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_EQ(normal_quantile(0), -INFINITY);
  EXPECT_EQ(normal_quantile(1), INFINITY);
}

}  // namespace
}  // namespace wholehand
