// SPDX-License-Identifier: MIT
// The cavity that is found in a mesh is the one that it was made with, and its outline is nowhere in glass.
#include "core/meshes/cavity_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/meshes/distance.h"
#include "core/meshes/sheet.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/support/vessel_models.h"

namespace wholehand {
namespace {

// The vessel alone, with the holes of its file closed and a thickness where it has none.
CheckedMesh vessel_of(const VesselModel& model) {
  TriangleMesh alone = model.mesh;
  alone.triangles.resize(model.vessel_triangles);
  CheckedMesh mesh = check_mesh(alone, model.name);
  if (model.thickness > 0) return thickened(mesh, model.thickness, model.name);
  if (mesh.facts.closable) return check_mesh(alone, model.name, true);
  return mesh;
}

ProfilePoints drawn(const FoundCavity& cavity) {
  constexpr double SAGITTA = 2e-6, STEP = 0.5e-3;  // m
  const ProfilePoints corners = points_on(cavity.outline, SAGITTA);
  ProfilePoints points{corners.front()};
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const auto &a = corners[k - 1], &b = corners[k];
    const int steps = static_cast<int>(std::hypot(b[0] - a[0], b[1] - a[1]) / STEP) + 1;
    for (int step = 1; step <= steps; ++step)
      points.push_back({a[0] + (b[0] - a[0]) * step / steps, a[1] + (b[1] - a[1]) * step / steps});
  }
  return points;
}

// Deepest place of the outline in the mesh, m, by exact distances: at some azimuths that no facet prefers.
double depth_in_glass(const CheckedMesh& mesh, const FoundCavity& cavity) {
  const MeshDistance distance(mesh);
  const ProfilePoints points = drawn(cavity);
  double deepest = 0;
  constexpr int AZIMUTHS = 7;
  for (std::size_t k = 0; k + 1 < points.size(); k += 11)  // the brim itself lies on the rim
    for (int j = 0; j < AZIMUTHS; ++j) {
      const double azimuth = 2 * PI * (j + 0.3) / AZIMUTHS;
      const Triple p{cavity.axis[0] + points[k][0] * std::cos(azimuth), points[k][1],
                     cavity.axis[2] + points[k][0] * std::sin(azimuth)};
      deepest = std::max(deepest, -distance.signed_distance(p));
    }
  return deepest;
}

// An outline stays near its profile, and all of the profile near the outline.
void expect_near_profile(const FoundCavity& cavity, const VesselModel& model) {
  // facets of the mesh lie up to this within the smooth profile, which the outline follows to its tolerance
  const double facets = 45e-3 * (1 - std::cos(PI / 96));
  for (const ProfilePoint& p : drawn(cavity)) {
    // a floor that rises in the middle lies lower elsewhere, which is no outline's
    if (cavity.beneath > 0.01 * model.capacity && p[1] < cavity.floor + OUTLINE_TOLERANCE) continue;
    EXPECT_LT(distance_from(model.inner, p), OUTLINE_TOLERANCE + facets) << p[0] << " " << p[1];
  }
  const ProfilePoints outline = drawn(cavity);
  for (const ProfilePoint& p : model.inner)
    if (p[1] > cavity.floor + OUTLINE_TOLERANCE || cavity.beneath == 0) {
      EXPECT_LT(distance_from(outline, p), OUTLINE_TOLERANCE + facets) << p[0] << " " << p[1];
    }
}

class CavityOf : public testing::TestWithParam<const VesselModel*> {};

TEST_P(CavityOf, IsThatOfItsFormula) {
  const VesselModel& model = *GetParam();
  const CheckedMesh mesh = vessel_of(model);
  const CavitySearch search = find_cavity(mesh);
  if (!model.refusal.empty()) {
    EXPECT_FALSE(search.cavity.has_value());
    EXPECT_NE(search.refusal.find(model.refusal), std::string::npos) << search.refusal;
    return;
  }
  ASSERT_TRUE(search.cavity.has_value()) << search.refusal;
  const FoundCavity& cavity = *search.cavity;
  EXPECT_LT(std::hypot(cavity.axis[0], cavity.axis[2]), 0.1e-3);
  EXPECT_NEAR(cavity.brim, model.brim, 0.05e-3);  // of a facet's chord at a rounded rim
  EXPECT_NEAR(cavity.capacity, model.capacity, 0.01 * model.capacity);
  // a micrometer by the fit, and the profile's chords: (0.4 mm)^2 / 8 of a bend of 5 mm
  EXPECT_LT(depth_in_glass(mesh, cavity), 5e-6);
  // an outline that reaches a micrometer into the glass gains twice that share of its radius, 8 mm and more
  EXPECT_LE(cavity.outline.volume, cavity.capacity * (1 + 3e-4));
  if (!model.is_round) {
    EXPECT_GT(cavity.off_round, OUTLINE_TOLERANCE);
    return;
  }
  EXPECT_LT(cavity.off_round, OUTLINE_TOLERANCE);
  // no outline holds what lies beneath the floor's height on the axis
  EXPECT_NEAR(cavity.outline.volume + cavity.beneath, model.capacity, 0.01 * model.capacity);
  expect_near_profile(cavity, model);
}

// How often the ray from p along an axis meets the mesh.
int crossings(const TriangleMesh& mesh, const Triple& p, int axis, double sign) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  int count = 0;
  for (const Corners& triangle : mesh.triangles) {
    std::array<double, 3> turn{};
    for (int k = 0; k < 3; ++k) {
      const Triple &a = mesh.vertices[triangle[(k + 1) % 3]], &b = mesh.vertices[triangle[(k + 2) % 3]];
      turn[k] = (a[u] - p[u]) * (b[v] - p[v]) - (a[v] - p[v]) * (b[u] - p[u]);
    }
    if (std::min({turn[0], turn[1], turn[2]}) < 0 && std::max({turn[0], turn[1], turn[2]}) > 0) continue;
    double height = 0;
    for (int k = 0; k < 3; ++k) height += turn[k] * (mesh.vertices[triangle[k]][axis] - p[axis]);
    count += sign * height / (turn[0] + turn[1] + turn[2]) > 0 ? 1 : 0;
  }
  return count;
}

// A count of one random point in each of SIDE^3 cells of the mesh's box: it is in the cavity if it lies below the brim, not in glass, and walls are
// below it and on four sides. Cells at the surface, a fifth of all, leave a standard error of 0.3 %.
TEST(CavityFinder, CapacityIsThatOfAnIndependentCount) {
  constexpr int SIDE = 30;
  for (const char* name : {"straight_mug", "square_cup", "conical_tumbler"}) {
    const CheckedMesh mesh = vessel_of(vessel_model(name));
    const CavitySearch search = find_cavity(mesh);
    ASSERT_TRUE(search.cavity.has_value()) << name;
    std::mt19937_64 random(5);
    const Triple low = mesh.facts.low, size = mesh.facts.size();
    int inside = 0;
    for (int cell = 0; cell < SIDE * SIDE * SIDE; ++cell) {
      const std::array<int, 3> at{cell % SIDE, cell / SIDE % SIDE, cell / SIDE / SIDE};
      Triple p{};
      for (int k = 0; k < 3; ++k) p[k] = low[k] + size[k] * (at[k] + static_cast<double>(random() >> 11) * 0x1p-53) / SIDE;
      if (p[1] > search.cavity->brim || crossings(mesh.mesh, p, 1, -1) == 0 || crossings(mesh.mesh, p, 1, 1) % 2 == 1) continue;
      bool is_walled = true;
      for (const int axis : {0, 2})
        for (const double sign : {-1.0, 1.0}) is_walled = is_walled && crossings(mesh.mesh, p, axis, sign) > 0;
      inside += is_walled ? 1 : 0;
    }
    const double counted = size[0] * size[1] * size[2] * inside / (SIDE * SIDE * SIDE);
    EXPECT_NEAR(search.cavity->capacity, counted, 0.01 * counted) << name;
  }
}

// A hole of 0.9 x 0.4 mm, narrower than a step of the grid, keeps liquid in as far as the search sees, and is reported.
TEST(CavityFinder, RaysThroughAPinholeAreReported) {
  VesselData cup;
  cup.outline = {line_to(40, 0),    line_to(40, 50), line_to(40, 50.4), line_to(40, 95), line_to(36, 95),
                 line_to(36, 50.4), line_to(36, 50), line_to(36, 5),    line_to(0, 5)};
  TriangleMesh mesh = turned_mesh(cup, 256, 1e-3);
  std::erase_if(mesh.triangles, [&](const Corners& triangle) {
    Triple middle{};
    for (const std::uint32_t corner : triangle)
      for (int k = 0; k < 3; ++k) middle[k] += mesh.vertices[corner][k] / 3;
    return middle[1] > 50e-3 && middle[1] < 50.4e-3 && std::abs(std::atan2(middle[2], middle[0]) - 0.3) < PI / 256;
  });
  const CavitySearch search = find_cavity(check_mesh(mesh, "mug"));
  ASSERT_TRUE(search.cavity.has_value()) << search.refusal;
  EXPECT_GT(search.cavity->passing_rays, 0);
  EXPECT_NEAR(search.cavity->passing_height, 50.2e-3, 0.2e-3);
  const double volume = PI * 36 * 36 * 90 * 1e-9;
  EXPECT_NEAR(search.cavity->capacity, volume, 0.01 * volume);
}

TEST(CavityFinder, AShallowPlateHasItsDepth) {
  // a disk of 250 mm with a rim 6 mm above its floor
  VesselData plate;
  plate.outline = {line_to(125, 0), line_to(125, 10), line_to(120, 10), line_to(115, 4), line_to(0, 4)};
  const CavitySearch search = find_cavity(check_mesh(turned_mesh(plate, 128, 1e-3), "plate"));
  ASSERT_TRUE(search.cavity.has_value()) << search.refusal;
  EXPECT_NEAR(search.cavity->floor, 4e-3, 1e-9);
  EXPECT_NEAR(search.cavity->brim, 10e-3, 1e-6);
  const double volume = PI / 3 * 6e-3 * (115 * 115 + 115 * 120 + 120 * 120) * 1e-6;
  EXPECT_NEAR(search.cavity->capacity, volume, 0.01 * volume);
}

TEST(CavityFinder, APointedFloorIsNotItsUnderside) {
  VesselData cone;  // a pit of 10 mm radius and 30 mm depth in the middle of the floor
  cone.outline = {line_to(40, 0), line_to(40, 90), line_to(36, 90), line_to(36, 35), line_to(10, 35), line_to(0, 5)};
  const CavitySearch search = find_cavity(check_mesh(turned_mesh(cone, 96, 1e-3), "cone"));
  ASSERT_TRUE(search.cavity.has_value()) << search.refusal;
  EXPECT_NEAR(search.cavity->floor, 5e-3, 1e-6);
}

// Sizes far beyond a hand's take no more heights.
TEST(CavityFinder, SizeDoesNotChangeTheWork) {
  for (const double scale : {1e-6, 1e3}) {
    TriangleMesh bowl = vessel_model("hemispherical_bowl").mesh;
    for (Triple& vertex : bowl.vertices)
      for (double& x : vertex) x *= scale;
    const CavitySearch search = find_cavity(check_mesh(bowl, "bowl"));
    if (scale < 1) {
      EXPECT_TRUE(has(search.refusal, "is too small")) << search.refusal;
      continue;
    }
    ASSERT_TRUE(search.cavity.has_value()) << search.refusal;
    const double capacity = vessel_model("hemispherical_bowl").capacity * std::pow(scale, 3);
    EXPECT_NEAR(search.cavity->capacity, capacity, 0.01 * capacity) << scale;
    EXPECT_LE(search.cavity->profile.size(), 5000u);
  }
}

std::vector<const VesselModel*> all_models() {
  std::vector<const VesselModel*> models;
  for (const VesselModel& model : vessel_models()) models.push_back(&model);
  return models;
}

INSTANTIATE_TEST_SUITE_P(Models, CavityOf, testing::ValuesIn(all_models()), [](const auto& tested) { return tested.param->name; });

}  // namespace
}  // namespace wholehand
