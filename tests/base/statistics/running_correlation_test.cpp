// SPDX-License-Identifier: MIT
// Correlations of pairs that come one by one: those of all pairs together.
#include "base/statistics/running_correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/people/draws.h"

namespace wholehand {
namespace {

constexpr double RUNNING_ROUNDING = 1e-10;  // of sums of some thousand numbers

RunningCorrelation running(const std::vector<double>& x, const std::vector<double>& y) {
  RunningCorrelation correlation;
  for (std::size_t i = 0; i < x.size(); ++i) correlation.add(x[i], y[i]);
  return correlation;
}

TEST(RunningCorrelation, IsThatOfAllPairs) {
  for (const double offset : {0.0, 1e4}) {
    std::vector<double> x, y, yes;
    std::vector<char> is_yes;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      x.push_back(offset + drawn({1, i}, 0));
      y.push_back(x.back() - 2 * drawn({1, i}, 1));
      is_yes.push_back(drawn({1, i}, 2) < x.back() - offset ? 1 : 0);
      yes.push_back(is_yes.back());
    }
    // an offset of 1e4 leaves twelve of sixteen digits of each difference
    EXPECT_NEAR(*running(x, y).pearson().r, *pearson(x, y).r, RUNNING_ROUNDING);
    EXPECT_NEAR(*running(x, yes).point_biserial().r, *point_biserial(x, is_yes).r, RUNNING_ROUNDING);
    EXPECT_EQ(running(x, y).pairs(), x.size());
  }
}

TEST(RunningCorrelation, SaysWhatIsLacking) {
  const std::vector<double> x{1, 2, 4}, same{3, 3, 3};
  EXPECT_EQ(running({1, 2}, {1, 2}).pearson().lack, Lack::fewer_than_3);
  EXPECT_EQ(running({1, 2}, {0, 0}).point_biserial().lack, Lack::fewer_than_3);
  EXPECT_EQ(running(same, x).pearson().lack, Lack::one_x);
  EXPECT_EQ(running(x, same).pearson().lack, Lack::one_y);
  EXPECT_EQ(running(x, {0, 0, 0}).point_biserial().lack, Lack::never);
  EXPECT_EQ(running(x, {1, 1, 1}).point_biserial().lack, Lack::always);
  EXPECT_EQ(running(same, {0, 1, 1}).point_biserial().lack, Lack::one_x);
  EXPECT_TRUE(std::isnan(RunningCorrelation().mean_y()));
  EXPECT_DOUBLE_EQ(running(x, x).mean_y(), 7.0 / 3);
}

// The mean of three 0.1 is not 0.1.
TEST(RunningCorrelation, RoundingIsNoScatter) { EXPECT_EQ(running({0.1, 0.1, 0.1}, {1, 2, 3}).pearson().lack, Lack::one_x); }

// A merge with weights equals repeated pairs: here three times those of one accumulator, once those of the other.
TEST(RunningCorrelation, WeighsThePairsOfAnother) {
  std::vector<double> x, y, yes, all_x, all_y, all_yes;
  RunningCorrelation one, two, one_yes, two_yes;
  for (std::uint64_t i = 0; i < 300; ++i) {
    x.push_back(5 + drawn({2, i}, 0));
    y.push_back((i < 100 ? 1 : 4) * x.back() + drawn({2, i}, 1));
    yes.push_back(drawn({2, i}, 2) < 0.3 ? 1 : 0);
    (i < 100 ? one : two).add(x.back(), y.back());
    (i < 100 ? one_yes : two_yes).add(x.back(), yes.back());
    for (int copy = 0; copy < (i < 100 ? 3 : 1); ++copy) {
      all_x.push_back(x.back());
      all_y.push_back(y.back());
      all_yes.push_back(yes.back());
    }
  }
  RunningCorrelation sum, sum_yes;
  sum.add(one, 3);
  sum.add(two, 1);
  sum.add(RunningCorrelation(), 2);
  sum_yes.add(two_yes, 0.5);  // a common factor changes nothing
  sum_yes.add(one_yes, 1.5);
  EXPECT_NEAR(*sum.pearson().r, *running(all_x, all_y).pearson().r, RUNNING_ROUNDING);
  EXPECT_GT(std::abs(*sum.pearson().r - *running(x, y).pearson().r), 0.01) << "weights must show";
  EXPECT_NEAR(*sum_yes.point_biserial().r, *running(all_x, all_yes).point_biserial().r, RUNNING_ROUNDING);
  EXPECT_NEAR(sum.mean_y(), running(all_x, all_y).mean_y(), RUNNING_ROUNDING);
  EXPECT_EQ(sum.pairs(), 300u);
}

TEST(RunningCorrelation, OfOthersSaysWhatIsLacking) {
  const auto sum_of = [](const RunningCorrelation& one, const RunningCorrelation& two) {
    RunningCorrelation sum;
    sum.add(one, 1);
    sum.add(two, 2);
    return sum;
  };
  EXPECT_EQ(sum_of(running({1}, {1}), running({2}, {0})).pearson().lack, Lack::fewer_than_3);
  EXPECT_EQ(sum_of(running({3, 3}, {1, 0}), running({3}, {1})).pearson().lack, Lack::one_x);
  EXPECT_EQ(sum_of(running({3, 4}, {1, 1}), running({5}, {1})).point_biserial().lack, Lack::always);
  EXPECT_EQ(sum_of(running({-3, -4}, {0, 0}), running({-5}, {0})).point_biserial().lack, Lack::never);
}

TEST(RunningCorrelation, WhatHasAnErrorMustVaryByMore) {
  for (const double apart : {1e-10, 0.9e-7, 1.1e-7}) {
    RunningCorrelation correlation(1e-7);
    for (const double share : {0.0, 0.3, 1.0}) correlation.add(share * apart, share);
    EXPECT_EQ(correlation.pearson().r.has_value(), apart > 1e-7) << apart;
  }
}

}  // namespace
}  // namespace wholehand
