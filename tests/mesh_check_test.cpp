// What is said of a mesh before it is used.
#include "sweeps/mesh_check.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

constexpr double PI = std::numbers::pi;

TriangleMesh cube() { return box_mesh({0, 0, 0}, {0.1, 0.2, 0.3}); }

bool says(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

std::string refusal(const TriangleMesh& mesh) {
  try {
    check_mesh(mesh, "cup.glb");
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  return "taken";
}

TEST(MeshCheck, ABoxIsMeasured) {
  const MeshFacts facts = check_mesh(cube(), "box").facts;
  EXPECT_EQ(facts.triangles, 12u);
  EXPECT_TRUE(facts.closed);
  EXPECT_TRUE(facts.oriented);
  EXPECT_FALSE(facts.was_inside_out);
  EXPECT_EQ(facts.open_edges + facts.non_manifold_edges + facts.inverted_pairs + facts.zero_triangles, 0u);
  EXPECT_NEAR(facts.volume, 0.006, 1e-17);
  EXPECT_NEAR(facts.area, 0.22, 1e-15);
  EXPECT_EQ(facts.high, (Triple{0.1, 0.2, 0.3}));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(facts.center_of_mass[k], facts.high[k] / 2, 1e-16);
  EXPECT_TRUE(says(mesh_check_text(facts),
                   "12 triangles, 100 x 200 x 300 mm (x 0 to 100, y 0 to 200, z 0 to 300), closed; 0 non-manifold edges"));
}

TEST(MeshCheck, ClosedForms) {
  // chords lie within a sphere: the volume misses the square of the angle between neighbours, some 1e-3 here
  EXPECT_NEAR(check_mesh(icosphere(0.05, 5), "sphere").facts.volume / (4 * PI / 3 * 0.05 * 0.05 * 0.05), 1, 1e-2);
  EXPECT_NEAR(check_mesh(torus(0.05, 0.02, 400, 200), "torus").facts.volume / (2 * PI * PI * 0.05 * 0.02 * 0.02), 1, 1e-3);
}

TEST(MeshCheck, CornersInOnePlaceAreJoined) {
  TriangleMesh loose;
  for (const auto& triangle : cube().triangles) {
    const auto first = static_cast<std::uint32_t>(loose.vertices.size());
    for (const std::uint32_t corner : triangle) loose.vertices.push_back(cube().vertices[corner]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  loose.vertices.push_back({9, 9, 9});  // which no triangle uses
  const CheckedMesh checked = check_mesh(loose, "box");
  EXPECT_EQ(checked.mesh.vertices.size(), 8u);
  EXPECT_TRUE(checked.facts.closed);
  EXPECT_EQ(checked.facts.high, (Triple{0.1, 0.2, 0.3}));
}

TEST(MeshCheck, InsideOutIsTurnedRound) {
  TriangleMesh mesh = cube();
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  const CheckedMesh checked = check_mesh(mesh, "box");
  EXPECT_TRUE(checked.facts.was_inside_out);
  EXPECT_NEAR(checked.facts.volume, 0.006, 1e-17);
  EXPECT_FALSE(check_mesh(checked.mesh, "box").facts.was_inside_out);
  EXPECT_TRUE(says(mesh_check_text(checked.facts), "inside out and has been turned round"));
}

TEST(MeshCheck, AMissingTriangleLeavesThreeOpenEdges) {
  TriangleMesh mesh = cube();
  mesh.triangles.pop_back();
  const MeshFacts facts = check_mesh(mesh, "box").facts;
  EXPECT_EQ(facts.open_edges, 3u);
  EXPECT_FALSE(facts.closed);
  EXPECT_TRUE(facts.oriented);
  EXPECT_NEAR(facts.volume, 0.006, 1e-17);  // the hole is flat, and closed within its plane
  EXPECT_TRUE(says(mesh_check_text(facts), "not closed (3 open edges)"));
}

TEST(MeshCheck, AnOpenHemisphereIsClosedFlat) {
  const MeshFacts facts = check_mesh(open_hemisphere(0.1, 5), "bowl").facts;
  EXPECT_EQ(facts.open_edges, 128u);
  EXPECT_NEAR(facts.volume / (2 * PI / 3 * 1e-3), 1, 1e-2);
  EXPECT_NEAR(facts.center_of_mass[1], 0.1 * 3 / 8, 1e-4);
}

TEST(MeshCheck, ATriangleTurnedRoundIsThreeInvertedPairs) {
  TriangleMesh mesh = cube();
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  const MeshFacts facts = check_mesh(mesh, "box").facts;
  EXPECT_EQ(facts.inverted_pairs, 3u);
  EXPECT_TRUE(facts.closed);
  EXPECT_FALSE(facts.oriented);
  EXPECT_TRUE(says(mesh_check_text(facts), "do not all face outward"));
}

TEST(MeshCheck, BoxesThatShareAnEdgeAreNotManifold) {
  const MeshFacts facts = check_mesh(joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 1, 0}, {2, 2, 1})), "two").facts;
  EXPECT_EQ(facts.non_manifold_edges, 1u);
  EXPECT_TRUE(facts.closed);
  EXPECT_TRUE(facts.oriented);
}

TEST(MeshCheck, TrianglesWithoutAreaAreCounted) {
  TriangleMesh mesh = cube();
  mesh.triangles.push_back({0, 0, 1});  // falls away
  const MeshFacts with_point = check_mesh(mesh, "box").facts;
  EXPECT_EQ(with_point.zero_triangles, 1u);
  EXPECT_TRUE(with_point.closed);
  mesh.vertices.push_back({0.05, 0, 0});  // on the edge from 0 to 1: stays, as it may close a seam
  mesh.triangles.push_back({0, 8, 1});
  const MeshFacts with_sliver = check_mesh(mesh, "box").facts;
  EXPECT_EQ(with_sliver.zero_triangles, 2u);
  EXPECT_FALSE(with_sliver.closed);
}

TEST(MeshCheck, WhatFallsAwayHasNoSayInTheExtent) {
  TriangleMesh mesh = cube();
  mesh.vertices.push_back({5, 0, 0});
  mesh.triangles.push_back({8, 8, 8});
  const CheckedMesh checked = check_mesh(mesh, "box");
  EXPECT_EQ(checked.facts.high, (Triple{0.1, 0.2, 0.3}));
  EXPECT_EQ(checked.mesh.vertices.size(), 8u);
  EXPECT_EQ(checked.facts.zero_triangles, 1u);
}

TEST(MeshCheck, WhatEnclosesNothingIsRefused) {
  TriangleMesh sheet = cube();
  for (Triple& p : sheet.vertices) p[1] = 0;
  EXPECT_TRUE(says(refusal(sheet), "cup.glb: encloses no volume"));
  TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 0}}, {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {2, 4, 3}}};
  EXPECT_TRUE(says(refusal(flat), "give it a thickness"));
  for (auto& triangle : flat.triangles) triangle = {1, 1, 2};
  EXPECT_TRUE(says(refusal(flat), "no triangle with an area"));
  TriangleMesh thin = box_mesh({0, 0, 0}, {1, 1e-6, 1});
  EXPECT_EQ(refusal(thin), "taken");
}

TEST(MeshCheck, MillimetresAreNoticed) {
  const auto warning = [](double height) { return mesh_size_warning(check_mesh(box_mesh({0, 0, 0}, {1, height, 1}), "b").facts); };
  EXPECT_EQ(warning(9.9), "");
  EXPECT_EQ(warning(120), "it is 120 m large: glTF counts in metres; if these are millimetres, set mesh_scale = 0.001 (120 mm)");
  EXPECT_TRUE(says(warning(12), "mesh_scale = 0.01 (120 mm)"));
}

}  // namespace
}  // namespace wholehand
