// SPDX-License-Identifier: MIT
// Points that a gauge is largest at, against gauges.
#include "core/extreme_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using Numbers = std::vector<std::size_t>;

TEST(ExtremePoints, AreTheCornersOfASquare) {
  std::vector<Point5> points;
  for (int i = -2; i <= 2; ++i)
    for (int k = -2; k <= 2; ++k) points.push_back({0.5 * i, 0.5 * k});
  EXPECT_EQ(extreme_points(points), (Numbers{0, 4, 20, 24}));
}

TEST(ExtremePoints, OfARayAreItsFurthest) {
  EXPECT_EQ(extreme_points({{1, 1}, {2, 2}, {0, 0}, {3, 3}, {2.5, 2.5}}), (Numbers{3}));
  EXPECT_EQ(extreme_points({{3, 3}, {-1, -1}, {3, 3}}).size(), 2u);
  EXPECT_TRUE(extreme_points({}).empty());
  EXPECT_TRUE(extreme_points({{}, {}}).empty());
}

// A circle's points are all extreme, however near they are; those within it are not.
TEST(ExtremePoints, OfACircleAreAllOfIt) {
  std::vector<Point5> points;
  for (int i = 0; i < 180; ++i) points.push_back({std::cos(radians(2.0 * i)), 0, 0, std::sin(radians(2.0 * i))});
  EXPECT_EQ(extreme_points(points).size(), 180u);
  // the middle of a side of the polygon lies 1.5e-4 within the circle
  for (int i = 0; i < 180; ++i)
    points.push_back({0.9998 * std::cos(radians(2.0 * i + 1)), 0, 0, 0.9998 * std::sin(radians(2.0 * i + 1))});
  EXPECT_EQ(extreme_points(points).size(), 180u);
}

// The gauge of a polytope around the origin is the largest of some products; one of more dimensions than the points have is among them.
TEST(ExtremePoints, LoseNoLargestValueOfAGauge) {
  constexpr double ROUNDED = 1e-7;  // 1e-9 of the largest point, by directions of up to 100 times its size
  std::size_t kept = 0, all = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const int dimensions = 1 + static_cast<int>(random.uniform(0, 5));
    std::vector<Point5> points(static_cast<std::size_t>(random.uniform(1, 60)));
    for (Point5& point : points)
      for (int k = 0; k < dimensions; ++k) point[static_cast<std::size_t>(k)] = random.uniform(-1, 1) + 0.5;
    const Numbers extreme = extreme_points(points);
    for (int gauge = 0; gauge < 50; ++gauge) {
      std::vector<Point5> directions(static_cast<std::size_t>(random.uniform(1, 10)));
      for (Point5& direction : directions)
        for (double& value : direction) value = random.uniform(-1, 1);
      const auto value = [&](const Point5& point) {
        double most = 0;
        for (const Point5& direction : directions) {
          double sum = 0;
          for (std::size_t k = 0; k < 5; ++k) sum += direction[k] * point[k];
          most = std::max(most, sum);
        }
        return most;
      };
      double of_all = 0, of_extreme = 0;
      for (const Point5& point : points) of_all = std::max(of_all, value(point));
      for (const std::size_t i : extreme) of_extreme = std::max(of_extreme, value(points[i]));
      EXPECT_NEAR(of_extreme, of_all, ROUNDED) << "seed " << seed;
    }
    kept += extreme.size();
    all += points.size();
  }
  EXPECT_LT(kept, all * 3 / 4);  // else nothing was left out
}

TEST(ExtremePoints, AreAllWhereTheyAreTooMany) {
  std::vector<Point5> points(MOST_EXTREME + 1);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {static_cast<double>(i + 1)};
  EXPECT_EQ(extreme_points(points).size(), points.size());
  points.pop_back();
  EXPECT_EQ(extreme_points(points), (Numbers{MOST_EXTREME - 1}));
}

}  // namespace
}  // namespace wholehand
