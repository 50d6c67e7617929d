// SPDX-License-Identifier: MIT
// Holes: loops of open edges, their size, and what closes them.
#include "core/meshes/holes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/meshes/check.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

TEST(MeshHoles, AClosedMeshHasNone) {
  const MeshHoles holes = find_holes(icosphere(0.05, 2));
  EXPECT_TRUE(holes.loops.empty());
  EXPECT_EQ(holes.loose_edges, 0u);
}

TEST(MeshHoles, AMissingTriangleIsItsOwnHole) {
  TriangleMesh mesh = icosphere(0.05, 2);
  const auto missing = mesh.triangles[17];
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  const MeshHoles holes = find_holes(mesh);
  ASSERT_EQ(holes.loops.size(), 1u);
  close_hole(holes.loops[0], mesh);
  auto closing = mesh.triangles.back();
  std::rotate(closing.begin(), std::find(closing.begin(), closing.end(), missing[0]), closing.end());
  EXPECT_EQ(closing, missing) << "turned as it was";
}

// The way comes by the vertex that they share once for each: with all its edges looked through each time this took minutes.
TEST(MeshHoles, TrianglesAboutOneVertexAreQuicklyWalked) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, 0});
  constexpr std::uint32_t triangles = 100'000;
  for (std::uint32_t k = 0; k < triangles; ++k) {
    const double angle = 2 * PI * k / triangles, width = PI / triangles;
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0});
    mesh.vertices.push_back({std::cos(angle + width), std::sin(angle + width), 0});
    mesh.triangles.push_back({0, 2 * k + 1, 2 * k + 2});
  }
  const MeshHoles holes = find_holes(mesh);
  EXPECT_EQ(holes.loops.size(), triangles);
  EXPECT_EQ(holes.loose_edges, 0u);
}

TEST(MeshHoles, TheRimOfABowlIsMeasured) {
  const MeshHoles holes = find_holes(check_mesh(open_hemisphere(0.05, 5), "bowl").mesh);
  ASSERT_EQ(holes.loops.size(), 1u);
  EXPECT_EQ(holes.loops[0].corners.size(), 128u);
  EXPECT_NEAR(holes.loops[0].length, 2 * PI * 0.05, 1e-4);
  EXPECT_NEAR(holes.loops[0].across, std::hypot(0.1, 0.1), 1e-12) << "of the box about it";
  EXPECT_FALSE(is_small_hole(holes.loops[0], 0.1));
}

TEST(MeshHoles, AFanClosesFlatAndOutward) {
  // a box whose top is one polygon that is not there
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t i) { return mesh.vertices[i][1] == 1; });
  });
  const MeshHoles holes = find_holes(mesh);
  ASSERT_EQ(holes.loops.size(), 1u);
  EXPECT_EQ(holes.loops[0].length, 4);
  close_hole(holes.loops[0], mesh);
  EXPECT_EQ(mesh.vertices.back(), (Triple{0.5, 1, 0.5}));
  const MeshFacts facts = check_mesh(mesh, "box").facts;
  EXPECT_TRUE(facts.closed && facts.oriented);
  EXPECT_FALSE(facts.was_inside_out);
  EXPECT_NEAR(facts.volume, 1, 1e-15);
}

TEST(MeshHoles, HolesThatTouchInAVertexAreTwo) {
  TriangleMesh mesh = icosphere(0.05, 3);
  const std::uint32_t shared = mesh.triangles[100][0];
  std::vector<std::size_t> around;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (std::count(mesh.triangles[i].begin(), mesh.triangles[i].end(), shared)) around.push_back(i);
  // two of six that have no edge in common
  const auto shares_edge = [&](std::size_t i, std::size_t j) {
    return std::count_if(mesh.triangles[i].begin(), mesh.triangles[i].end(), [&](std::uint32_t corner) {
             return std::count(mesh.triangles[j].begin(), mesh.triangles[j].end(), corner) > 0;
           }) > 1;
  };
  const auto other = std::find_if(around.begin() + 1, around.end(), [&](std::size_t i) { return !shares_edge(around[0], i); });
  ASSERT_NE(other, around.end());
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(*other));
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(around[0]));
  const MeshHoles holes = find_holes(mesh);
  ASSERT_EQ(holes.loops.size(), 2u);
  for (const MeshHole& hole : holes.loops) close_hole(hole, mesh);
  const MeshFacts facts = check_mesh(mesh, "ball").facts;
  EXPECT_TRUE(facts.closed && facts.oriented);
  EXPECT_EQ(facts.non_manifold_edges, 0u);
}

TEST(MeshHoles, EdgesOfTrianglesThatFaceOppositeWaysFormNoLoop) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  mesh.triangles = {mesh.triangles[0], mesh.triangles[1]};
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  const MeshHoles holes = find_holes(mesh);
  EXPECT_TRUE(holes.loops.empty());
  EXPECT_EQ(holes.loose_edges, 4u);
}

TEST(MeshHoles, SmallIsATenthAcrossAndFourAlongTheEdge) {
  MeshHole hole;
  hole.corners = {0, 1, 2};
  hole.across = 0.1;
  hole.length = 0.4;
  EXPECT_TRUE(is_small_hole(hole, 1));
  hole.across = 0.101;
  EXPECT_FALSE(is_small_hole(hole, 1));
  hole.across = 0.05;
  hole.length = 0.41;
  EXPECT_FALSE(is_small_hole(hole, 1)) << "a long slit, folded";
}

}  // namespace
}  // namespace wholehand
