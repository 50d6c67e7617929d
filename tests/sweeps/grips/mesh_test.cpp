// SPDX-License-Identifier: MIT
// Meshes of glass, liquid and bones: closed, outward, of the right size, and converging with the square of the step.
// sanitizers: address
#include "sweeps/grips/mesh.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "base/text/error.h"
#include "core/evaluator.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

Triple minus(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double enclosed_volume(const SurfaceMesh& mesh) {
  double six = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    six +=
        dot(mesh.positions[mesh.triangles[t]], cross(mesh.positions[mesh.triangles[t + 1]], mesh.positions[mesh.triangles[t + 2]]));
  return six / 6;
}

// Every edge is met once in either direction, and by area the normals of the vertices are the triangles'.
void expect_closed(const SurfaceMesh& mesh, const char* what) {
  ASSERT_FALSE(mesh.triangles.empty()) << what;
  ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
  std::map<std::pair<Triple, Triple>, int> edges;
  double area = 0, agreement = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto corner = [&](int k) { return mesh.triangles[t + k % 3]; };
    for (int k = 0; k < 3; ++k) {
      ASSERT_LT(corner(k), mesh.positions.size());
      ++edges[{mesh.positions[corner(k)], mesh.positions[corner(k + 1)]}];
    }
    const Triple normal = cross(minus(mesh.positions[corner(1)], mesh.positions[corner(0)]),
                                minus(mesh.positions[corner(2)], mesh.positions[corner(0)]));
    area += std::sqrt(dot(normal, normal));
    for (int k = 0; k < 3; ++k) agreement += dot(normal, mesh.normals[corner(k)]) / 3;
  }
  EXPECT_GT(agreement / area, 0.94) << what;  // steps of 2 pi / 32, and slivers at the edge of a level that leans little
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    ASSERT_TRUE(back != edges.end() && back->second == count)
        << what << ": open at " << edge.first[0] << ' ' << edge.first[1] << ' ' << edge.first[2];
  }
  for (const Triple& n : mesh.normals) ASSERT_NEAR(dot(n, n), 1, 1e-9) << what;
}

// Each halving of the step leaves a quarter of the error: a factor of 3 at least, where the ends of arcs do not fall on the step.
void expect_second_order(const std::vector<double>& errors, const char* what) {
  for (std::size_t k = 1; k < errors.size(); ++k)
    EXPECT_LT(std::abs(errors[k]), std::abs(errors[k - 1]) / 3) << what << " at halving " << k;
}

const std::vector<VesselData> VESSELS{beaker1(), beaker2(), beaker3(), vase()};

TEST(GripMesh, GlassIsClosedAndHasItsWallsVolume) {
  for (const VesselData& vessel : VESSELS) {
    const Scene scene = scene_of({vessel});
    const double volume = make_core_evaluator(scene)->empty_mass(0) / vessel.density;
    std::vector<double> errors;
    for (const int segments : {32, 64, 128}) {
      const SurfaceMesh mesh = vessel_mesh(vessel, segments);
      expect_closed(mesh, vessel.name.c_str());
      errors.push_back(enclosed_volume(mesh) / volume - 1);
    }
    expect_second_order(errors, vessel.name.c_str());
    EXPECT_LT(std::abs(errors.back()), 1e-2) << vessel.name;
  }
}

TEST(GripMesh, GlassReachesAsFarAsItsOutline) {
  for (const VesselData& vessel : VESSELS) {
    Triple low{1, 1, 1}, high{-1, -1, -1};
    for (const Triple& p : vessel_mesh(vessel, 512).positions) {
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
    const double radius = largest_radius(vessel);
    EXPECT_EQ(low[1], 0) << vessel.name;
    EXPECT_EQ(high[1], vessel.height) << vessel.name;
    for (const int k : {0, 2}) {
      // an arc's widest place lies between two steps: R (1 - cos(pi / 512)) = 2e-5 R
      EXPECT_NEAR(high[k], radius, 2e-6) << vessel.name;
      EXPECT_NEAR(low[k], -radius, 2e-6) << vessel.name;
    }
  }
}

TEST(GripMesh, WithoutAWallTheHullIsDrawn) {
  VesselData vessel = cylinder("solid", 80, 100, 0);
  const SurfaceMesh mesh = vessel_mesh(vessel, 256);
  expect_closed(mesh, "solid");
  EXPECT_NEAR(enclosed_volume(mesh), PI * 0.04 * 0.04 * 0.1, 1e-7);  // 1e-4 of 5e-4 m3
  EXPECT_TRUE(liquid_mesh(vessel, 1e-4, 0, {1, 0, 0}, 64).triangles.empty());
}

TEST(GripMesh, LiquidIsClosedAndHasTheLiquidsVolume) {
  for (const VesselData& vessel : VESSELS) {
    Scene scene = scene_of({vessel});
    scene.liquid = LiquidData{1000, {1}, {}, Pour::away};
    const auto core = make_core_evaluator(scene);
    for (const double fill : {0.02, 0.3, 0.6, 1.0}) {
      for (const double tilt : {0.0, 1.0, 12.0, 45.0, 75.0, 90.0, 110.0}) {
        const LiquidResult liquid = core->liquid(0, fill, radians(tilt));
        if (liquid.volume < 1e-8) continue;
        const std::string what = vessel.name + " fill " + std::to_string(fill) + " tilt " + std::to_string(tilt);
        std::vector<double> errors;
        for (const int segments : {32, 64, 128}) {
          const SurfaceMesh mesh = liquid_mesh(vessel, liquid.volume, radians(tilt), {0.6, 0, -0.8}, segments);
          if (segments == 32) expect_closed(mesh, what.c_str());
          errors.push_back(enclosed_volume(mesh) / liquid.volume - 1);
        }
        EXPECT_LT(std::abs(errors[2]), 5e-3) << what;
        if (std::abs(errors[0]) > 1e-6) expect_second_order(errors, what.c_str());
      }
    }
  }
}

// Center of mass and surface: the liquid leans the way the core says, and nothing is above the level plane.
TEST(GripMesh, LiquidLeansAsTheCoreSays) {
  Scene scene = scene_of({beaker3()});
  scene.liquid = LiquidData{1000, {1}, {}, Pour::away};
  const LiquidResult liquid = make_core_evaluator(scene)->liquid(0, 0.4, radians(50));
  const Triple n{0.6, 0, -0.8};
  const SurfaceMesh mesh = liquid_mesh(scene.vessels[0], liquid.volume, radians(50), n, 192);
  Triple moment{};
  double six = 0, top = -1;
  const Triple up{-std::sin(radians(50)) * n[0], std::cos(radians(50)), -std::sin(radians(50)) * n[2]};
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Triple &a = mesh.positions[mesh.triangles[t]], &b = mesh.positions[mesh.triangles[t + 1]],
                 &c = mesh.positions[mesh.triangles[t + 2]];
    const double volume = dot(a, cross(b, c));
    six += volume;
    for (int k = 0; k < 3; ++k) moment[k] += volume * (a[k] + b[k] + c[k]) / 4;
  }
  for (const Triple& p : mesh.positions) top = std::max(top, dot(p, up));
  double level = 2;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (dot(mesh.normals[i], up) > 1 - 1e-12) level = std::min(level, dot(mesh.positions[i], up));
  }
  EXPECT_NEAR(top, level, 1e-12);  // the surface is level, and highest
  // the square of a step of 2 pi / 192, times the radius of 4 cm
  EXPECT_NEAR(dot(moment, n) / six, liquid.lean, 4e-5);
  EXPECT_NEAR(moment[1] / six, liquid.height, 4e-5);
  EXPECT_NEAR(dot(moment, {-n[2], 0, n[0]}) / six, 0, 4e-5);
}

TEST(GripMesh, OfAMeshVesselTheMeshIsDrawn) {
  const TriangleMesh mesh = turned_mesh(beaker2(), 48, 4e-3);
  const SurfaceMesh drawn = vessel_mesh(vessel_of_mesh("flask", mesh, 0), 64);
  expect_closed(drawn, "flask");
  EXPECT_EQ(drawn.triangles.size(), 3 * mesh.triangles.size());
  EXPECT_NEAR(enclosed_volume(drawn), body_of(mesh).volume, 1e-15);
  VesselData unread = vessel_of_mesh("unread", mesh, 0);
  unread.mesh->body.reset();
  EXPECT_THROW(vessel_mesh(unread, 64), Error);
}

// Liquid fills the inner outline of a mesh as it does the cavity of an outline.
TEST(GripMesh, AMeshVesselHoldsTheLiquidOfItsCavity) {
  const VesselData outline = beaker1();  // its cavity: radius 38.5 from 1.5 to 110 mm
  VesselData mesh = vessel_of_mesh("mesh", turned_mesh(outline, 48, 4e-3), 0);
  EXPECT_TRUE(liquid_mesh(mesh, 1e-4, 0, {1, 0, 0}, 64).triangles.empty());
  mesh.inner = {line_to(0, 1.5), line_to(38.5, 1.5), line_to(38.5, 110)};
  for (const double tilt : {0.0, 30.0, 80.0}) {
    const SurfaceMesh of_mesh = liquid_mesh(mesh, 1e-4, radians(tilt), {0.6, 0, -0.8}, 64),
                      of_outline = liquid_mesh(outline, 1e-4, radians(tilt), {0.6, 0, -0.8}, 64);
    expect_closed(of_mesh, "liquid");
    EXPECT_NEAR(enclosed_volume(of_mesh), enclosed_volume(of_outline), 1e-15) << tilt;
  }
}

TEST(GripMesh, BallsAndCapsules) {
  const SurfaceMesh ball = ball_mesh(96);
  expect_closed(ball, "ball");
  EXPECT_NEAR(enclosed_volume(ball), 4 * PI / 3, 1e-2);
  const SurfaceMesh even = capsule_mesh(0.04, 0.008, 0.008, 96);
  expect_closed(even, "even");
  const double r = 0.008;
  EXPECT_NEAR(enclosed_volume(even) / (PI * r * r * 0.04 + 4 * PI / 3 * r * r * r), 1, 2e-3);
  for (const auto& [near, far] : {std::pair{0.008, 0.005}, std::pair{0.005, 0.008}}) {
    const SurfaceMesh mesh = capsule_mesh(0.03, near, far, 32);
    expect_closed(mesh, "tapered");
    double front = 0, back = 0;
    for (const Triple& p : mesh.positions) {
      front = std::min(front, p[2]);
      back = std::max(back, p[2]);
      // all points on either ball or between them: at the distance of the line that touches both
      const double along = -p[2], across = std::hypot(p[0], p[1]), sine = (near - far) / 0.03;
      const double start = near * sine, end = 0.03 + far * sine, cosine = std::sqrt(1 - sine * sine);
      const double expected = along < start - 1e-12 ? std::sqrt(near * near - along * along)
                              : along > end + 1e-12 ? std::sqrt(std::max(0.0, far * far - (along - 0.03) * (along - 0.03)))
                                                    : near / cosine - along * sine / cosine;
      EXPECT_NEAR(across, expected, 1e-9);
    }
    EXPECT_DOUBLE_EQ(back, near);
    EXPECT_DOUBLE_EQ(front, -0.03 - far);
  }
  expect_closed(capsule_mesh(0.001, 0.008, 0.005, 32), "one ball within the other");
}

}  // namespace
}  // namespace wholehand::sweeps
