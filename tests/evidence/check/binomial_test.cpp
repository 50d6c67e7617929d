// SPDX-License-Identifier: MIT
// The tail of the binomial distribution, and how many accidents a share of them explains.
// sanitizers: address
#include "evidence/check/binomial.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wholehand {
namespace {

TEST(Binomial, TailOfFewTrialsIsCountedOut) {
  EXPECT_DOUBLE_EQ(binomial_tail(4, 2, 0.5), 11.0 / 16);
  EXPECT_DOUBLE_EQ(binomial_tail(4, 4, 0.5), 1.0 / 16);
  EXPECT_DOUBLE_EQ(binomial_tail(3, 1, 0.1), 0.271);
  EXPECT_DOUBLE_EQ(binomial_tail(1, 1, 1e-3), 1e-3);
  EXPECT_EQ(binomial_tail(5, 0, 0.3), 1);
  EXPECT_EQ(binomial_tail(5, 6, 0.3), 0);
  EXPECT_EQ(binomial_tail(0, 1, 0.3), 0);
  EXPECT_EQ(binomial_tail(5, 5, 0), 0);
  EXPECT_EQ(binomial_tail(5, 5, 1), 1);
}

// Sums of exact fractions.
TEST(Binomial, TailIsTheExactSum) {
  struct Known {
    std::uint64_t trials, count;
    double share, tail;
  };
  const Known all[] = {
      {72, 1, 1.0 / 1000, 0.069502625046766311},       {72, 4, 1.0 / 1000, 9.7435716507984544e-07},
      {400, 2, 1.0 / 1000, 0.06147138888545569},       {1000, 1, 1.0 / 1000, 0.63230457522903594},
      {1536, 11, 1.0 / 1000, 6.7505071807978294e-07},  {1536, 1, 1.0 / 1000, 0.78492500815340327},
      {10000, 30, 1.0 / 1000, 2.4615644296483081e-07}, {27648, 60, 1.0 / 1000, 6.6349140720973149e-08},
      {20, 15, 1.0 / 3, 0.00016736595466947541},       {100, 40, 1.0 / 2, 0.98239989989114762},
  };
  for (const Known& known : all) {
    EXPECT_NEAR(binomial_tail(known.trials, known.count, known.share), known.tail, 1e-10 * known.tail)
        << known.count << " of " << known.trials;
  }
}

TEST(Binomial, TailFallsFromOneToTheLastTerm) {
  double before = 1;
  for (std::uint64_t k = 0; k <= 50; ++k) {
    const double tail = binomial_tail(50, k, 0.3);
    EXPECT_LE(tail, before) << k;
    before = tail;
  }
  EXPECT_NEAR(before, std::pow(0.3, 50), 1e-12 * std::pow(0.3, 50));
}

// The counts that `wholehand check` lets pass: 1 in 1,000 in the long run, judged at one in a million.
TEST(Binomial, PlausibleCountsOfOneInAThousand) {
  EXPECT_EQ(largest_plausible_count(0, 1e-3, 1e-6), 1u);
  EXPECT_EQ(largest_plausible_count(1, 1e-3, 1e-6), 1u);
  EXPECT_EQ(largest_plausible_count(72, 1e-3, 1e-6), 3u);
  EXPECT_EQ(largest_plausible_count(400, 1e-3, 1e-6), 6u);
  EXPECT_EQ(largest_plausible_count(1008, 1e-3, 1e-6), 9u);
  EXPECT_EQ(largest_plausible_count(1536, 1e-3, 1e-6), 10u);
  EXPECT_EQ(largest_plausible_count(4608, 1e-3, 1e-6), 18u);
  EXPECT_EQ(largest_plausible_count(27648, 1e-3, 1e-6), 56u);
}

}  // namespace
}  // namespace wholehand
