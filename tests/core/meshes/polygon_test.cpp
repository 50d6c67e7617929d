// SPDX-License-Identifier: MIT
// Polygons cut into triangles: as many as there must be, none turned, and together their area.
#include "core/meshes/polygon.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace wholehand {
namespace {

using PlanePoints = std::vector<std::array<double, 2>>;

// Numbers the corners of several loops on.
struct DrawnPolygon {
  std::vector<PolygonLoop> loops;
  std::vector<PolygonCorner> corners;

  void add(const PlanePoints& points) {
    loops.emplace_back();
    for (const auto& [x, y] : points) {
      corners.push_back({x, y, static_cast<std::uint32_t>(corners.size())});
      loops.back().push_back(corners.back());
    }
  }
};

double loop_area(const PolygonLoop& loop) {
  double area = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const PolygonCorner &p = loop[i], &q = loop[(i + 1) % loop.size()];
    area += (p.x * q.y - p.y * q.x) / 2;
  }
  return area;
}

// Cuts the polygon and holds it to its promises.
void expect_cut(const DrawnPolygon& drawn, const std::string& what) {
  const std::vector<Corners> triangles = cut_polygon(drawn.loops[0], {drawn.loops.begin() + 1, drawn.loops.end()});
  EXPECT_EQ(triangles.size(), drawn.corners.size() + 2 * (drawn.loops.size() - 1) - 2) << what;
  double area = 0, least = 1;
  std::map<std::array<std::uint32_t, 2>, int> uses;
  for (const Corners& triangle : triangles) {
    PolygonLoop loop;
    for (int k = 0; k < 3; ++k) {
      loop.push_back(drawn.corners[triangle[k]]);
      ++uses[{triangle[k], triangle[(k + 1) % 3]}];
    }
    area += loop_area(loop);
    least = std::min(least, loop_area(loop));
  }
  double whole = 0;
  for (const PolygonLoop& loop : drawn.loops) {
    whole += loop_area(loop);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t from = loop[i].vertex, to = loop[(i + 1) % loop.size()].vertex;
      EXPECT_EQ((uses[{from, to}]), 1) << what;
      EXPECT_EQ((uses[{to, from}]), 0) << what;
    }
  }
  EXPECT_GT(least, 0) << what;
  EXPECT_NEAR(area, whole, 1e-12 * whole) << what << ": triangles that overlap have more";
}

void expect_loop_cut(const PlanePoints& outer, const std::string& what) {
  DrawnPolygon drawn;
  drawn.add(outer);
  expect_cut(drawn, what);
}

// About the origin, with radii by chance; clockwise if `is_inner`.
PlanePoints random_star(std::mt19937& random, int corners, double least, double most, std::array<double, 2> middle, bool is_inner) {
  std::uniform_real_distribution<double> radius(least, most);
  PlanePoints points;
  for (int i = 0; i < corners; ++i) {
    const double angle = (is_inner ? -2 : 2) * std::numbers::pi * i / corners, r = radius(random);
    points.push_back({middle[0] + r * std::cos(angle), middle[1] + r * std::sin(angle)});
  }
  return points;
}

TEST(MeshPolygon, SimpleOnes) {
  expect_loop_cut({{0, 0}, {1, 0}, {0, 1}}, "triangle");
  expect_loop_cut({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, "square");
  expect_loop_cut({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, "L");
  expect_loop_cut({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, "U");
}

// A corner in the middle of a side must not become a triangle without area.
TEST(MeshPolygon, CornersOnStraightSides) {
  expect_loop_cut({{0, 0}, {1, 0}, {2, 0}, {0, 2}}, "triangle");
  PlanePoints square;
  constexpr std::array<std::array<double, 2>, 4> DIRECTIONS{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  std::array<double, 2> at{0, 0};
  for (const auto& [x, y] : DIRECTIONS)
    for (int i = 0; i < 8; ++i) {
      square.push_back(at);
      at = {at[0] + x, at[1] + y};
    }
  expect_loop_cut(square, "square");
}

TEST(MeshPolygon, CombsSpiralsAndStars) {
  PlanePoints comb{{0, 0}, {20, 0}};
  for (int i = 20; i >= 0; --i) comb.push_back({static_cast<double>(i), i % 2 == 0 ? 5.0 : 1.0});
  expect_loop_cut(comb, "comb");
  PlanePoints spiral;
  for (int i = 0; i <= 200; ++i) spiral.push_back({(1 + 0.05 * i) * std::cos(0.1 * i), (1 + 0.05 * i) * std::sin(0.1 * i)});
  for (int i = 200; i >= 0; --i) spiral.push_back({(0.5 + 0.05 * i) * std::cos(0.1 * i), (0.5 + 0.05 * i) * std::sin(0.1 * i)});
  expect_loop_cut(spiral, "spiral");
  std::mt19937 random(1);
  for (int corners = 3; corners < 120; corners += 3) expect_loop_cut(random_star(random, corners, 0.1, 1, {0, 0}, false), "star");
}

TEST(MeshPolygon, LoopsWithinLoops) {
  DrawnPolygon frame;
  frame.add({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  frame.add({{1, 1}, {1, 3}, {3, 3}, {3, 1}});
  expect_cut(frame, "frame");
  std::mt19937 random(2);
  for (int tries = 0; tries < 40; ++tries) {
    DrawnPolygon sieve;
    sieve.add(random_star(random, 40 + tries, 8, 12, {0, 0}, false));
    // rows and columns of holes: several have the same height, and rays to the right meet their corners
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        if (tries % 2 == 0) {
          sieve.add(random_star(random, 5 + tries % 7, 0.3, 0.9, {2.0 * x, 2.0 * y}, true));
        } else {
          sieve.add(
              {{2 * x - 0.5, 2 * y - 0.5}, {2 * x - 0.5, 2 * y + 0.5}, {2 * x + 0.5, 2 * y + 0.5}, {2 * x + 0.5, 2 * y - 0.5}});
        }
    expect_cut(sieve, "sieve " + std::to_string(tries));
  }
}

// Some thousand corners take no time to speak of, though none of the fans about a middle fits.
TEST(MeshPolygon, ManyCornersAreQuicklyCut) {
  DrawnPolygon ring;
  std::mt19937 random(3);
  ring.add(random_star(random, 3000, 0.99, 1, {0, 0}, false));
  ring.add(random_star(random, 2000, 0.97, 0.98, {0, 0}, true));
  expect_cut(ring, "ring");
}

// Loops that cross have no triangulation: still each of their edges gets its triangle.
TEST(MeshPolygon, CrossedLoopsAreCutSomehow) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int tries = 0; tries < 50; ++tries) {
    DrawnPolygon tangle;
    PlanePoints points;
    for (int i = 0; i < 30; ++i) points.push_back({number(random), number(random)});
    tangle.add(points);
    EXPECT_EQ(cut_polygon(tangle.loops[0]).size(), 28u);
  }
}

TEST(MeshPolygon, AnythingWithinIsWithin) {
  DrawnPolygon ell;
  ell.add({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});
  EXPECT_TRUE(is_within(ell.loops[0], {0.5, 1.5, 0}));
  EXPECT_TRUE(is_within(ell.loops[0], {1.5, 0.5, 0}));
  EXPECT_TRUE(is_within(ell.loops[0], {0.5, 1, 0})) << "a ray that meets a corner";
  EXPECT_FALSE(is_within(ell.loops[0], {1.5, 1.5, 0}));
  EXPECT_FALSE(is_within(ell.loops[0], {-0.5, 1, 0}));
}

}  // namespace
}  // namespace wholehand
