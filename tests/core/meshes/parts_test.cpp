// SPDX-License-Identifier: MIT
// The parts of a mesh: what belongs together, and how the parts are numbered.
#include "core/meshes/parts.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "core/meshes/check.h"
#include "tests/support/gltf_making.h"
#include "tests/support/mesh_faults.h"
#include "tests/support/meshes.h"
#include "tests/support/vessel_models.h"
#include "tests/support/vessel_profiles.h"

namespace wholehand {
namespace {

std::vector<std::size_t> sizes(const MeshParts& parts) {
  std::vector<std::size_t> triangles;
  for (const MeshPart& part : parts.parts) triangles.push_back(part.triangles);
  return triangles;
}

std::vector<std::size_t> sizes_of_parts(const TriangleMesh& mesh) { return sizes(find_parts(mesh)); }

// A box whose faces split along the diagonals that box_mesh does not take.
TriangleMesh box_of_other_diagonals(const Triple& low, const Triple& high) {
  TriangleMesh box = box_mesh({-high[0], low[1], low[2]}, {-low[0], high[1], high[2]});
  for (Triple& vertex : box.vertices) vertex[0] = -vertex[0];
  return inside_out(box);
}

// Many tetrahedra apart from each other, of different sizes and some of one.
TriangleMesh crumbs(int count) {
  TriangleMesh mesh;
  std::mt19937 random(5);
  for (int k = 0; k < count; ++k) {
    const double size = 1 + static_cast<double>(random() % 7), x = 10.0 * (k % 20), y = 10.0 * (k / 20 % 20), z = 10.0 * (k / 400);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Triple& p : {Triple{x, y, z}, {x + size, y, z}, {x, y + size, z}, {x, y, z + size}}) mesh.vertices.push_back(p);
    for (const Corners& t : {Corners{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

TEST(MeshParts, AMeshOfOneBodyIsOnePart) {
  const MeshParts parts = find_parts(unjoined(box_mesh({0, 0, 0}, {1, 2, 3})));
  ASSERT_EQ(parts.parts.size(), 1u);
  EXPECT_EQ(parts.parts[0].triangles, 12u);
  EXPECT_EQ(parts.parts[0].low, (Triple{0, 0, 0}));
  EXPECT_EQ(parts.parts[0].high, (Triple{1, 2, 3}));
}

TEST(MeshParts, ACupAndItsSaucerAreTwo) {
  const VesselModel& model = vessel_model("cup_and_saucer");
  const MeshParts parts = find_parts(model.mesh);
  ASSERT_EQ(parts.parts.size(), 2u);
  const int cup = parts.parts[0].triangles == model.vessel_triangles ? 1 : 2;
  const TriangleMesh alone = parts_alone(model.mesh, parts, std::span(&cup, 1));
  ASSERT_EQ(alone.triangles.size(), model.vessel_triangles);
  EXPECT_TRUE(std::equal(alone.triangles.begin(), alone.triangles.end(), model.mesh.triangles.begin()));
  EXPECT_FALSE(reaches_into(model.mesh, parts, 3 - cup, cup));
  EXPECT_FALSE(reaches_into(model.mesh, parts, cup, 3 - cup));
}

TEST(MeshParts, TheVoidOfADoubleWallBelongsToItsCup) { EXPECT_EQ(find_parts(vessel_model("thermos_cup").mesh).parts.size(), 1u); }

// Upright lines through the middles of a square's halves, and through its corners, meet edges that triangles of the outer box share.
TEST(MeshParts, TheVoidOfASquareBodyBelongsToIt) {
  for (const double inset : {1.0, 2.0, 3.0, 0.5}) {
    const Triple low{inset, inset, inset}, high{12 - inset, 12 - inset, 12 - inset};
    const std::vector<TriangleMesh> outers{box_mesh({0, 0, 0}, {12, 12, 12}), box_of_other_diagonals({0, 0, 0}, {12, 12, 12})},
        voids{inside_out(box_mesh(low, high)), inside_out(box_of_other_diagonals(low, high))};
    for (const TriangleMesh& outer : outers)
      for (const TriangleMesh& gap : voids) {
        EXPECT_EQ(sizes_of_parts(joined(outer, gap)), std::vector<std::size_t>{24}) << inset;
        EXPECT_EQ(sizes_of_parts(joined(gap, two_sided(outer))), std::vector<std::size_t>{36}) << "each wall counts once";
      }
  }
}

// A cube that stands on another one, one that lies half in it, and one within the box of a ring but not in the ring.
TEST(MeshParts, WhatIsNotEnclosedIsAPartOfItsOwn) {
  const TriangleMesh box = box_mesh({0, 0, 0}, {12, 12, 12});
  EXPECT_EQ(sizes_of_parts(joined(box, box_mesh({2, 12, 2}, {4, 14, 4}))).size(), 2u);
  EXPECT_EQ(sizes_of_parts(joined(box, box_mesh({11, 2, 2}, {14, 4, 4}))).size(), 2u);
  EXPECT_EQ(sizes_of_parts(joined(torus(0.05, 0.02, 40, 20), box_mesh({-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}))).size(), 2u);
}

TEST(MeshParts, PartsAreNumberedBySize) {
  const TriangleMesh mesh = joined(joined(box_mesh({50, 0, 0}, {51, 1, 1}), box_mesh({-9, 0, 0}, {-8, 1, 1})), icosphere(4, 2));
  const MeshParts parts = find_parts(mesh);
  EXPECT_EQ(sizes(parts), (std::vector<std::size_t>{320, 12, 12}));
  EXPECT_EQ(parts.parts[1].low, (Triple{-9, 0, 0})) << "of equal ones the first by where it lies";
  EXPECT_EQ(parts.of_triangle[0], 2u);
  EXPECT_EQ(parts.of_triangle[12], 1u);
}

TEST(MeshParts, NumbersAreThoseOfEveryUnit) {
  const TriangleMesh mesh = crumbs(1000);
  const std::vector<std::uint32_t> numbers = find_parts(mesh).of_triangle;
  for (const double unit : {1e-3, 0.0254, 0.3048, 1000.0, 1.0 / 3}) {
    TriangleMesh scaled = mesh, single = mesh;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      for (int k = 0; k < 3; ++k) {
        scaled.vertices[v][k] *= unit;
        single.vertices[v][k] = static_cast<float>(unit * mesh.vertices[v][k]);
      }
    EXPECT_EQ(find_parts(scaled).of_triangle, numbers) << unit;
    EXPECT_EQ(find_parts(single).of_triangle, numbers) << unit;
  }
}

// Triangles that are points or edges lead from one body to the next; a check drops them.
TEST(MeshParts, NumbersAreThoseOfTheCheckedMesh) {
  TriangleMesh strip = crumbs(50);
  for (std::uint32_t body = 0; body + 1 < 50; ++body) {
    strip.triangles.push_back({4 * body, 4 * body, 4 * body + 4});
    strip.triangles.push_back({4 * body + 4, 4 * body + 4, 4 * body + 4});
  }
  strip = unjoined(strip);
  std::mt19937 random(7);
  std::shuffle(strip.triangles.begin(), strip.triangles.end(), random);
  const MeshParts raw = find_parts(strip), checked = find_parts(check_mesh(strip, "strip").mesh);
  ASSERT_EQ(raw.parts.size(), 50u);
  ASSERT_EQ(checked.parts.size(), 50u);
  for (std::size_t k = 0; k < 50; ++k) {
    EXPECT_EQ(raw.parts[k].low, checked.parts[k].low) << k;
    EXPECT_EQ(raw.parts[k].high, checked.parts[k].high) << k;
    EXPECT_EQ(raw.parts[k].triangles, checked.parts[k].triangles) << k;
  }
  EXPECT_EQ(std::count(raw.of_triangle.begin(), raw.of_triangle.end(), NO_PART), 98);
  const std::vector<int> first_two{1, 2};
  EXPECT_EQ(parts_alone(strip, raw, first_two).triangles.size(), 8u);
}

TEST(MeshParts, AHandleReachesIntoTheWall) {
  const VesselModel& model = vessel_model("mug_with_handle");
  const MeshParts parts = find_parts(model.mesh);
  ASSERT_EQ(parts.parts.size(), 2u);
  EXPECT_TRUE(reaches_into(model.mesh, parts, 2, 1));
}

// A bar of twelve triangles: the middles of its triangles lie outside the wall, and the corners at one end within it.
TEST(MeshParts, AHandleOfFewTrianglesReachesIntoTheWall) {
  const TriangleMesh cup =
      walled_mesh(TurnedProfile(0, 0).line(40, 0).line(40, 90).points(), TurnedProfile(0, 5).line(36, 5).line(36, 90).points(), 64);
  const auto with_bar = [&](double start) { return joined(cup, box_mesh({start, 0.040, -0.002}, {0.120, 0.044, 0.002})); };
  for (const double start : {0.037, 0.038, 0.039}) {
    const TriangleMesh mesh = with_bar(start);
    const MeshParts parts = find_parts(mesh);
    ASSERT_EQ(parts.parts.size(), 2u);
    EXPECT_TRUE(reaches_into(mesh, parts, 2, 1)) << start;
    EXPECT_FALSE(reaches_into(mesh, parts, 1, 2)) << start;
  }
  const TriangleMesh apart = with_bar(0.041);
  EXPECT_FALSE(reaches_into(apart, find_parts(apart), 2, 1));
}

TEST(MeshParts, ACupThatTouchesItsSaucerDoesNotReachIntoIt) {
  const TriangleMesh mesh = joined(box_mesh({0, 0, 0}, {10, 1, 10}), box_mesh({3, 1, 3}, {6, 5, 6}));
  const MeshParts parts = find_parts(mesh);
  ASSERT_EQ(parts.parts.size(), 2u);
  EXPECT_FALSE(reaches_into(mesh, parts, 2, 1));
  EXPECT_FALSE(reaches_into(mesh, parts, 1, 2));
}

// In a box that contains them all, which makes each one a candidate: some of them lie within its walls.
TEST(MeshParts, ThousandsOfPartsTakeLittleTime) {
  constexpr double MOST_SECONDS = 10;  // a hundredth of it is enough
  TriangleMesh mesh = crumbs(5000);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(find_parts(mesh).parts.size(), 5000u);
  mesh = joined(mesh, icosphere(400, 5));
  const MeshParts parts = find_parts(mesh);
  EXPECT_EQ(parts.parts.size(), 1u) << "all lie within the sphere";
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), MOST_SECONDS);
}

// ---- in a file ----

TriangleMesh three_boxes() {
  return joined(joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({5, 0, 0}, {8, 3, 3})), box_mesh({20, 0, 0}, {22, 2, 2}));
}

double largest_x(const TriangleMesh& mesh) {
  double largest = -1;
  for (const Corners& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) largest = std::max(largest, mesh.vertices[corner][0]);
  return largest;
}

TEST(MeshParts, AFileIsReadWithThePartsOfTheScene) {
  for (const auto& [name, bytes] : {std::pair("parts.glb", glb_text(three_boxes())), {"parts.stl", stl_text(three_boxes())}}) {
    MeshData data = mesh_as_is(write_gltf(name, bytes));
    EXPECT_EQ(read_mesh(data, "").triangles.size(), 36u);
    for (const auto& [part, end] : {std::pair(1, 8.0), {2, 22.0}, {3, 1.0}}) {
      data.parts = {part};
      const TriangleMesh mesh = read_mesh(data, "");
      EXPECT_EQ(mesh.triangles.size(), 12u);
      EXPECT_EQ(largest_x(mesh), end) << name << part;
    }
    data.parts = {3, 1};
    const TriangleMesh backward = read_mesh(data, "");
    data.parts = {1, 3, 1};
    EXPECT_EQ(backward.triangles, read_mesh(data, "").triangles) << "the order of the numbers does not matter";
    EXPECT_EQ(backward.triangles.size(), 24u);
    EXPECT_EQ(largest_x(backward), 8);
  }
}

// The bounding box that stands on the origin is that of the parts.
TEST(MeshParts, PartsAreTakenBeforeTheMeshIsPlaced) {
  MeshData data = mesh_as_is(write_gltf("parts.glb", glb_text(three_boxes())));
  data.parts = {2};
  data.origin_at_base = true;
  EXPECT_EQ(largest_x(read_mesh(data, "")), 1);
}

TEST(MeshParts, APartThatIsNotThereIsRefused) {
  MeshData data = mesh_as_is(write_gltf("parts.glb", glb_text(three_boxes())));
  data.parts = {1, 4};
  EXPECT_SAYS(mesh_refusal(data), "part = 4: it has 3 parts, numbered from 1, the largest first");
  data.file = write_gltf("one.glb", glb_text(box_mesh({0, 0, 0}, {1, 1, 1})));
  data.parts = {2};
  EXPECT_SAYS(mesh_refusal(data), "part = 2: it has 1 part, numbered from 1");
}

}  // namespace
}  // namespace wholehand
