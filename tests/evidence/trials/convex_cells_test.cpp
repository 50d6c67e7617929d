// SPDX-License-Identifier: MIT
// Convex pieces hold all of a body, and leave it nowhere by more than the stated error.
// sanitizers: none
#include "evidence/trials/convex_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/vectors.h"
#include "evidence/trials/vessel_body.h"
#include "tests/support/refusal.h"
#include "tests/support/walled_vessels.h"

namespace wholehand {
namespace {

struct Covered {
  explicit Covered(const TriangleMesh& triangles, std::size_t most_pieces = MOST_PIECES)
      : mesh(check_mesh(triangles, "body")), body(mesh), cover(cover_by_pieces(mesh, body, most_pieces)) {}
  CheckedMesh mesh;
  MeshDistance body;
  ConvexCover cover;
};

bool is_covered(const ConvexCover& cover, const Triple& p) {
  return std::any_of(cover.pieces.begin(), cover.pieces.end(),
                     [&](const ConvexHull& hull) { return plane_distance(hull, p) < 2e-6; });
}

// How many of random places inside the body, and of random places on its surface, no piece holds.
int count_bare(const Covered& covered, int places) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share;
  const auto& [low, high] = std::pair{covered.mesh.facts.low, covered.mesh.facts.high};
  int bare = 0;
  for (int k = 0; k < places; ++k) {
    Triple p{};
    for (std::size_t i = 0; i < 3; ++i) p[i] = low[i] + share(random) * (high[i] - low[i]);
    bare += covered.body.is_inside(p) && !is_covered(covered.cover, p);
  }
  const auto& [vertices, triangles] = std::pair{covered.mesh.mesh.vertices, covered.mesh.mesh.triangles};
  for (int k = 0; k < places; ++k) {
    const auto& [a, b, c] = triangles[random() % triangles.size()];
    const Triple edge = point_between(vertices[a], vertices[b], share(random));
    bare += !is_covered(covered.cover, point_between(edge, vertices[c], share(random)));
  }
  return bare;
}

// The farthest of many places on the pieces' surfaces outside the body, m.
double farthest_outside(const Covered& covered, int of_each) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> share;
  double farthest = 0;
  for (const ConvexHull& hull : covered.cover.pieces) {
    for (const auto& [a, b, c] : hull.triangles) {
      for (int k = 0; k < of_each; ++k) {
        const Triple edge = point_between(hull.vertices[a], hull.vertices[b], share(random));
        const Triple p = point_between(edge, hull.vertices[c], share(random));
        farthest = std::max(farthest, covered.body.signed_distance(p));
      }
    }
  }
  return farthest;
}

void expect_cover(const Covered& covered, const std::string& name) {
  EXPECT_EQ(count_bare(covered, 20'000), 0) << name;
  const double farthest = farthest_outside(covered, 60);
  EXPECT_LE(farthest, covered.cover.error + 1e-9) << name;
  EXPECT_LE(covered.cover.error, CONVEX_TOLERANCE) << name;
  EXPECT_GE(farthest, covered.cover.error - 0.2e-3) << name;  // the stated error is no wild guess
}

TEST(ConvexCells, AConvexBodyIsOnePieceWithoutError) {
  for (const TriangleMesh& mesh : {box_mesh({-0.02, 0, -0.02}, {0.02, 0.05, 0.02}), icosphere(0.04, 4)}) {
    const Covered covered(mesh);
    ASSERT_EQ(covered.cover.pieces.size(), 1u);
    EXPECT_LT(covered.cover.error, 1e-6);
    EXPECT_EQ(covered.cover.pieces[0].vertices.size(), covered.mesh.mesh.vertices.size());
    EXPECT_NEAR(covered.cover.pieces[0].volume, covered.mesh.facts.volume, 1e-9 * covered.mesh.facts.volume);
  }
}

// A groove across the top of a box, so deep.
TriangleMesh grooved_box(double depth) {
  TriangleMesh mesh;
  for (const double z : {-0.02, 0.02})
    for (const auto& [x, y] : {std::pair{-0.02, 0.0}, {0.02, 0.0}, {0.02, 0.05}, {0.0, 0.05 - depth}, {-0.02, 0.05}})
      mesh.vertices.push_back({x, y, z});
  mesh.triangles = {{0, 3, 1}, {1, 3, 2}, {0, 4, 3}, {5, 6, 8}, {6, 7, 8}, {5, 8, 9}};
  for (std::uint32_t k = 0; k < 5; ++k) {
    const std::uint32_t next = (k + 1) % 5;
    mesh.triangles.push_back({k, next, k + 5});
    mesh.triangles.push_back({next, next + 5, k + 5});
  }
  return mesh;
}

TEST(ConvexCells, AMeshWithinHalfAMillimeterOfItsHullIsOnePiece) {
  const Covered shallow(grooved_box(0.48e-3)), deep(grooved_box(0.6e-3));
  EXPECT_EQ(shallow.cover.pieces.size(), 1u);
  EXPECT_GT(shallow.cover.error, 0.47e-3);
  EXPECT_LE(shallow.cover.error, CONVEX_TOLERANCE);
  EXPECT_GT(deep.cover.pieces.size(), 1u);
  EXPECT_LE(deep.cover.error, CONVEX_TOLERANCE);
}

TEST(ConvexCells, PiecesHoldABodyAndKeepToIt) {
  const Covered boxes(joined(box_mesh({-0.02, 0, -0.02}, {0.02, 0.05, 0.02}), box_mesh({0.01, 0.01, -0.01}, {0.06, 0.03, 0.01})));
  expect_cover(boxes, "boxes");
  EXPECT_EQ(boxes.cover.pieces.size(), 2u);
  const Covered ring(torus(0.04, 0.008, 48, 16)), cup(cup_mesh(32));
  expect_cover(ring, "torus");
  expect_cover(cup, "cup");
  EXPECT_LE(cup.cover.pieces.size(), 40u);
}

TEST(ConvexCells, PiecesHoldAMugWithItsHandle) {
  const Covered mug(mug_mesh());
  expect_cover(mug, "mug");
  EXPECT_LE(mug.cover.pieces.size(), 64u);
}

// With too few pieces the error is large, and still no smaller than it is.
TEST(ConvexCells, FewPiecesStateTheirError) {
  const Covered ring(torus(0.04, 0.008, 48, 16), 4);
  EXPECT_LE(ring.cover.pieces.size(), 4u);
  EXPECT_GT(ring.cover.error, MOST_PIECE_ERROR);
  EXPECT_LE(farthest_outside(ring, 60), ring.cover.error);
  EXPECT_EQ(count_bare(ring, 5'000), 0);
}

TEST(ConvexCells, AMeshThatIsTooFineIsRefusedWithTheNumbersAndTheRemedy) {
  const VesselData vessel = vessel_of_mesh("ring", torus(0.04, 0.008, 48, 16), 0);
  EXPECT_EQ(refusal_line([&] { vessel_form(vessel, ""); }), "");
  const std::string line = refusal_line([&] { vessel_form(vessel, "", 4); });
  EXPECT_NE(line.find("vessel ring: its mesh is not convex, and 4 convex pieces of it, the most there may be, still reach "),
            std::string::npos)
      << line;
  EXPECT_NE(line.find(" mm out of it; allowed: 1 mm; put convex pieces of it, as CoACD writes them, beside it as ring.pieces.obj"),
            std::string::npos)
      << line;
}

}  // namespace
}  // namespace wholehand
