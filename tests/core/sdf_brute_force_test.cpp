// SPDX-License-Identifier: MIT
// Kernel 2: the signed distance of solids and shells against brute force over sampled outlines.
#include "core/sdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/sampled_outline.h"

namespace wholehand {
namespace {

using core_f64::Vessel;

void expect_brute_force(const VesselData& data, int count) {
  const Vessel vessel = ready_vessel(data);
  const Sampled brute(pieces_of(data));
  int signs = 0;
  for (const Vec2& q : queries(data, brute.pieces(), count, 1)) {
    const double expected = brute.distance(q);
    const double profile = core_f64::profile_distance(vessel, q);
    // 1e-12 m: rounding of coordinates up to 1 m and of the arcs' ends; far away, of the distance itself
    const double rounding = 1e-12 * std::max(1.0, expected);
    ASSERT_NEAR(std::abs(profile), expected, rounding) << data.name << " at " << q.x << ", " << q.y;
    // 1e-9 m: the sagitta between two samples 1e-5 m apart on an arc of 3 mm is 4e-9 m; samples are under 4e-6 m apart
    if (expected > 1e-9) {
      ++signs;
      ASSERT_EQ(profile < 0, brute.inside(q)) << data.name << " at " << q.x << ", " << q.y << ", distance " << expected;
    }
    for (const double azimuth : {0.0, 0.7, 2.5, -1.9}) {
      ASSERT_NEAR(core_f64::signed_distance(vessel, around(q, azimuth)), profile, rounding);
    }
  }
  ASSERT_LT(brute.spacing(), 1e-5);
  EXPECT_GT(signs, count);
}

TEST(Sdf, OfACylinderIsBruteForce) { expect_brute_force(beaker1(), 300); }
TEST(Sdf, OfAFlaskIsBruteForce) { expect_brute_force(beaker2(), 300); }
TEST(Sdf, OfAConeIsBruteForce) { expect_brute_force(beaker3(), 300); }
TEST(Sdf, OfConvexAndConcaveArcsIsBruteForce) { expect_brute_force(vase(), 500); }
TEST(Sdf, OfLedgesAndOverhangsIsBruteForce) { expect_brute_force(ledges(), 500); }

// ---- shells: the wall between the outline and its inner offset ----

// The inner offset as points, without core/: the outline's samples moved inwards by the wall, and circles around its corners, where
// nothing of the outline is nearer than the wall.
std::vector<Vec2> inner_points(const VesselData& vessel, const Sampled& open) {
  std::vector<Vec2> points;
  const auto add = [&](Vec2 q) {
    if (q.x >= 0 && q.y <= vessel.height && open.distance(q) > vessel.wall - 1e-9) points.push_back(q);
  };
  for (const Piece& piece : open.pieces()) {
    const int n = std::max(4, static_cast<int>(piece.length() / 50e-6));
    for (int i = 0; i <= n; ++i) add(piece.at(static_cast<double>(i) / n) - vessel.wall * piece.normal(static_cast<double>(i) / n));
    for (int i = 0; i < 120; ++i) {
      const double angle = 2 * PI * i / 120;
      const Vec2 q = piece.at(1) + vessel.wall * Vec2{std::cos(angle), std::sin(angle)};
      if (open.pieces().back().by > q.y) add(q);
    }
  }
  return points;
}

TEST(Sdf, OfAShellIsTheWall) {
  for (const VesselData& solid : {beaker1(), beaker2(), beaker3(), vase()}) {
    const VesselData data = shell_of(solid);
    const Vessel vessel = ready_vessel(data);
    const PreparedVessel prepared = prepare_vessel(data, true);
    const Sampled hull(pieces_of(data), FEWER_SAMPLES), open(open_pieces(data), FEWER_SAMPLES);
    EXPECT_EQ(vessel.lid, -1);
    const double outer = data.outline[data.outline.size() - 2].end[0], inner = prepared.mouth_radius;
    Random random(5);
    int in_wall = 0, in_cavity = 0, outside = 0;
    std::vector<Vec2> points;
    for (int i = 0; i < 150; ++i) points.push_back(point_in_box(data, random));
    for (int i = 0; i < 300; ++i) {
      const Piece& piece = open.pieces()[static_cast<std::size_t>(random.uniform(0, static_cast<double>(open.pieces().size())))];
      const double t = random.uniform(0, 1);
      const Vec2 q = piece.at(t) - random.uniform(0, 2 * data.wall) * piece.normal(t);
      if (q.x > 0) points.push_back(q);
    }
    for (const Vec2& q : points) {
      const double sdf = core_f64::profile_distance(vessel, q);
      const double to_open = open.distance(q);
      // the rim: level with the mouth, from the inner wall to the outer one
      const double to_rim = std::hypot(std::max({inner - q.x, 0.0, q.x - outer}), q.y - data.height);
      const std::string where = data.name + " at " + std::to_string(q.x) + ", " + std::to_string(q.y);
      if (!hull.inside(q)) {  // none of these points is within a sample's sagitta of the hull by chance
        if (q.y > data.height && q.x < outer) {
          // over the mouth the nearest may be anywhere on the inner wall too: no further than the rim, and outside
          ASSERT_GT(sdf, 0) << where;
          ASSERT_LE(sdf, to_rim + 1e-9) << where;
        } else {
          ++outside;
          ASSERT_NEAR(sdf, std::min(to_open, to_rim), 1e-9) << where;  // 1e-9 m: the specification's for offsets
        }
      } else if (to_open > data.wall + 1e-9) {
        // in the cavity: from the nearest point of the outline, the last `to_open - wall` of the way is free
        ++in_cavity;
        ASSERT_NEAR(sdf, std::min(to_open - data.wall, to_rim), 1e-9) << where;
      } else if (to_open < data.wall - 1e-9) {
        ++in_wall;
        ASSERT_LT(sdf, 0) << where;
        // the inner wall is no nearer than wall - to_open, and just that far where it was not cut at a corner
        ASSERT_GE(-sdf, std::min({to_open, data.wall - to_open, to_rim}) - 1e-9) << where;
        ASSERT_LE(-sdf, std::min(to_open, to_rim) + 1e-9) << where;
      }
    }
    EXPECT_GT(in_wall, 100) << data.name;
    EXPECT_GT(in_cavity, 50) << data.name;
    EXPECT_GT(outside, 50) << data.name;
  }
}

TEST(Sdf, InsideTheWallOfAShellIsBruteForce) {
  for (const VesselData& solid : {beaker1(), beaker3(), vase()}) {
    const VesselData data = shell_of(solid);
    const Vessel vessel = ready_vessel(data);
    const Sampled open(open_pieces(data), FEWER_SAMPLES);
    const std::vector<Vec2> inner = inner_points(data, open);
    const double outer = data.outline[data.outline.size() - 2].end[0];
    Random random(6);
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
      const Piece& piece = open.pieces()[static_cast<std::size_t>(random.uniform(0, static_cast<double>(open.pieces().size())))];
      const double t = random.uniform(0, 1);
      const Vec2 q = piece.at(t) - random.uniform(0.05, 0.95) * data.wall * piece.normal(t);
      if (q.x <= 0 || q.y > data.height - data.wall) continue;  // the rim has its own formula above
      double to_inner = 1e300;
      for (const Vec2& p : inner) to_inner = std::min(to_inner, glm::distance(p, q));
      const double to_outer = open.distance(q);
      const double expected = std::min({to_outer, to_inner, std::hypot(std::max(q.x - outer, 0.0), data.height - q.y)});
      // 1e-4 m: samples are 50 um apart, and the cut at a corner falls between two of them
      ASSERT_NEAR(-core_f64::profile_distance(vessel, q), expected, 1e-4) << data.name << " at " << q.x << ", " << q.y;
      ++compared;
    }
    EXPECT_GT(compared, 150);
  }
}

}  // namespace
}  // namespace wholehand
