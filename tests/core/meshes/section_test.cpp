// SPDX-License-Identifier: MIT
// The section of a mesh by an upright plane: loops and lines where the plane cuts it, all in one sense about what is inside.
#include "core/meshes/section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/mesh_faults.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

using Line = std::vector<std::array<double, 2>>;

constexpr double SECTION_ROUNDING = 1e-14;  // m, m2: of sums over a hundred points of a tenth of a meter

bool is_loop(const Line& line) { return line.size() > 3 && line.front() == line.back(); }

// The area of a loop; positive if it turns counter-clockwise.
double area_of(const Line& line) {
  double area = 0;
  for (std::size_t k = 1; k < line.size(); ++k) area += (line[k - 1][0] * line[k][1] - line[k][0] * line[k - 1][1]) / 2;
  return area;
}

double length_of(const Line& line) {
  double length = 0;
  for (std::size_t k = 1; k < line.size(); ++k) length += std::hypot(line[k][0] - line[k - 1][0], line[k][1] - line[k - 1][1]);
  return length;
}

double middle_of(const Line& line) {
  return std::accumulate(line.begin(), line.end(), 0.0, [](double sum, const auto& p) { return sum + p[0]; }) /
         static_cast<double>(line.size());
}

TEST(MeshSection, ABoxGivesItsRectangle) {
  const TriangleMesh box = box_mesh({-0.03, 0.01, -0.02}, {0.05, 0.09, 0.02});
  const auto lines = mesh_section(box, 0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(is_loop(lines[0]));
  EXPECT_NEAR(std::abs(area_of(lines[0])), 0.08 * 0.08, SECTION_ROUNDING);
  EXPECT_NEAR(length_of(lines[0]), 4 * 0.08, SECTION_ROUNDING);
  for (const auto& [x, y] : lines[0])
    EXPECT_TRUE(x >= -0.03 - SECTION_ROUNDING && x <= 0.05 + SECTION_ROUNDING && y >= 0.01 - SECTION_ROUNDING &&
                y <= 0.09 + SECTION_ROUNDING);
}

// The plane leads through edges and corners: a corner in it counts as behind it, so that the loop is whole.
TEST(MeshSection, APlaneThroughEdgesGivesAWholeLoop) {
  const TriangleMesh cube = box_mesh({-0.03, 0, -0.03}, {0.03, 0.05, 0.03});
  for (const double azimuth : {PI / 4, -PI / 4, 3 * PI / 4, 0.0, PI / 2}) {
    const double wide = 0.06 / std::max(std::abs(std::cos(azimuth)), std::abs(std::sin(azimuth)));
    const auto lines = mesh_section(cube, azimuth);
    ASSERT_EQ(lines.size(), 1u) << azimuth;
    EXPECT_TRUE(is_loop(lines[0])) << azimuth;
    EXPECT_NEAR(std::abs(area_of(lines[0])), wide * 0.05, SECTION_ROUNDING) << azimuth;
  }
}

// The plane bisects facets whose corners are turned by half a step from it, and meets the section's corners where it goes through them.
TEST(MeshSection, ATorusGivesTwoLoopsOfOneSense) {
  constexpr int ACROSS = 32, AROUND = 60;
  constexpr double LARGE = 0.04, SMALL = 0.01;
  const TriangleMesh ring = torus(LARGE, SMALL, AROUND, ACROSS);
  const double polygon = ACROSS * SMALL * SMALL * std::sin(2 * PI / ACROSS) / 2;
  for (const double azimuth : {0.0, 0.3, 1.0, 2.5}) {
    auto lines = mesh_section(ring, azimuth);
    ASSERT_EQ(lines.size(), 2u) << azimuth;
    EXPECT_TRUE(is_loop(lines[0]) && is_loop(lines[1]));
    std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return middle_of(a) < middle_of(b); });
    EXPECT_LT(middle_of(lines[0]), -LARGE + SMALL);
    EXPECT_GT(middle_of(lines[1]), LARGE - SMALL);
    EXPECT_GT(area_of(lines[0]) * area_of(lines[1]), 0) << "glass is on the same side of both";
    // between two corners of the ring the section is nearer to the axis by up to the chord's share, and as much flatter
    const double chord = 1 - std::cos(PI / AROUND);
    for (const Line& line : lines) {
      EXPECT_LT(std::abs(area_of(line)), polygon * (1 + 1e-12)) << azimuth;
      EXPECT_GT(std::abs(area_of(line)), polygon * (1 - chord) * (1 - 1e-12)) << azimuth;
    }
  }
}

TEST(MeshSection, ACavityTurnsTheOtherWay) {
  const TriangleMesh hollow = joined(icosphere(0.05, 3), inside_out(icosphere(0.03, 3)));
  const auto lines = mesh_section(hollow, 0.2);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_LT(area_of(lines[0]) * area_of(lines[1]), 0);
  EXPECT_NEAR(mesh_section(icosphere(0.05, 3), 0.2).size(), 1, 0);
  // either loop alone has the sense of its surface
  const double outer = area_of(mesh_section(icosphere(0.05, 3), 0.2)[0]);
  const double larger = std::abs(area_of(lines[0])) > std::abs(area_of(lines[1])) ? area_of(lines[0]) : area_of(lines[1]);
  EXPECT_GT(outer * larger, 0);
}

TEST(MeshSection, AnOpenSheetGivesALineWithEnds) {
  constexpr double RADIUS = 0.05;
  constexpr int LEVEL = 4;
  const TriangleMesh dome = open_hemisphere(RADIUS, LEVEL);
  for (const double azimuth : {0.0, 0.4, 2.0}) {
    const auto lines = mesh_section(dome, azimuth);
    ASSERT_EQ(lines.size(), 1u) << azimuth;
    const Line& line = lines[0];
    EXPECT_FALSE(is_loop(line));
    // edges of a 64th of a circle
    const double facet = RADIUS * (1 - std::cos(PI / 64));
    EXPECT_NEAR(line.front()[1], 0, SECTION_ROUNDING);
    EXPECT_NEAR(line.back()[1], 0, SECTION_ROUNDING);
    EXPECT_NEAR(line.front()[0] + line.back()[0], 0, 2 * facet);
    EXPECT_NEAR(std::abs(line.front()[0]), RADIUS, facet);
    // every facet within a facet's height of the sphere, and so each half of the line between two half circles
    EXPECT_LE(length_of(line), PI * RADIUS + SECTION_ROUNDING);
    for (const auto& [x, y] : line) EXPECT_NEAR(std::hypot(x, y), RADIUS, 3 * facet) << x << " " << y;
  }
}

TEST(MeshSection, WhatThePlaneMissesGivesNothing) {
  EXPECT_TRUE(mesh_section(box_mesh({0.01, 0, 0.01}, {0.02, 0.01, 0.02}), 0).empty());
  EXPECT_TRUE(mesh_section({}, 0).empty());
}

TEST(MeshSection, TheFarthestAzimuthPointsAtTheHandle) {
  for (const double azimuth : {-2.0, -0.5, 0.0, 1.0, 3.0}) {
    TriangleMesh mug = icosphere(0.04, 2);
    mug.vertices.push_back({0.07 * std::cos(azimuth), 0.2, 0.07 * std::sin(azimuth)});
    EXPECT_NEAR(farthest_azimuth(mug), azimuth, 1e-14);
  }
}

// Corners that are equally far but for rounding do not choose by it: the first does.
TEST(MeshSection, AmongEquallyFarCornersTheFirstCounts) {
  TriangleMesh box = box_mesh({-0.03, 0, -0.04}, {0.03, 0.1, 0.04});
  const double first = std::atan2(-0.04, -0.03);
  EXPECT_NEAR(farthest_azimuth(box), first, 1e-14);
  box.vertices.back() = {0.03 * (1 + 1e-9), 0.1, 0.04 * (1 + 1e-9)};
  EXPECT_NEAR(farthest_azimuth(box), first, 1e-14);
  box.vertices.back() = {0.03 * 1.001, 0.1, 0.04 * 1.001};
  EXPECT_NEAR(farthest_azimuth(box), std::atan2(0.04, 0.03), 1e-14);
}

}  // namespace
}  // namespace wholehand
