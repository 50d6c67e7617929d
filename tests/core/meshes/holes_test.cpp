// SPDX-License-Identifier: MIT
// Holes: loops of open edges, their size and shape, and what closes them.
#include "core/meshes/holes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/meshes/check.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

// Closes every hole of a mesh that is 1 large.
void close_all(const MeshHoles& holes, TriangleMesh& mesh) {
  const HoleClosing closing = plan_closing(mesh, holes, 1);
  EXPECT_TRUE(closing.open.empty());
  close_holes(holes, closing, mesh);
}

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
  close_all(holes, mesh);
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
  close_all(holes, mesh);
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
  close_all(holes, mesh);
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

// ---- flat holes ----

using RimPoints = std::vector<std::array<double, 2>>;  // x, z

// A prism without a lid. The floor is a fan about the first point. A cavity faces inward.
TriangleMesh open_prism(const RimPoints& rim, double floor, double top, bool is_cavity = false) {
  TriangleMesh mesh;
  const auto count = static_cast<std::uint32_t>(rim.size());
  for (const double y : {floor, top})
    for (const auto& [x, z] : rim) mesh.vertices.push_back({x, y, z});
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    mesh.triangles.push_back({i, next, count + next});
    mesh.triangles.push_back({i, count + next, count + i});
    if (i > 0 && next > 0) mesh.triangles.push_back({0, next, i});
  }
  if (is_cavity)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

// The same without its floor.
TriangleMesh open_tube(const RimPoints& rim, double low, double high, bool is_cavity) {
  TriangleMesh mesh = open_prism(rim, low, high, is_cavity);
  std::erase_if(mesh.triangles, [&](const Corners& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t corner) { return corner < rim.size(); });
  });
  return mesh;
}

// A regular polygon about (x, 0).
struct RegularRim {
  int sides;
  double radius, x = 0;

  RimPoints points() const {
    RimPoints rim;
    for (int i = 0; i < sides; ++i)
      rim.push_back({x + radius * std::sin(2 * PI * i / sides), radius * std::cos(2 * PI * i / sides)});
    return rim;
  }
  double area() const { return sides * radius * radius * std::sin(2 * PI / sides) / 2; }
  double length() const { return 2 * sides * radius * std::sin(PI / sides); }
};

RimPoints rectangle(double width, double depth) {
  return {{-width / 2, -depth / 2}, {-width / 2, depth / 2}, {width / 2, depth / 2}, {width / 2, -depth / 2}};
}

// The check with all holes closed, of which there are so many. A lid that overlapped itself or its walls would add to the area.
MeshFacts facts_of_closed(const TriangleMesh& mesh, std::size_t holes) {
  const MeshFacts facts = check_mesh(mesh, "mesh", true).facts;
  EXPECT_TRUE(facts.closed && facts.oriented);
  EXPECT_EQ(facts.open_edges + facts.non_manifold_edges + facts.zero_triangles, 0u);
  EXPECT_EQ(facts.closed_holes, holes);
  return facts;
}

constexpr double HOLE_ROUNDING = 1e-12;  // relative, of sums over some hundred triangles

TEST(MeshHoles, ACylinderGetsItsLid) {
  constexpr RegularRim rim{64, 0.04};
  const TriangleMesh cup = open_prism(rim.points(), 0, 0.1);
  const MeshFacts facts = facts_of_closed(cup, 1);
  EXPECT_NEAR(facts.volume / (rim.area() * 0.1), 1, HOLE_ROUNDING);
  EXPECT_NEAR(facts.area / (2 * rim.area() + rim.length() * 0.1), 1, HOLE_ROUNDING);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(facts.center_of_mass[k], k == 1 ? 0.05 : 0, 1e-14);
  EXPECT_NEAR(facts.widest_closed_hole, std::hypot(0.08, 0.08), 1e-15);
  EXPECT_NEAR(facts_of_closed(placed_mesh(cup, {0.3, 0.2, 0.1}, {1, 2, 3}), 1).volume / (rim.area() * 0.1), 1, 1e-10)
      << "moved: the corners are rounded where they are 3 m off";
}

// The middle of the corners of an L is its inner corner, from which no fan fills it.
TEST(MeshHoles, AnLGetsALidOfItsOwnCorners) {
  const RimPoints ell{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const Triple& turn : {Triple{}, Triple{0.3, 0.2, 0.1}}) {
    const TriangleMesh mesh = placed_mesh(open_prism(ell, 0, 3), turn, {});
    const MeshFacts facts = facts_of_closed(mesh, 1);
    EXPECT_NEAR(facts.volume, 9, 1e-12);
    EXPECT_NEAR(facts.area, 3 + 3 + 8 * 3, 1e-12);
    const CheckedMesh checked = check_mesh(mesh, "ell", true);
    EXPECT_EQ(checked.mesh.vertices.size(), mesh.vertices.size());
    EXPECT_EQ(checked.mesh.triangles.size(), mesh.triangles.size() + 4);
  }
}

TEST(MeshHoles, ADoubleWallIsClosedBetweenItsRims) {
  constexpr RegularRim outer{48, 0.04}, inner{30, 0.036};
  const TriangleMesh wall = open_prism(outer.points(), 0, 0.1), cavity = open_prism(inner.points(), 0.005, 0.1, true);
  const double volume = outer.area() * 0.1 - inner.area() * 0.095;
  const double area = outer.area() + outer.length() * 0.1 + inner.area() + inner.length() * 0.095 + outer.area() - inner.area();
  for (const TriangleMesh& mesh : {joined(wall, cavity), joined(cavity, wall)}) {
    const MeshFacts facts = facts_of_closed(mesh, 2);
    EXPECT_NEAR(facts.volume / volume, 1, HOLE_ROUNDING);
    EXPECT_NEAR(facts.area / area, 1, HOLE_ROUNDING);
  }
  const TriangleMesh pipe = joined(open_tube(outer.points(), 0, 0.1, false), open_tube(inner.points(), 0, 0.1, true));
  EXPECT_NEAR(facts_of_closed(pipe, 4).volume / ((outer.area() - inner.area()) * 0.1), 1, HOLE_ROUNDING);
}

TEST(MeshHoles, RimsThatFaceTheSameWayGetALidEach) {
  constexpr RegularRim outer{48, 0.04}, inner{30, 0.036};
  const TriangleMesh nested = joined(open_prism(outer.points(), 0, 0.1), open_prism(inner.points(), 0.005, 0.1));
  EXPECT_NEAR(facts_of_closed(nested, 2).volume / (outer.area() * 0.1 + inner.area() * 0.095), 1, HOLE_ROUNDING) << "two bodies";
}

TEST(MeshHoles, CavitiesSideBySideAndAPostInOneShareALid) {
  constexpr RegularRim left{24, 0.035, -0.05}, right{31, 0.04, 0.05}, post{12, 0.01, 0.05};
  TriangleMesh block = open_prism(rectangle(0.2, 0.1), 0, 0.1);
  block = joined(block, open_prism(left.points(), 0.02, 0.1, true));
  block = joined(block, open_prism(right.points(), 0.01, 0.1, true));
  block = joined(block, open_prism(post.points(), 0.03, 0.1));
  const double volume = 0.2 * 0.1 * 0.1 - left.area() * 0.08 - right.area() * 0.09 + post.area() * 0.07;
  EXPECT_NEAR(facts_of_closed(block, 4).volume / volume, 1, HOLE_ROUNDING);
  EXPECT_NEAR(facts_of_closed(placed_mesh(block, {1, -0.4, 2}, {}), 4).volume / volume, 1, HOLE_ROUNDING);
}

// A thin cup whose wall has a hole, too.
TEST(MeshHoles, AFlatHoleBesideASmallOneThatIsNotFlat) {
  constexpr RegularRim rim{32, 0.01};
  TriangleMesh cup = open_prism(rim.points(), 0, 0.002);
  for (int row = 1; row < 50; ++row) cup = joined(cup, open_tube(rim.points(), 0.002 * row, 0.002 * (row + 1), false));
  // three fields up and three around
  std::erase_if(cup.triangles, [&](const Corners& triangle) {
    Triple middle{};
    for (const std::uint32_t corner : triangle)
      for (int k = 0; k < 3; ++k) middle[k] += cup.vertices[corner][k] / 3;
    const double turns = std::atan2(middle[0], middle[2]) / (2 * PI);
    return middle[1] > 0.04 && middle[1] < 0.046 && turns > 0 && turns < 3.0 / 32;
  });
  const CheckedMesh open = check_mesh(cup, "cup");
  const MeshHoles holes = find_holes(open.mesh);
  ASSERT_EQ(holes.loops.size(), 2u);
  EXPECT_EQ(is_flat_hole(holes.loops[0], 0.1) + is_flat_hole(holes.loops[1], 0.1), 1);
  EXPECT_EQ(is_small_hole(holes.loops[0], 0.1) + is_small_hole(holes.loops[1], 0.1), 1);
  const MeshFacts facts = facts_of_closed(cup, 2);
  EXPECT_NEAR(facts.widest_closed_hole, std::hypot(0.02, 0.02), 1e-12);
  // the fan over the hole of 6 mm and 34 degrees lies inside the wall by at most the height of such an arc
  const double whole = rim.area() * 0.1;
  EXPECT_LT(facts.volume, whole);
  EXPECT_GT(facts.volume, whole - 0.006 * 0.006 * 0.01 * (1 - std::cos(radians(17))));
}

TEST(MeshHoles, FlatIsAThousandthOffThePlane) {
  RimPoints square = rectangle(1, 1);
  TriangleMesh box = open_prism(square, 0, 1);
  // opposite corners up, the others down: each is off the plane by this
  const auto hole_of = [&](double wave) {
    for (std::uint32_t i = 4; i < 8; ++i) box.vertices[i][1] = 1 + (i % 2 == 0 ? wave : -wave);
    return find_holes(box).loops.at(0);
  };
  EXPECT_NEAR(hole_of(0.02).off_plane, 0.02, 1e-15);
  EXPECT_TRUE(is_flat_hole(hole_of(0.99e-3), 1));
  EXPECT_FALSE(is_flat_hole(hole_of(1.01e-3), 1));
  EXPECT_TRUE(is_flat_hole(hole_of(1.01e-3), 1.1));
}

// A U that no fan fills, whose sides have so many corners each.
RimPoints u_shape(int per_side, double x) {
  const RimPoints corners{{0, 0}, {0, 3}, {1, 3}, {1, 1}, {2, 1}, {2, 3}, {3, 3}, {3, 0}};
  RimPoints rim;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (int k = 0; k < per_side; ++k) {
      const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
      const double t = static_cast<double>(k) / per_side;
      rim.push_back({x + a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
    }
  return rim;
}

// Open prisms of that shape, side by side, and how their holes are closed.
HoleClosing closing_of(const std::vector<int>& per_side) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < per_side.size(); ++i)
    mesh = joined(mesh, open_prism(u_shape(per_side[i], 4.0 * static_cast<double>(i)), 0, 1));
  return plan_closing(mesh, find_holes(mesh), 4.0 * static_cast<double>(per_side.size()));
}

// Cutting takes time as the square of a polygon's corners, so that the squares of all count together.
TEST(MeshHoles, TheCornersOfAllCutHolesAreBounded) {
  constexpr int WHOLE = static_cast<int>(MOST_CUT_CORNERS) / 8, MOST = WHOLE * 7 / 10;  // 0.7^2 twice is less than 1
  const auto expect_closing = [](const std::vector<int>& per_side, std::size_t cut, const char* what) {
    const HoleClosing closing = closing_of(per_side);
    EXPECT_EQ(closing.polygons.size(), cut) << what;
    EXPECT_EQ(closing.open.size(), per_side.size() - cut) << what;
  };
  expect_closing({WHOLE}, 1, "the most corners that one may have");
  expect_closing({WHOLE + 1}, 0, "more");
  expect_closing({MOST, MOST}, 2, "two");
  expect_closing({MOST, MOST, MOST}, 2, "three");
  expect_closing({MOST, WHOLE / 3, MOST}, 2, "what is left does not do for a third of them");
  expect_closing(std::vector<int>(40, WHOLE / 20), 40, "many small ones, of twice as many corners in all");
}

// The mean of the outer rim's corners lies at one end, as far from the inner rim as the box about the outer one is long.
TEST(MeshHoles, AHoleFarFromTheMeanOfTheCornersAroundItIsWithin) {
  constexpr int LEFT = 1000;
  RimPoints outer;
  for (int k = 0; k < LEFT; ++k) outer.push_back({0, 0.1 * k / LEFT});
  outer.insert(outer.end(), {{0, 0.1}, {1, 0.1}, {1, 0}});
  const RimPoints inner{{0.9, 0.04}, {0.9, 0.06}, {0.99, 0.06}, {0.99, 0.04}};
  const TriangleMesh mesh = joined(open_tube(outer, 0, 0.1, false), open_tube(inner, 0, 0.1, true));
  const MeshFacts facts = facts_of_closed(mesh, 4);
  EXPECT_NEAR(facts.volume, 0.1 * (1 * 0.1 - 0.09 * 0.02), HOLE_ROUNDING);
  EXPECT_NEAR(facts.area, 2 * (1 * 0.1 - 0.09 * 0.02) + 0.1 * (2 * 1.1 + 2 * 0.11), HOLE_ROUNDING);
}

// All corners on one line have no plane; they are closed as other small holes are.
TEST(MeshHoles, ACrackIsClosedWhereItIsSmall) {
  MeshHole crack;
  crack.corners = {0, 1, 2};
  crack.across = crack.length = 0.05;
  EXPECT_FALSE(is_flat_hole(crack, 1));
  EXPECT_TRUE(is_small_hole(crack, 1));
}

}  // namespace
}  // namespace wholehand
