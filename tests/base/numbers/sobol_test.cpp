// SPDX-License-Identifier: MIT
#include "base/numbers/sobol.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace wholehand {
namespace {

std::vector<SobolPoint> points(std::uint64_t seed, std::uint64_t first, std::size_t count) {
  std::vector<SobolPoint> out(count);
  Sobol(seed).points(first, count, out.data());
  return out;
}

TEST(Sobol, FirstPointsAreThePublishedOnes) {
  // new-joe-kuo-6 in Gray code order, in multiples of 1/8; also what scipy.stats.qmc.Sobol(6, scramble=False) gives
  const int eighths[8][6] = {{0, 0, 0, 0, 0, 0}, {4, 4, 4, 4, 4, 4}, {6, 2, 2, 2, 6, 6}, {2, 6, 6, 6, 2, 2},
                             {3, 3, 5, 7, 3, 1}, {7, 7, 1, 3, 7, 5}, {5, 1, 7, 5, 5, 7}, {1, 5, 3, 1, 1, 3}};
  for (int i = 0; i < 8; ++i) {
    const auto x = Sobol::integers(i);
    for (int d = 0; d < 6; ++d) EXPECT_EQ(x[d] * 0x1p-32, eighths[i][d] / 8.0) << "point " << i << " dimension " << d;
  }
}

TEST(Sobol, EveryAlignedBlockIsStratifiedInEveryDimension) {
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{4096}, SOBOL_LARGEST_COUNT - 1024}) {
    const auto block = points(7, first, 1024);
    for (int d = 0; d < SOBOL_DIMENSIONS; ++d) {
      std::set<int> cells;
      for (const SobolPoint& p : block) cells.insert(static_cast<int>(p[d] * 1024));
      EXPECT_EQ(cells.size(), 1024u) << "dimension " << d << " from " << first;
      EXPECT_GE(*cells.begin(), 0);
      EXPECT_LT(*cells.rbegin(), 1024);
    }
  }
}

// A (t, m, 2)-net in base 2: every elementary box of 2^(t - m) holds 2^t of 2^m points. t of a pair of the first six dimensions is
// 4 at most; the first two are a (0, m, 2)-net.
TEST(Sobol, EveryPairOfDimensionsIsANet) {
  constexpr int M = 10;
  const auto block = points(3, 0, 1 << M);
  for (int a = 0; a < SOBOL_DIMENSIONS; ++a) {
    for (int b = a + 1; b < SOBOL_DIMENSIONS; ++b) {
      const int t = a == 0 && b == 1 ? 0 : 4;
      for (int k = 0; k <= M - t; ++k) {
        std::vector<int> boxes(std::size_t{1} << (M - t));
        for (const SobolPoint& p : block) {
          const int row = static_cast<int>(p[a] * (1 << k)), column = static_cast<int>(p[b] * (1 << (M - t - k)));
          ++boxes[(static_cast<std::size_t>(row) << (M - t - k)) + column];
        }
        for (const int count : boxes) ASSERT_EQ(count, 1 << t) << "dimensions " << a << ", " << b << " split " << k;
      }
    }
  }
}

TEST(Sobol, AnyRangeIsThatPartOfTheSequence) {
  const auto all = points(11, 0, 1000);
  for (const std::size_t first : {0, 1, 2, 63, 64, 511, 999}) {
    const auto part = points(11, first, 1000 - first);
    for (std::size_t i = 0; i < part.size(); ++i) ASSERT_EQ(part[i], all[first + i]);
  }
}

TEST(Sobol, SeedRepeatsAndDiffers) {
  EXPECT_EQ(points(5, 100, 50), points(5, 100, 50));
  EXPECT_NE(points(5, 100, 50), points(6, 100, 50));
  EXPECT_NE(points(0, 0, 1)[0][0], 0.5 * 0x1p-32);  // seed 0 shifts too
}

TEST(Sobol, PointsAreStrictlyInside) {
  for (const SobolPoint& p : points(9, SOBOL_LARGEST_COUNT - 2000, 2000)) {
    for (const double x : p) {
      EXPECT_GT(x, 0);
      EXPECT_LT(x, 1);
    }
  }
}

}  // namespace
}  // namespace wholehand
