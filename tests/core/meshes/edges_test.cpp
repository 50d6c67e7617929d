// SPDX-License-Identifier: MIT
// Edges of bodies: each once, with what lies on both sides, and where they are sharp.
#include "core/meshes/edges.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/meshes.h"

namespace wholehand {
namespace {

int creases_of(const MeshBody& body) {
  const MeshEdges found = find_edges(body);
  return static_cast<int>(std::count_if(found.edges.begin(), found.edges.end(), [](const MeshEdge& e) { return e.is_crease; }));
}

// Two squares that meet in the z axis, the second turned upwards by an angle.
MeshBody hinge(double angle) {
  MeshBody body;
  body.vertices = {{-1, 0, 0}, {0, 0, 0}, {0, 0, -1}, {std::cos(angle), std::sin(angle), 0}};
  body.triangles = {{0, 1, 2}, {1, 3, 2}};
  return body;
}

TEST(MeshEdges, EveryEdgeOnceWithBothItsTriangles) {
  const MeshBody body = body_of(torus(0.05, 0.02, 30, 15));
  const MeshEdges found = find_edges(body);
  EXPECT_EQ(found.edges.size(), 3 * body.triangles.size() / 2);
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  const auto runs = [&](std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
    const auto& t = body.triangles[triangle];
    for (int k = 0; k < 3; ++k) {
      if (t[k] == from && t[(k + 1) % 3] == to) return true;
    }
    return false;
  };
  for (const MeshEdge& edge : found.edges) {
    EXPECT_TRUE(seen.insert(std::minmax(edge.from, edge.to)).second);
    ASSERT_NE(edge.right, NO_TRIANGLE);
    EXPECT_TRUE(runs(edge.left, edge.from, edge.to));
    EXPECT_TRUE(runs(edge.right, edge.to, edge.from));
  }
}

TEST(MeshEdges, NormalsAreOutwardAndUnit) {
  const MeshBody body = body_of(icosphere(0.05, 3));
  const MeshEdges found = find_edges(body);
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    const Triple &n = found.normals[t], &p = body.vertices[body.triangles[t][0]];
    EXPECT_NEAR(norm(n), 1, 1e-12);
    EXPECT_GT(dot(n, p), 0.99 * 0.05);  // a triangle of 9 degrees
  }
}

TEST(MeshEdges, CreasesBeginAtThirtyDegrees) {
  EXPECT_EQ(creases_of(hinge(radians(29.99))), 0);
  EXPECT_EQ(creases_of(hinge(radians(30.01))), 1);
  EXPECT_EQ(creases_of(hinge(radians(-30.01))), 1);
  EXPECT_EQ(creases_of(hinge(radians(170))), 1);
  EXPECT_EQ(creases_of(body_of(box_mesh({0, 0, 0}, {1, 2, 3}))), 12);  // and not its six diagonals
  EXPECT_EQ(creases_of(body_of(icosphere(0.05, 2))), 0);
  EXPECT_EQ(creases_of(body_of(icosphere(0.05, 0))), 30);  // 41.8 degrees
}

TEST(MeshEdges, OpenAndManifoldlessEdgesHaveNoOtherSide) {
  const MeshBody bowl = body_of(open_hemisphere(0.05, 3));
  const MeshEdges rim = find_edges(bowl);
  int open = 0;
  for (const MeshEdge& edge : rim.edges) {
    if (edge.right != NO_TRIANGLE) continue;
    ++open;
    EXPECT_FALSE(edge.is_crease);
    EXPECT_NEAR(bowl.vertices[edge.from][1], 0, 1e-15);
    EXPECT_NEAR(bowl.vertices[edge.to][1], 0, 1e-15);
  }
  EXPECT_EQ(open, 4 * 8);
  // two boxes that share an edge: four triangles meet there
  const MeshEdges two = find_edges(body_of(joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 1, 0}, {2, 2, 1}))));
  EXPECT_EQ(std::count_if(two.edges.begin(), two.edges.end(), [](const MeshEdge& e) { return e.right == NO_TRIANGLE; }), 4);
  MeshBody inverted = hinge(0);
  std::swap(inverted.triangles[1][0], inverted.triangles[1][1]);
  for (const MeshEdge& edge : find_edges(inverted).edges) EXPECT_EQ(edge.right, NO_TRIANGLE);
}

// A seam: one side has a vertex in the middle of the other's edge, and a triangle without area joins them.
TEST(MeshEdges, ATriangleWithoutAreaIsNoCrease) {
  MeshBody body;
  body.vertices = {{-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}, {1, 0, 0}};
  body.triangles = {{0, 1, 2}, {2, 1, 3}, {3, 1, 4}, {2, 3, 4}};
  const MeshEdges found = find_edges(body);
  EXPECT_EQ(creases_of(body), 0);
  EXPECT_EQ(found.normals[1], found.normals[0]);
  body.triangles = {{2, 1, 3}};
  EXPECT_EQ(find_edges(body).normals[0], Triple{});
}

}  // namespace
}  // namespace wholehand
