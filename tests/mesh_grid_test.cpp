// sanitizers: address
// (Embree starts workers that the thread sanitizer cannot see into, and then reports what they were given.)
// Lattices of distances to meshes: what lies in them, how far they err, and when they are refused.
#include "sweeps/mesh_grid.h"

#include <gtest/gtest.h>

#include <array>

#include "core/error.h"
#include "core/sdf.h"
#include "sweeps/mesh_distance.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

constexpr double ROUNDING = 1e-15;  // m: double precision of some 10 cm

core_f64::Vessel kernel_grid(const PreparedGrid& grid) {
  core_f64::Vessel vessel;
  vessel.is_grid = true;
  vessel.grid = {
      {grid.origin[0], grid.origin[1], grid.origin[2]}, grid.spacing, grid.nx, grid.ny, grid.nz, grid.halves, grid.words};
  return vessel;
}

TEST(MeshGrid, SamplesAreDistancesWhereTheyShouldBe) {
  const CheckedMesh mesh = check_mesh(placed_mesh(torus(0.05, 0.02, 60, 30), {0.3, 0, 0}, {0.01, 0.02, 0.03}), "torus");
  const MeshDistance distance(mesh);
  for (const bool halves : {false, true}) {
    GridWish wish;
    wish.spacing = 5e-3;
    wish.margin = 8e-3;
    wish.halves = halves;
    const PreparedGrid grid = grid_of_mesh(distance, mesh, wish).grid;
    EXPECT_EQ(grid.spacing, wish.spacing);
    const core_f64::Vessel vessel = kernel_grid(grid);
    const std::array<int, 3> counts{grid.nx, grid.ny, grid.nz};
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(grid.origin[k], mesh.facts.low[k] - 8e-3 - 2 * 5e-3, ROUNDING);
      EXPECT_GE(grid.origin[k] + (counts[k] - 1) * 5e-3, mesh.facts.high[k] + 8e-3 + 2 * 5e-3 - ROUNDING);
    }
    for (int k = 0; k < grid.nz; ++k)
      for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i) {
          const Triple p{grid.origin[0] + 5e-3 * i, grid.origin[1] + 5e-3 * j, grid.origin[2] + 5e-3 * k};
          // single precision of 0.1 m, or 11 bits of it
          ASSERT_NEAR(core_f64::grid_sample(vessel, i, j, k), distance.signed_distance(p), halves ? 4e-5 : 1e-8);
        }
  }
}

TEST(MeshGrid, AnOpenMeshKeepsItsSides) {
  const CheckedMesh mesh = check_mesh(open_hemisphere(0.05, 4), "bowl");
  const MeshDistance distance(mesh);
  GridWish wish;
  wish.spacing = 6e-3;
  const core_f64::Vessel vessel = kernel_grid(grid_of_mesh(distance, mesh, wish).grid);
  EXPECT_NEAR(core_f64::grid_distance(vessel, {0, 0.03, 0}), -0.02, 1e-3);
  EXPECT_NEAR(core_f64::grid_distance(vessel, {0, 0.055, 0}), 0.005, 1e-3);
}

TEST(MeshGrid, TheSpacingIsChosenByTheErrorAtTheSurface) {
  const CheckedMesh mesh = check_mesh(turned_mesh(beaker3(), 120, 2e-3), "flask");
  const MeshDistance distance(mesh);
  GridWish wish;
  wish.tolerance = 1e-3;
  const MeshGrid chosen = grid_of_mesh(distance, mesh, wish);
  EXPECT_LE(chosen.error, 1e-3);
  EXPECT_GT(chosen.error, 0.3e-3);  // not much finer than was asked for
  wish.spacing = 2 * chosen.grid.spacing;
  EXPECT_GT(grid_of_mesh(distance, mesh, wish).error, 1e-3);
}

TEST(MeshGrid, StaysWithinItsMemory) {
  const CheckedMesh mesh = check_mesh(turned_mesh(beaker1(), 60, 5e-3), "beaker");
  const MeshDistance distance(mesh);
  GridWish wish;
  wish.tolerance = 1e-9;
  wish.most_bytes = 200'000;
  const MeshGrid finest = grid_of_mesh(distance, mesh, wish);
  EXPECT_LE(4 * finest.grid.words->size(), 200'000u);
  EXPECT_GT(4 * finest.grid.words->size(), 80'000u);
  EXPECT_GT(finest.error, 1e-9);
  wish.spacing = 1e-3;
  EXPECT_THROW(grid_of_mesh(distance, mesh, wish), Error);
  wish.spacing = 1e-12;
  EXPECT_THROW(grid_of_mesh(distance, mesh, wish), Error);
  wish.spacing = 0;
  wish.most_bytes = 100;
  EXPECT_THROW(grid_of_mesh(distance, mesh, wish), Error);
}

TEST(MeshGrid, IsTheSameOnAnyNumberOfThreads) {
  const CheckedMesh mesh = check_mesh(torus(0.05, 0.02, 40, 20), "torus");
  const MeshDistance distance(mesh);
  GridWish wish;
  wish.spacing = 7.3e-3;
  wish.halves = true;
  wish.threads = 1;
  const MeshGrid one = grid_of_mesh(distance, mesh, wish);
  wish.threads = 5;
  const MeshGrid five = grid_of_mesh(distance, mesh, wish);
  EXPECT_EQ(*one.grid.words, *five.grid.words);
  EXPECT_EQ(one.error, five.error);
}

}  // namespace
}  // namespace wholehand
