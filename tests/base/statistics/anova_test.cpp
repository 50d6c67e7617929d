// SPDX-License-Identifier: MIT
#include "base/statistics/anova.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

// scipy.stats.f_oneway
TEST(Anova, OfAnotherProgram) {
  const std::vector<std::vector<double>> groups{{0.3, 0.5, 0.9, 0.6}, {1.0, 0.8, 1.4, 1.3, 0.7}, {2.1, 2.5, 2.2}};
  const auto anova = one_way_anova(groups);
  ASSERT_TRUE(anova);
  EXPECT_NEAR(anova->f, 35.53804488006196, 1e-11);
  EXPECT_NEAR(anova->p / 5.3496877358757616e-05, 1, 1e-10);
  EXPECT_NEAR(anova->share, 0.8876068995506594, 1e-13);
  EXPECT_EQ(anova->between, 2);
  EXPECT_EQ(anova->within, 9);
}

// For two groups, F is the square of Student's t: means 1 and 3, both with a variance of 1 over n - 1.
TEST(Anova, OfTwoGroupsIsTheSquareOfT) {
  const auto anova = one_way_anova(std::vector<std::vector<double>>{{0, 1, 2}, {2, 3, 4}});
  ASSERT_TRUE(anova);
  const double t = 2 / std::sqrt(1.0 / 3 + 1.0 / 3);
  EXPECT_NEAR(anova->f, t * t, 1e-13);
}

TEST(Anova, IsAbsentWhereNothingCanBeCompared) {
  using Groups = std::vector<std::vector<double>>;
  EXPECT_FALSE(one_way_anova({}));
  EXPECT_FALSE(one_way_anova(Groups{{1, 2, 3}}));
  EXPECT_FALSE(one_way_anova(Groups{{1, 2, 3}, {}}));
  EXPECT_FALSE(one_way_anova(Groups{{1}, {2}}));
  EXPECT_FALSE(one_way_anova(Groups{{1, 1}, {2, 2}}));
  EXPECT_FALSE(one_way_anova(Groups{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}})) << "the mean of three 0.1 is not 0.1";
  EXPECT_EQ(one_way_anova(Groups{{1, 2}, {}, {1, 2}})->f, 0);
}

// Where all groups have one mean, p is even in [0, 1].
TEST(Anova, HasEvenPWhereNothingDiffers) {
  std::uint64_t state = 4;
  int below = 0;
  constexpr int COUNT = 2000;
  for (int k = 0; k < COUNT; ++k) {
    std::vector<std::vector<double>> groups(3);
    for (std::size_t i = 0; i < 30; ++i) groups[i % 3].push_back(unit_interval(split_mix(state)));
    below += one_way_anova(groups)->p < 0.1;
  }
  EXPECT_NEAR(below, 0.1 * COUNT, 5 * std::sqrt(0.1 * 0.9 * COUNT));
}

}  // namespace
}  // namespace wholehand
