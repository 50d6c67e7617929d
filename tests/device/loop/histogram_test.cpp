// SPDX-License-Identifier: MIT
// Percentiles against those of the sorted times themselves.
// sanitizers: address
#include "device/loop/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

constexpr double HALF_A_BIN = 0.5 / 1024;  // of a time

TEST(Histogram, HasNothingToTellOfNothing) {
  const Histogram histogram;
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.quantile(0.5), 0);
  EXPECT_EQ(histogram.largest(), 0);
}

// The quantile is the middle of the bin of the time that the definition names.
TEST(Histogram, QuantilesAreThoseOfTheSortedTimesToABin) {
  Random random(2);
  for (const int count : {1, 2, 7, 1000, 30000}) {
    Histogram histogram;
    std::vector<double> times;
    for (int k = 0; k < count; ++k) {
      times.push_back(std::exp(random.uniform(std::log(2e-9), std::log(3000.0))));
      histogram.add(times.back());
    }
    std::sort(times.begin(), times.end());
    for (const double share : {0.0, 0.01, 0.3, 0.5, 0.99, 0.999, 1.0}) {
      const auto rank = static_cast<std::size_t>(std::max(1.0, std::ceil(share * count)));
      const double exact = times[rank - 1], reported = histogram.quantile(share);
      EXPECT_NEAR(reported / exact, 1, HALF_A_BIN * (1 + 1e-6)) << count << " " << share;
    }
    EXPECT_EQ(histogram.largest(), times.back());
    EXPECT_EQ(histogram.quantile(1), times.back());
    EXPECT_EQ(histogram.count(), static_cast<std::uint64_t>(count));
  }
}

TEST(Histogram, EveryPowerOfTwoHasItsBin) {
  for (int k = 0; k < 42; ++k) {
    for (const double nudge : {1 - 1e-9, 1.0, 1 + 1e-9, 1.984}) {
      const double time = std::ldexp(nudge, k) * 1e-9;
      if (time < 1e-9) continue;
      Histogram histogram;
      histogram.add(time);
      histogram.add(2 * time);  // so that the first is not the largest
      EXPECT_NEAR(histogram.quantile(0.5) / time, 1, HALF_A_BIN * (1 + 1e-6)) << k;
    }
  }
}

TEST(Histogram, WhatLiesBeyondItsEndsIsCountedThere) {
  Histogram histogram;
  for (const double time :
       {-1.0, 0.0, 1e-12, 1e4, 1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    histogram.add(time);
  EXPECT_EQ(histogram.count(), 7u);
  EXPECT_LE(histogram.quantile(0.3), 1.02e-9);
  EXPECT_GT(histogram.quantile(0.8), 4000);
}

}  // namespace
}  // namespace wholehand::device
