// SPDX-License-Identifier: MIT
// Line drawings of meshes: contours where they are by closed forms, what is hidden left out, and never too many points.
#include "sweeps/grips/mesh_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/meshes.h"
#include "tests/support/sanitized.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

constexpr double PIXEL = 0.2e-3;

struct Seen {
  explicit Seen(const TriangleMesh& mesh) : body(body_of(mesh)), edges(find_edges(body)) {}
  // From the front: x to the right, y up; or from above: x to the right, -z up.
  MeshLines front(double pixel = PIXEL) const { return MeshView(body, edges, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, pixel).lines(); }
  MeshLines above(double pixel = PIXEL) const { return MeshView(body, edges, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}, pixel).lines(); }

  MeshBody body;
  MeshEdges edges;
};

double length_of(const std::vector<std::vector<Flat>>& lines) {
  double length = 0;
  for (const auto& line : lines) {
    for (std::size_t i = 1; i < line.size(); ++i) length += std::hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]);
  }
  return length;
}

std::size_t points_of(const std::vector<std::vector<Flat>>& lines) {
  std::size_t count = 0;
  for (const auto& line : lines) count += line.size();
  return count;
}

double distance_to(const Flat& p, const Flat& a, const Flat& b) {
  const Flat along{b[0] - a[0], b[1] - a[1]}, to{p[0] - a[0], p[1] - a[1]};
  const double squared = along[0] * along[0] + along[1] * along[1];
  const double t = squared > 0 ? std::clamp((to[0] * along[0] + to[1] * along[1]) / squared, 0.0, 1.0) : 0;
  return std::hypot(to[0] - t * along[0], to[1] - t * along[1]);
}

TEST(MeshLines, ASphereIsACircle) {
  const MeshLines lines = Seen(icosphere(0.05, 4)).front();
  EXPECT_TRUE(lines.creases.empty());
  for (const auto& line : lines.contours)
    for (const Flat& p : line)
      ASSERT_NEAR(std::hypot(p[0], p[1]), 0.05, 2e-4);  // triangles of 5 degrees: 0.05 (1 - cos 5) = 1.9e-4
  EXPECT_NEAR(length_of(lines.contours) / (2 * PI * 0.05), 1, 0.02);
  ASSERT_EQ(lines.covered.size(), 1u);
}

TEST(MeshLines, ATorusFromAboveIsTwoCircles) {
  const MeshLines lines = Seen(torus(0.05, 0.02, 180, 60)).above();
  EXPECT_TRUE(lines.creases.empty());
  ASSERT_EQ(lines.contours.size(), 2u);
  for (const auto& line : lines.contours) {
    const double radius = std::hypot(line[0][0], line[0][1]);
    EXPECT_NEAR(radius, radius > 0.05 ? 0.07 : 0.03, 1e-6);
    EXPECT_NEAR(length_of({line}) / (2 * PI * radius), 1, 1e-3);
    EXPECT_NEAR(std::hypot(line.front()[0] - line.back()[0], line.front()[1] - line.back()[1]), 0, 1e-15);
  }
  EXPECT_EQ(lines.covered.size(), 2u);
}

// From the side the inner half of the tube is hidden and a stadium is seen, its straight lines twice: near and far.
TEST(MeshLines, ATorusFromTheSideHidesItsHole) {
  const MeshLines lines = Seen(torus(0.05, 0.02, 180, 60)).front();
  EXPECT_NEAR(length_of(lines.contours) / (4 * 0.1 + 2 * PI * 0.02), 1, 0.03);
  for (const auto& line : lines.contours) {
    for (const Flat& p : line) {
      const double beyond = std::max(std::abs(p[0]) - 0.05, 0.0);
      ASSERT_NEAR(std::hypot(beyond, p[1]), 0.02, 2 * PIXEL);
    }
  }
  EXPECT_EQ(lines.covered.size(), 1u);
}

TEST(MeshLines, ABoxFromACornerHidesThreeEdges) {
  const Seen box(placed_mesh(box_mesh({-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}), {0.6, 0, 0}, {}));
  const MeshView view(box.body, box.edges, {std::cos(0.5), 0, -std::sin(0.5)}, {0, 1, 0}, {std::sin(0.5), 0, std::cos(0.5)}, PIXEL);
  const MeshLines lines = view.lines();
  ASSERT_EQ(lines.creases.size(), 3u);
  ASSERT_EQ(lines.contours.size(), 1u);
  EXPECT_EQ(lines.contours[0].size(), 7u);  // six corners and the first again
  // the near corner, where the three meet
  for (const auto& crease : lines.creases) EXPECT_EQ(crease.size(), 2u);
}

// Triangles seen from their side are neither front nor back, and draw nothing across the base.
TEST(MeshLines, ABeakerIsARectangleFromTheSideAndACircleFromAbove) {
  const Seen beaker(turned_mesh(beaker1(), 60, 5e-3));
  const MeshLines front = beaker.front();
  for (const auto& line : front.contours) {
    for (const Flat& p : line) {
      const double aside = std::abs(std::abs(p[0]) - 0.04), ends = std::min(std::abs(p[1]), std::abs(p[1] - 0.11));
      ASSERT_LT(std::min(aside, ends), 1e-9);
    }
  }
  EXPECT_NEAR(length_of(front.contours), 2 * 0.11 + 2 * 0.08, 1e-6);
  EXPECT_TRUE(front.creases.empty());
  const MeshLines above = beaker.above();
  EXPECT_NEAR(length_of(above.contours) / (60 * 2 * 0.04 * std::sin(PI / 60)), 1, 1e-3);
  EXPECT_TRUE(above.creases.empty());
}

TEST(MeshLines, ALineStopsWhereItGoesBehind) {
  // a box, and a long bar behind it
  const Seen both(joined(box_mesh({-0.02, -0.02, 0.02}, {0.02, 0.02, 0.04}), box_mesh({-0.06, -0.005, -0.01}, {0.06, 0.005, 0})));
  const MeshLines lines = both.front();
  for (const auto& line : lines.contours) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Flat middle{(line[i - 1][0] + line[i][0]) / 2, (line[i - 1][1] + line[i][1]) / 2};
      EXPECT_FALSE(std::abs(middle[0]) < 0.02 - 2 * PIXEL && std::abs(middle[1]) < 0.02 - 2 * PIXEL);
    }
  }
  EXPECT_NEAR(length_of(lines.contours), 4 * 0.04 + 4 * 0.04 + 2 * 0.01, 8 * PIXEL);
}

TEST(MeshLines, AnOpenRimIsDrawn) {
  const Seen bowl(placed_mesh(open_hemisphere(0.05, 4), {PI, 0, 0}, {}));  // open above
  EXPECT_NEAR(length_of(bowl.above().contours) / (2 * PI * 0.05), 1, 5e-3);
  EXPECT_NEAR(length_of(bowl.front().contours) / (PI * 0.05 + 2 * 0.1), 1, 0.02);  // the rim twice, near and far
}

// A box without a lid shows its inner corners, from the back of its walls; a closed one shows no edge between two faces that are turned
// away, not even on the contour.
TEST(MeshLines, AnOpenBoxShowsItsInside) {
  TriangleMesh box = box_mesh({-0.02, 0, -0.02}, {0.02, 0.03, 0.02});
  std::erase_if(box.triangles, [&](const auto& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t corner) { return box.vertices[corner][1] > 0.02; });
  });
  MeshBody open;
  open.vertices = box.vertices;
  open.triangles = box.triangles;
  const MeshEdges edges = find_edges(open);
  const Triple up{0, std::sqrt(0.5), -std::sqrt(0.5)}, toward{0, std::sqrt(0.5), std::sqrt(0.5)};
  const MeshLines lines = MeshView(open, edges, {1, 0, 0}, up, toward, PIXEL).lines();
  // inside, both upright corners at the back and the floor's edge between them; the near wall hides their lower 0.01 m
  double inner = 0;
  for (const auto& line : lines.creases) {
    for (std::size_t i = 1; i < line.size(); ++i) inner += std::hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]);
  }
  EXPECT_GT(inner, 2 * 0.02 * std::sqrt(0.5));
}

TEST(MeshLines, WhatIsBeforeAndBehind) {
  const Seen ball(icosphere(0.05, 4));
  const MeshView view(ball.body, ball.edges, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, PIXEL);
  EXPECT_NEAR(view.cover_at({0, 0, -0.06}), 0.11, 1e-4);
  EXPECT_NEAR(view.cover_at({0, 0, 0.06}), -0.01, 1e-4);
  EXPECT_NEAR(view.cover_at({0.03, 0, 0}), 0.04, 2e-4);
  EXPECT_EQ(view.cover_at({0.06, 0, 0}), DepthMap::NOTHING);
}

// Every edge of a crumpled ball is sharp; a raster of small holes has many borders.
TEST(MeshLines, PointsAreFew) {
  TriangleMesh crumpled = icosphere(0.05, IS_SANITIZED ? 5 : 6);
  Random random(12);
  for (Triple& p : crumpled.vertices) {
    const double factor = random.uniform(0.9, 1.1);
    for (double& x : p) x *= factor;
  }
  const Seen ball(crumpled);
  ASSERT_GT(std::count_if(ball.edges.edges.begin(), ball.edges.edges.end(), [](const MeshEdge& e) { return e.is_crease; }), 10'000);
  const MeshLines lines = ball.front(0.05e-3);
  EXPECT_GT(points_of(lines.contours) + points_of(lines.creases), MOST_LINE_POINTS / 2);
  EXPECT_LE(points_of(lines.contours) + points_of(lines.creases), MOST_LINE_POINTS);
  EXPECT_FALSE(lines.covered.empty());
  TriangleMesh sieve;
  for (int i = 0; i < (IS_SANITIZED ? 5000 : 20'000); ++i) {
    const double x = random.uniform(-0.05, 0.05), y = random.uniform(-0.05, 0.05);
    sieve.vertices.insert(sieve.vertices.end(), {{x, y, 0}, {x + 1e-3, y, 0}, {x, y + 1e-3, 0}});
    const auto at = static_cast<std::uint32_t>(3 * i);
    sieve.triangles.push_back({at, at + 1, at + 2});
  }
  MeshBody flat;
  flat.vertices = sieve.vertices;
  flat.triangles = sieve.triangles;
  const MeshEdges edges = find_edges(flat);
  const MeshLines holes = MeshView(flat, edges, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0.05e-3).lines();
  EXPECT_LE(points_of(holes.contours) + points_of(holes.creases), MOST_LINE_POINTS);
  EXPECT_LE(points_of(holes.covered), MOST_LINE_POINTS);
}

TEST(MeshLines, SimplifiedLinesStayWithinTheTolerance) {
  std::vector<Flat> line;
  Random random(13);
  for (int i = 0; i <= 2000; ++i) line.push_back({1e-4 * i, 0.02 * std::sin(0.01 * i) + random.uniform(-1e-5, 1e-5)});
  const std::vector<Flat> kept = simplified(line, 1e-4);
  EXPECT_LT(kept.size(), 100u);
  EXPECT_EQ(kept.front(), line.front());
  EXPECT_EQ(kept.back(), line.back());
  for (const Flat& p : line) {
    double nearest = 1;
    for (std::size_t i = 1; i < kept.size(); ++i) nearest = std::min(nearest, distance_to(p, kept[i - 1], kept[i]));
    ASSERT_LE(nearest, 1e-4);
  }
  std::vector<Flat> circle;
  for (int i = 0; i < 3600; ++i) circle.push_back({std::cos(PI * i / 1800), std::sin(PI * i / 1800)});
  const std::vector<Flat> loop = simplified_loop(circle, 1e-3);
  EXPECT_LT(loop.size(), 150u);  // 2 pi / (2 sqrt(2e-3)) = 70 would do
  EXPECT_NE(loop.front(), loop.back());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Flat &a = loop[i], &b = loop[(i + 1) % loop.size()];
    EXPECT_GE(std::hypot((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), 1 - 1.1e-3);
  }
  EXPECT_EQ(simplified({{0, 0}, {1, 0}}, 1).size(), 2u);
  EXPECT_EQ(simplified({}, 1).size(), 0u);
}

}  // namespace
}  // namespace wholehand::sweeps
