// SPDX-License-Identifier: MIT
// Correlations of pairs that come one by one: those of all pairs together.
#include "statistics/running_correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "people/draws.h"

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

}  // namespace
}  // namespace wholehand
