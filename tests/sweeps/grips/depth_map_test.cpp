// SPDX-License-Identifier: MIT
// The raster of a view: how near, how far it reaches, and its borders.
#include "sweeps/grips/depth_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"

namespace wholehand::sweeps {
namespace {

constexpr double SINGLE = 1e-8;  // m: single precision of some 10 cm

// Twice the area to the left of a closed line, over two.
double area_of(const std::vector<Flat>& loop) {
  double doubled = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Flat &a = loop[i], &b = loop[(i + 1) % loop.size()];
    doubled += a[0] * b[1] - a[1] * b[0];
  }
  return doubled / 2;
}

TEST(DepthMap, ASlopingTriangleToTheMiddleOfItsPixels) {
  const std::vector<Triple> points{{0, 0, 0.01}, {0.1, 0, 0.03}, {0, 0.1, 0.02}};
  const DepthMap map(points, {{0, 1, 2}}, 1e-3);
  for (const bool is_turned : {false, true}) {
    const DepthMap turned(points, {{0, 2, 1}}, 1e-3);  // seen from behind
    for (int row = 0; row < 100; ++row)
      for (int column = 0; column < 100; ++column) {
        const Flat p{(column + 0.5) * 1e-3, (row + 0.5) * 1e-3};
        const double nearest = (is_turned ? turned : map).nearest_at(p);
        if (p[0] + p[1] > 0.1 + 1e-12) {
          ASSERT_EQ(nearest, DepthMap::NOTHING);
        } else if (p[0] + p[1] < 0.1 - 1e-12) {
          ASSERT_NEAR(nearest, 0.01 + 0.2 * p[0] + 0.1 * p[1], SINGLE);
        }
      }
  }
  EXPECT_EQ(map.nearest_at({-1e-6, 0.01}), DepthMap::NOTHING);
  EXPECT_EQ(map.nearest_at({1e9, -1e9}), DepthMap::NOTHING);
}

TEST(DepthMap, TheNearestIsKept) {
  const std::vector<Triple> points{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  for (const auto& order : {std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {3, 4, 5}}, {{3, 4, 5}, {0, 1, 2}}})
    EXPECT_EQ(DepthMap(points, order, 0.01).nearest_at({0.2, 0.2}), 2);
}

TEST(DepthMap, TheLeastOfNineSeesPastABorder) {
  const std::vector<Triple> points{{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}, {-1, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}};
  const DepthMap map(points, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, 0.01);
  EXPECT_EQ(map.least_near({0.5, 0.5}), 5);
  EXPECT_EQ(map.least_near({0.005, 0.5}), 0);
  EXPECT_EQ(map.least_near({-0.005, 0.5}), 0);
  EXPECT_EQ(map.least_near({-0.995, 0.5}), DepthMap::NOTHING);
}

// Neighbors leave no gap and no pixel is lost: the area of a tessellated ball's shadow.
TEST(DepthMap, BordersRunRoundWhatIsCovered) {
  const TriangleMesh ball = icosphere(0.05, 4);
  const DepthMap map(ball.vertices, ball.triangles, 0.25e-3);
  const auto borders = map.borders();
  ASSERT_EQ(borders.size(), 1u);
  const double pi = std::acos(-1.0);
  EXPECT_NEAR(area_of(borders[0]) / (pi * 0.05 * 0.05), 1, 5e-3);  // chords of 5 degrees: 1.3e-3; pixels 1 / 200 of the radius
  for (const Flat& p : borders[0]) ASSERT_NEAR(std::hypot(p[0], p[1]), 0.05, 0.4e-3);
}

TEST(DepthMap, HolesAreBordersThatRunTheOtherWay) {
  TriangleMesh ring = torus(0.04, 0.01, 128, 32);
  for (Triple& p : ring.vertices) p = {p[0], p[2], p[1]};
  const DepthMap map(ring.vertices, ring.triangles, 0.25e-3);
  const auto borders = map.borders();
  ASSERT_EQ(borders.size(), 2u);
  const double pi = std::acos(-1.0), outer = area_of(borders[0]), inner = area_of(borders[1]);
  EXPECT_NEAR(outer / (pi * 0.05 * 0.05), 1, 5e-3);
  EXPECT_NEAR(inner / (pi * 0.03 * 0.03), -1, 8e-3);
}

// Two squares that meet in a corner are two borders, neither of which crosses the other.
TEST(DepthMap, PixelsThatMeetInACornerAreApart) {
  const std::vector<Triple> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}};
  for (const bool is_mirrored : {false, true}) {
    std::vector<Triple> placed = points;
    if (is_mirrored) {
      for (Triple& p : placed) p[0] = -p[0];
    }
    const auto borders = DepthMap(placed, {{0, 1, 2}, {0, 2, 3}, {2, 4, 5}, {2, 5, 6}}, 0.125).borders();
    ASSERT_EQ(borders.size(), 2u);
    for (const auto& border : borders) {
      EXPECT_EQ(border.size(), 4u);
      EXPECT_DOUBLE_EQ(area_of(border), 1);
    }
  }
}

TEST(DepthMap, ARasterIsNeverTooLarge) {
  const std::vector<Triple> points{{0, 0, 1}, {1e3, 0, 1}, {0, 1, 1}};
  const DepthMap map(points, {{0, 1, 2}}, 1e-6);
  EXPECT_NEAR(map.pixel(), 1e3 / 4096, 1e-9);
  EXPECT_EQ(map.nearest_at({1, 0.1}), 1);
  EXPECT_EQ(DepthMap({}, {}, 1e-3).nearest_at({0, 0}), DepthMap::NOTHING);
  EXPECT_TRUE(DepthMap({}, {}, 1e-3).borders().empty());
}

}  // namespace
}  // namespace wholehand::sweeps
