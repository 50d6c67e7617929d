// SPDX-License-Identifier: MIT
// Normals of mesh vessels: smooth where the surface is, split where it is sharp.
#include "sweeps/grips/mesh_surface.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

// The same triangles in the same places, with unit normals.
void expect_same_triangles(const SurfaceMesh& surface, const MeshBody& body) {
  ASSERT_EQ(surface.triangles.size(), 3 * body.triangles.size());
  ASSERT_EQ(surface.positions.size(), surface.normals.size());
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    ASSERT_LT(surface.triangles[i], surface.positions.size());
    ASSERT_EQ(surface.positions[surface.triangles[i]], body.vertices[body.triangles[i / 3][i % 3]]);
  }
  for (const Triple& n : surface.normals) ASSERT_NEAR(dot(n, n), 1, 1e-12);
}

TEST(MeshSurface, ASphereIsSmooth) {
  const MeshBody body = body_of(icosphere(0.05, 4));
  const SurfaceMesh surface = mesh_surface(body);
  expect_same_triangles(surface, body);
  EXPECT_EQ(surface.positions.size(), body.vertices.size());
  // means of faces that lean to all sides by up to 1.4 / 16 / sqrt(3) = 0.0505 rad: to first order they cancel, and 0.0505^2 =
  // 2.6e-3; no corner is quite regular
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
    ASSERT_GT(dot(surface.normals[i], surface.positions[i]) / 0.05, std::cos(3e-3));
}

// Weighted by angles, the two triangles of a field do not pull the normal to their side.
TEST(MeshSurface, ATorusIsSmooth) {
  const MeshBody body = body_of(torus(0.05, 0.02, 120, 60));
  const SurfaceMesh surface = mesh_surface(body);
  EXPECT_EQ(surface.positions.size(), body.vertices.size());
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Triple& p = surface.positions[i];
    const double r = std::hypot(p[0], p[2]), inward = 0.05 / r;
    const Triple n{(p[0] - inward * p[0]) / 0.02, p[1] / 0.02, (p[2] - inward * p[2]) / 0.02};
    ASSERT_GT(dot(surface.normals[i], n), std::cos(3e-3));  // (3 degrees)^2
  }
}

TEST(MeshSurface, ABoxHasThreeNormalsInEachCorner) {
  const MeshBody body = body_of(box_mesh({0, 0, 0}, {1, 2, 3}));
  const SurfaceMesh surface = mesh_surface(body);
  expect_same_triangles(surface, body);
  EXPECT_EQ(surface.positions.size(), 24u);
  for (const Triple& n : surface.normals) EXPECT_NEAR(std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}), 1, 1e-12);
}

TEST(MeshSurface, ABeakerIsSplitRoundItsBaseAndMouth) {
  const int around = 48;
  const MeshBody body = body_of(turned_mesh(beaker1(), around, 5e-3));
  const SurfaceMesh surface = mesh_surface(body);
  expect_same_triangles(surface, body);
  EXPECT_EQ(surface.positions.size(), body.vertices.size() + 2 * around);
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Triple &p = surface.positions[i], &n = surface.normals[i];
    if (std::abs(n[1]) > 0.5) {
      ASSERT_NEAR(n[1], p[1] > 0.05 ? 1 : -1, 1e-12);
    } else {
      ASSERT_NEAR((n[0] * p[0] + n[2] * p[2]) / 0.04, 1, 1e-12);  // its two faces lean alike to either side
    }
  }
}

TEST(MeshSurface, OpenAndDegenerateOnesHaveNormalsToo) {
  MeshBody body = body_of(open_hemisphere(0.05, 2));
  body.triangles.push_back({0, 1, 0});  // without area, of no neighbor
  const SurfaceMesh surface = mesh_surface(body);
  expect_same_triangles(surface, body);
}

}  // namespace
}  // namespace wholehand::sweeps
