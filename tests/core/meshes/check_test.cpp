// SPDX-License-Identifier: MIT
// Checks of a mesh before it is used.
#include "core/meshes/check.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include "base/text/error.h"
#include "tests/support/mesh_faults.h"
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
  // chords lie within a sphere: the volume misses the square of the angle between neighbors, some 1e-3 here
  EXPECT_NEAR(check_mesh(icosphere(0.05, 5), "sphere").facts.volume / (4 * PI / 3 * 0.05 * 0.05 * 0.05), 1, 1e-2);
  EXPECT_NEAR(check_mesh(torus(0.05, 0.02, 400, 200), "torus").facts.volume / (2 * PI * PI * 0.05 * 0.02 * 0.02), 1, 1e-3);
}

TEST(MeshCheck, CornersInOnePlaceAreJoined) {
  TriangleMesh loose = unjoined(cube());
  loose.vertices.push_back({9, 9, 9});  // which no triangle uses
  const CheckedMesh checked = check_mesh(loose, "box");
  EXPECT_EQ(checked.mesh.vertices.size(), 8u);
  EXPECT_TRUE(checked.facts.closed);
  EXPECT_EQ(checked.facts.high, (Triple{0.1, 0.2, 0.3}));
}

// Joined by a hash, whatever the order of the file, and with the sign of a zero.
TEST(MeshCheck, JoinedCornersAreInTheOrderOfTheirCoordinates) {
  TriangleMesh apart, shuffled = torus(0.05, 0.02, 40, 20);
  std::mt19937 random(1);
  std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), random);
  for (const Corners& triangle : shuffled.triangles) {
    const auto first = static_cast<std::uint32_t>(apart.vertices.size());
    for (const std::uint32_t corner : triangle) {
      Triple at = shuffled.vertices[corner];
      for (double& x : at) x = x == 0 && random() % 2 == 0 ? -0.0 : x;
      apart.vertices.push_back(at);
    }
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  std::vector<Triple> expected = shuffled.vertices;
  std::sort(expected.begin(), expected.end());
  expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
  const CheckedMesh checked = check_mesh(apart, "torus");
  EXPECT_EQ(checked.mesh.vertices, expected);
  EXPECT_EQ(checked.facts.joined_corners, apart.vertices.size() - expected.size());
  ASSERT_EQ(checked.mesh.triangles.size(), apart.triangles.size());
  for (std::size_t i = 0; i < apart.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(checked.mesh.vertices[checked.mesh.triangles[i][k]], apart.vertices[apart.triangles[i][k]]);
}

TEST(MeshCheck, UsesOfEdgesAreSorted) {
  std::mt19937 random(2);
  std::vector<Corners> triangles;
  for (int i = 0; i < 2000; ++i) {
    const auto corner = static_cast<std::uint32_t>(random() % 50);
    triangles.push_back({corner, corner + 1 + static_cast<std::uint32_t>(random() % 20), corner + 30});
    std::shuffle(triangles.back().begin(), triangles.back().end(), random);
  }
  const std::vector<EdgeUse> uses = edge_uses(triangles);
  ASSERT_EQ(uses.size(), 6000u);
  const auto order = [](const EdgeUse& use) { return std::tie(use.low, use.high, use.triangle); };
  std::map<std::array<std::uint32_t, 3>, bool> expected;
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      expected[{std::min(from, to), std::max(from, to), t}] = from < to;
    }
  EXPECT_EQ(expected.size(), uses.size());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    EXPECT_EQ((expected.at({uses[i].low, uses[i].high, uses[i].triangle})), uses[i].is_forward);
    EXPECT_TRUE(i == 0 || order(uses[i - 1]) < order(uses[i]));
  }
  EXPECT_TRUE(edge_uses({}).empty());
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

void turn_triangle(TriangleMesh& mesh, std::size_t number) { std::swap(mesh.triangles[number][0], mesh.triangles[number][1]); }

TEST(MeshCheck, TrianglesThatFaceInwardAreTurnedOutward) {
  for (const std::size_t inward : {1u, 3u, 6u, 11u}) {
    TriangleMesh mesh = cube();
    for (std::size_t i = 0; i < inward; ++i) turn_triangle(mesh, 5 * i % 12);
    const CheckedMesh checked = check_mesh(mesh, "box");
    EXPECT_EQ(checked.facts.turned_triangles, inward);
    EXPECT_EQ(checked.facts.inverted_pairs, 0u);
    EXPECT_TRUE(checked.facts.closed && checked.facts.oriented && !checked.facts.was_inside_out);
    EXPECT_NEAR(checked.facts.volume, 0.006, 1e-17);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(checked.facts.center_of_mass[k], checked.facts.high[k] / 2, 1e-16);
    EXPECT_TRUE(says(mesh_check_text(checked.facts), inward == 1 ? "1 triangle faced inward and was turned outward."
                                                                 : fmt::format("{} triangles faced inward and were", inward)));
  }
}

// Half of its triangles face inward, so that their volumes cancel, or add up to the right one about the wrong place.
TEST(MeshCheck, ATetrahedronIsTheSameWhicheverOfItsTrianglesFaceInward) {
  const TriangleMesh tetrahedron{{{0, 0, 0}, {0.08, 0, 0}, {0, 0.08, 0}, {0, 0, 0.08}},
                                 {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
  for (unsigned inward = 0; inward < 16; ++inward) {
    TriangleMesh mesh = tetrahedron;
    for (std::size_t i = 0; i < 4; ++i)
      if ((inward >> i & 1u) != 0) turn_triangle(mesh, i);
    const MeshFacts facts = check_mesh(mesh, "tetrahedron").facts;
    EXPECT_NEAR(facts.volume, 0.08 * 0.08 * 0.08 / 6, 1e-18) << inward;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(facts.center_of_mass[k], 0.02, 1e-16) << inward;
  }
}

TEST(MeshCheck, EachBodyFacesOutwardAndACavityInward) {
  const TriangleMesh ball = icosphere(0.02, 2);
  TriangleMesh inverted = ball;
  for (std::size_t i = 0; i < inverted.triangles.size(); ++i) turn_triangle(inverted, i);
  const double small = check_mesh(ball, "ball").facts.volume, large = 0.1 * 0.1 * 0.1;
  const TriangleMesh box = box_mesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05});
  // beside it, whichever way it faces
  EXPECT_NEAR(check_mesh(joined(box, placed_mesh(inverted, {}, {0.2, 0, 0})), "two").facts.volume, large + small, 1e-15);
  // within it: a cavity, also in a mesh that is inside out as a whole; and a body in the cavity
  EXPECT_NEAR(check_mesh(joined(box, inverted), "hollow").facts.volume, large - small, 1e-15);
  TriangleMesh all_inverted = joined(box, inverted);
  for (std::size_t i = 0; i < all_inverted.triangles.size(); ++i) turn_triangle(all_inverted, i);
  const CheckedMesh turned = check_mesh(all_inverted, "hollow");
  EXPECT_NEAR(turned.facts.volume, large - small, 1e-15);
  EXPECT_TRUE(turned.facts.was_inside_out);
  const TriangleMesh core = box_mesh({-0.005, -0.005, -0.005}, {0.005, 0.005, 0.005});
  TriangleMesh inverted_core = core;
  for (std::size_t i = 0; i < inverted_core.triangles.size(); ++i) turn_triangle(inverted_core, i);
  EXPECT_NEAR(check_mesh(joined(joined(box, inverted), inverted_core), "with a core").facts.volume, large - small + 1e-6, 1e-15);
  // a part of it lies within: they overlap
  const TriangleMesh across = placed_mesh(inverted, {}, {0.045, 0, 0});
  EXPECT_NEAR(check_mesh(joined(box, across), "across").facts.volume, large + small, 1e-15);
}

// A strip with one side: four quads in a ring, the last one twisted.
TEST(MeshCheck, ASurfaceWithOneSideIsNamed) {
  TriangleMesh strip;
  for (int i = 0; i < 8; ++i) {
    const double turn = PI * i / 8, angle = 2 * PI * i / 8;
    for (const double side : {-0.01, 0.01}) {
      const double r = 0.05 + side * std::cos(turn);
      strip.vertices.push_back({r * std::cos(angle), side * std::sin(turn), r * std::sin(angle)});
    }
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1, c = i == 7 ? 1 : a + 2, d = i == 7 ? 0 : a + 3;
    strip.triangles.push_back({a, b, c});
    strip.triangles.push_back({b, d, c});
  }
  const MeshFacts facts = check_mesh(strip, "strip").facts;
  EXPECT_FALSE(facts.oriented || facts.has_sure_volume());
  EXPECT_TRUE(says(mesh_check_text(facts), "the surface has one side only")) << mesh_check_text(facts);
  EXPECT_TRUE(says(mesh_check_text(facts), "volume by its lattice."));
  EXPECT_FALSE(says(mesh_check_text(facts), "hole") || says(mesh_check_text(facts), "turned")) << mesh_check_text(facts);
}

TEST(MeshCheck, BoxesThatShareAnEdgeAreNotManifold) {
  const MeshFacts facts = check_mesh(joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 1, 0}, {2, 2, 1})), "two").facts;
  EXPECT_EQ(facts.non_manifold_edges, 1u);
  EXPECT_TRUE(facts.closed);
  EXPECT_TRUE(facts.oriented);
  EXPECT_NEAR(facts.volume, 2, 1e-12);
}

TEST(MeshCheck, AWallThatEndsWithinABodyIsNamed) {
  TriangleMesh mesh = cube();
  mesh.triangles.push_back({0, 2, 5});  // across the box, from three of its corners
  const MeshFacts facts = check_mesh(mesh, "box").facts;
  EXPECT_GT(facts.odd_edges, 0u);
  EXPECT_FALSE(facts.closed || facts.has_sure_volume());
  const std::string text = mesh_check_text(facts);
  EXPECT_TRUE(says(text, "of three triangles or more a wall or a fin ends on the body")) << text;
  EXPECT_GT(facts.open_edges, 0u);
  EXPECT_FALSE(says(text, "hole")) << text;
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
}

TEST(MeshCheck, TheBackOfATwoSidedSurfaceIsLeftOut) {
  const CheckedMesh whole = check_mesh(two_sided(cube()), "cup");
  EXPECT_EQ(whole.facts.back_triangles, 12u);
  EXPECT_TRUE(whole.facts.closed && whole.facts.oriented);
  EXPECT_NEAR(whole.facts.volume, 0.006, 1e-17);
  EXPECT_TRUE(says(mesh_check_text(whole.facts), "12 triangles lay upon others that face the other way and were left out."));
  // some faces have no back, and of some only the back is left
  TriangleMesh most = two_sided(cube());
  most.triangles.erase(most.triangles.begin() + 15, most.triangles.begin() + 18);
  most.triangles.erase(most.triangles.begin() + 7);
  const CheckedMesh partly = check_mesh(most, "cup");
  EXPECT_EQ(partly.mesh.triangles.size(), 12u);
  EXPECT_EQ(partly.facts.back_triangles, 8u);
  EXPECT_NEAR(partly.facts.volume, 0.006, 1e-17);
  // quads whose back is cut along the other diagonal, as its corners are written from the last to the first
  TriangleMesh quads = cube();
  for (std::size_t i = 0; i < 12; i += 2) {
    const auto [a, b, c] = quads.triangles[i];
    const std::uint32_t d = quads.triangles[i + 1][2];
    quads.triangles.push_back({d, c, b});
    quads.triangles.push_back({d, b, a});
  }
  const CheckedMesh cut = check_mesh(quads, "quads");
  EXPECT_EQ(cut.facts.back_triangles, 12u);
  EXPECT_NEAR(cut.facts.volume, 0.006, 1e-17);
  // a bowl without thickness keeps its mouth
  const CheckedMesh bowl = check_mesh(two_sided(open_hemisphere(0.1, 3)), "bowl");
  EXPECT_EQ(bowl.facts.open_edges, 32u);
  EXPECT_NEAR(bowl.facts.volume, check_mesh(open_hemisphere(0.1, 3), "bowl").facts.volume, 1e-15);
}

TEST(MeshCheck, AFlatSheetWithTwoSidesLeavesAClosedMeshClosed) {
  const TriangleMesh label = two_sided({{{0.2, 0, 0}, {0.2, 0.1, 0}, {0.2, 0.1, 0.1}, {0.2, 0, 0.1}, {0.2, 0.05, 0.05}},
                                        {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}});
  const MeshFacts facts = check_mesh(joined(cube(), label), "labeled").facts;
  EXPECT_EQ(facts.back_triangles + facts.turned_triangles, 0u);
  EXPECT_TRUE(facts.closed && facts.oriented);
  EXPECT_NEAR(facts.volume, 0.006, 1e-17);
}

TEST(MeshCheck, TheFaceBetweenBodiesThatTouchStays) {
  const TriangleMesh two = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 0, 0}, {2, 1, 1}));
  const MeshFacts facts = check_mesh(two, "two").facts;
  EXPECT_EQ(facts.back_triangles, 0u);
  EXPECT_TRUE(facts.closed && facts.oriented);
  EXPECT_NEAR(facts.volume, 2, 1e-12);
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
  EXPECT_TRUE(says(mesh_check_text(bowl), "1 hole, up to 141.4 mm across, which close_holes = true closes.")) << "flat";
  // and one that is not, of the same size up and down
  const MeshFacts wavy = check_mesh(joined(open_hemisphere(0.05, 4), wavy_bowl(0.03, 4, 0.01)), "bowls").facts;
  EXPECT_TRUE(says(mesh_check_text(wavy),
                   "2 holes, up to 141.4 mm across, which close_holes does not close, as 1, up to 87.18 mm across, is neither flat "
                   "nor small: close them"))
      << mesh_check_text(wavy);
}

// A ball with a hole of one triangle, and a triangle that stands on an edge.
TriangleMesh ball_with_a_fin() {
  TriangleMesh ball = icosphere(0.05, 4);
  ball.triangles.pop_back();
  const auto [a, b, c] = ball.triangles.front();
  ball.vertices.push_back({0.06, 0.06, 0.06});
  ball.triangles.push_back({a, b, static_cast<std::uint32_t>(ball.vertices.size() - 1)});
  return ball;
}

// A small hole beside edges that form no loop: what the note says is what close_holes does.
TEST(MeshCheck, WhatCannotBeClosedIsNotOffered) {
  const TriangleMesh ball = ball_with_a_fin();
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

TEST(MeshCheck, ClosingHolesWithoutAnyIsSaid) {
  EXPECT_TRUE(says(mesh_check_text(check_mesh(cube(), "box", true).facts), "close_holes closes nothing: no edge is open."));
  EXPECT_FALSE(says(mesh_check_text(check_mesh(cube(), "box").facts), "close_holes"));
}

TEST(MeshCheck, LargeHolesThatAreNotFlatAreRefusedWithNumberAndSize) {
  const auto line = [](const TriangleMesh& mesh) -> std::string {
    try {
      check_mesh(mesh, "bowl.stl", true);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return error.what();
    }
    return "closed";
  };
  const std::string bowl = line(wavy_bowl(0.05, 4, 0.01));
  EXPECT_TRUE(says(bowl, "bowl.stl: close_holes: 1 of 1 hole is neither flat nor small, up to 142.8 mm across and 32")) << bowl;
  EXPECT_TRUE(says(bowl, "at most 10 and 40 mm are closed: close it where the mesh was made")) << bowl;
  const TriangleMesh both = joined(wavy_bowl(0.05, 4, 0.01), placed_mesh(wavy_bowl(0.05, 4, 0.01), {}, {0.2, 0, 0}));
  const std::string bowls = line(joined(both, placed_mesh(open_hemisphere(0.05, 4), {}, {0.4, 0, 0})));
  EXPECT_TRUE(says(bowls, "close_holes: 2 of 3 holes are neither flat nor small, up to 142.8 mm across")) << bowls;
  EXPECT_TRUE(says(bowls, "close them where the mesh was made")) << bowls;
  const std::string fin = line(ball_with_a_fin());
  EXPECT_TRUE(says(fin, "bowl.stl: close_holes: 2 open edges form no loop, as a surface meets others there")) << fin;
  EXPECT_EQ(line(icosphere(0.05, 4)), "closed");
  EXPECT_EQ(line(open_hemisphere(0.05, 4)), "closed");
}

}  // namespace
}  // namespace wholehand
