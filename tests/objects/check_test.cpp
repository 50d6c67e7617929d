// SPDX-License-Identifier: MIT
// What is said of a mesh before it is used.
#include "objects/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/error.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

constexpr double PI = std::numbers::pi;

TriangleMesh cube() { return box_mesh({0, 0, 0}, {0.1, 0.2, 0.3}); }

bool says(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

std::string refusal(const TriangleMesh& mesh) {
  return refusal_line([&] { check_mesh(mesh, "cup.glb"); });
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
  EXPECT_EQ(refusal(thin), "");
}

TEST(MeshCheck, UnitsThatAreTooLargeOrTooSmallAreNoticed) {
  const auto warning = [](double height, double scale = 1) {
    return mesh_size_warning(check_mesh(box_mesh({0, 0, 0}, {height / 2, height, height / 2}), "b").facts, scale);
  };
  EXPECT_EQ(warning(9.9), "");
  EXPECT_EQ(warning(2.1e-3), "");
  EXPECT_EQ(
      warning(120),
      "it is 120 m large: its numbers are taken as metres; the likely scale is mesh_scale = 0.001, with which it is 120 mm large");
  EXPECT_TRUE(says(warning(12), "mesh_scale = 0.01, with which it is 120 mm"));
  EXPECT_EQ(
      warning(0.08e-3),
      "it is 0.08 mm large: its numbers are taken as metres; the likely scale is mesh_scale = 1000, with which it is 80 mm large");
  EXPECT_TRUE(says(warning(1.2e-3), "mesh_scale = 100, with which it is 120 mm"));
  EXPECT_TRUE(says(warning(80e-9), "mesh_scale = 1e+06, with which it is 80 mm"));
  // beside a scale that was given
  EXPECT_TRUE(
      says(warning(0.08e-3, 0.001), "its numbers times 0.001 are taken as metres; the likely scale is mesh_scale = 1, with"));
  EXPECT_TRUE(says(warning(120, 0.01), "mesh_scale = 1e-05, with which it is 120 mm"));
}

TEST(MeshCheck, CopiesOfTrianglesAreLeftOut) {
  TriangleMesh many = cube();
  for (int i = 0; i < 5; ++i) many = joined(many, cube());
  const CheckedMesh checked = check_mesh(many, "six");
  EXPECT_EQ(checked.mesh.triangles.size(), 12u);
  EXPECT_EQ(checked.facts.repeated_triangles, 60u);
  EXPECT_EQ(checked.facts.non_manifold_edges, 0u);
  EXPECT_TRUE(checked.facts.closed && checked.facts.oriented);
  EXPECT_NEAR(checked.facts.volume, 0.006, 1e-17);
  EXPECT_TRUE(says(mesh_check_text(checked.facts), "60 triangles were there before and left out."));
  TriangleMesh both_sides = cube();
  both_sides.triangles.push_back({both_sides.triangles[0][0], both_sides.triangles[0][2], both_sides.triangles[0][1]});
  EXPECT_EQ(check_mesh(both_sides, "sides").facts.repeated_triangles, 0u) << "turned the other way it is another";
}

TEST(MeshCheck, JoinedCornersAreSaid) {
  TriangleMesh loose;
  for (const auto& triangle : cube().triangles)
    for (const std::uint32_t corner : triangle) loose.vertices.push_back(cube().vertices[corner]);
  for (std::uint32_t i = 0; i < 36; i += 3) loose.triangles.push_back({i, i + 1, i + 2});
  const MeshFacts facts = check_mesh(loose, "soup").facts;
  EXPECT_EQ(facts.joined_corners, 28u);
  EXPECT_TRUE(says(mesh_check_text(facts), "28 corners were equal to others joined with them."));
  EXPECT_FALSE(says(mesh_check_text(check_mesh(cube(), "box").facts), "joined"));
}

TEST(MeshCheck, HolesAreMeasuredAndOffered) {
  TriangleMesh ball = icosphere(0.05, 4);
  ball.triangles.pop_back();
  const MeshFacts facts = check_mesh(ball, "ball").facts;
  EXPECT_EQ(facts.holes, 1u);
  EXPECT_TRUE(says(mesh_check_text(facts), ": 1 hole, up to ")) << mesh_check_text(facts);
  EXPECT_TRUE(says(mesh_check_text(facts), "which close_holes = true closes."));
  const MeshFacts bowl = check_mesh(open_hemisphere(0.05, 4), "bowl").facts;
  EXPECT_TRUE(says(mesh_check_text(bowl), "1 hole, up to 141.4 mm across, more than the 10 mm that close_holes closes"))
      << mesh_check_text(bowl);
}

// A small hole beside edges that form no loop: what the note says is what close_holes does.
TEST(MeshCheck, WhatCannotBeClosedIsNotOffered) {
  TriangleMesh ball = icosphere(0.05, 4);
  const auto missing = ball.triangles.back();
  ball.triangles.pop_back();
  ball.triangles.erase(ball.triangles.begin());
  const auto has_corner = [&](const auto& t, std::uint32_t corner) { return std::find(t.begin(), t.end(), corner) != t.end(); };
  for (auto& t : ball.triangles) {
    if (!has_corner(t, missing[0]) || !has_corner(t, missing[1])) continue;
    std::swap(t[0], t[1]);
    break;
  }
  const MeshFacts facts = check_mesh(ball, "ball").facts;
  EXPECT_EQ(facts.holes, 1u);
  EXPECT_TRUE(says(mesh_check_text(facts), "which close_holes does not close")) << mesh_check_text(facts);
  EXPECT_THROW(check_mesh(ball, "ball", true), Error);
}

TEST(MeshCheck, SmallHolesAreClosedWhereThatIsWished) {
  TriangleMesh ball = icosphere(0.05, 4);
  const double whole = check_mesh(ball, "ball").facts.volume;
  ball.triangles.pop_back();
  std::erase_if(ball.triangles, [](const auto& t) { return t[0] == 5 || t[1] == 5 || t[2] == 5; });
  for (const bool inside_out : {false, true}) {
    if (inside_out)
      for (auto& triangle : ball.triangles) std::swap(triangle[0], triangle[1]);
    const CheckedMesh checked = check_mesh(ball, "ball", true);
    EXPECT_TRUE(checked.facts.closed && checked.facts.oriented);
    EXPECT_EQ(checked.facts.was_inside_out, inside_out);
    EXPECT_EQ(checked.facts.closed_holes, 2u);
    EXPECT_EQ(checked.facts.holes + checked.facts.open_edges, 0u);
    // a cap of five triangles, 3.5 mm each, is flat now
    EXPECT_NEAR(checked.facts.volume, whole, 5 * 3.5e-3 * 3.5e-3 * 0.2e-3);
    EXPECT_TRUE(says(mesh_check_text(checked.facts), "2 holes were closed, up to ")) << mesh_check_text(checked.facts);
  }
}

TEST(MeshCheck, LargeHolesAreRefusedWithTheirSize) {
  const auto line = [](const TriangleMesh& mesh) -> std::string {
    try {
      check_mesh(mesh, "bowl.stl", true);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return error.what();
    }
    return "closed";
  };
  const std::string bowl = line(open_hemisphere(0.05, 4));
  EXPECT_TRUE(says(bowl, "bowl.stl: close_holes: a hole is 141.4 mm across, its edge 314 mm")) << bowl;
  EXPECT_TRUE(says(bowl, "at most 10 and 40 mm are closed: close it where the mesh was made")) << bowl;
  TriangleMesh ball = icosphere(0.05, 4);
  auto& beside = ball.triangles.back();
  std::swap(beside[0], beside[1]);
  ball.triangles.erase(ball.triangles.end() - 2);  // its neighbour
  EXPECT_TRUE(says(line(ball), "bowl.stl: close_holes: 3 open edges form no loop")) << line(ball);
  EXPECT_EQ(line(icosphere(0.05, 4)), "closed");
}

}  // namespace
}  // namespace wholehand
