// SPDX-License-Identifier: MIT
// Level rays from an axis, against closed forms; and where an upright line meets a mesh.
#include "core/meshes/free_radius.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/vectors.h"
#include "tests/support/mesh_faults.h"
#include "tests/support/meshes.h"
#include "tests/support/vessel_profiles.h"

namespace wholehand {
namespace {

constexpr double RADIUS = 0.04, HEIGHT = 0.1;  // m
constexpr double RADIUS_ROUNDING = 1e-15;      // m: of a few operations on a tenth of a meter

double azimuth_of(int ray) { return 2 * PI * ray / RAY_AZIMUTHS; }

// An upright wall around the axis, open above and below, with a corner at azimuth 0.
TriangleMesh tube(int sides) {
  TriangleMesh mesh;
  const auto count = static_cast<std::uint32_t>(sides);
  for (const double y : {0.0, HEIGHT})
    for (std::uint32_t i = 0; i < count; ++i) {
      const double azimuth = 2 * PI * i / sides;
      mesh.vertices.push_back({RADIUS * std::cos(azimuth), y, RADIUS * std::sin(azimuth)});
    }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    mesh.triangles.push_back({i, count + next, next});
    mesh.triangles.push_back({i, count + i, count + next});
  }
  return mesh;
}

// A regular polygon with a corner at azimuth 0.
double polygon_radius(int sides, double azimuth) {
  const double half = PI / sides, from_corner = std::fmod(azimuth, 2 * half);
  return RADIUS * std::cos(half) / std::cos(from_corner - half);
}

TEST(FreeRadius, OfAPolygonAboutItsAxis) {
  for (const int sides : {3, 7, 12, 96, 360}) {
    const std::vector<FreeRadii> radii = free_radii(tube(sides), 0, 0, {0, 0.3 * HEIGHT, HEIGHT});
    ASSERT_EQ(radii.size(), 3u);
    for (const FreeRadii& one : radii) {
      ASSERT_EQ(one.size(), static_cast<std::size_t>(RAY_AZIMUTHS));
      // a ray at an angle to a side magnifies its rounding: by 2 for a triangle, the most
      for (int ray = 0; ray < RAY_AZIMUTHS; ++ray)
        EXPECT_NEAR(one[ray], polygon_radius(sides, azimuth_of(ray)), 2 * RADIUS_ROUNDING) << sides << " sides, ray " << ray;
    }
  }
}

TEST(FreeRadius, OfACylinderBesideTheAxis) {
  constexpr int SIDES = 4096;
  constexpr double X = 0.012, Z = -0.016;  // half of the radius off
  const double sagitta = RADIUS * (1 - std::cos(PI / SIDES));
  const FreeRadii radii = free_radii(tube(SIDES), X, Z, {HEIGHT / 2})[0];
  for (int ray = 0; ray < RAY_AZIMUTHS; ++ray) {
    const double ux = std::cos(azimuth_of(ray)), uz = std::sin(azimuth_of(ray));
    const double along = X * ux + Z * uz, beside = X * uz - Z * ux;
    const double round = std::sqrt(RADIUS * RADIUS - beside * beside) - along;
    EXPECT_LE(radii[ray], round + RADIUS_ROUNDING) << ray;
    // the ray meets the wall at 30 degrees at most
    EXPECT_GE(radii[ray], round - sagitta / std::cos(PI / 6) * 1.01) << ray;
  }
}

TEST(FreeRadius, TheNearestWallCounts) {
  TriangleMesh inner = tube(12);
  for (Triple& p : inner.vertices) p[0] *= 0.5, p[2] *= 0.5;
  for (const TriangleMesh& mesh : {joined(inner, tube(12)), joined(tube(12), inner), inside_out(joined(tube(12), inner))}) {
    const FreeRadii radii = free_radii(mesh, 0, 0, {HEIGHT / 2})[0];
    for (int ray = 0; ray < RAY_AZIMUTHS; ++ray)
      EXPECT_NEAR(radii[ray], polygon_radius(12, azimuth_of(ray)) / 2, RADIUS_ROUNDING) << ray;
  }
}

// A slit of 10 degrees: rays at its edges meet the wall, those between do not.
TEST(FreeRadius, RaysLeaveByASlit) {
  constexpr int SIDES = 36, SIDE = 7;
  TriangleMesh slit = tube(SIDES);
  slit.triangles.erase(slit.triangles.begin() + 2 * SIDE, slit.triangles.begin() + 2 * SIDE + 2);
  const FreeRadii radii = free_radii(slit, 0, 0, {HEIGHT / 2})[0];
  for (int ray = 0; ray < RAY_AZIMUTHS; ++ray) EXPECT_EQ(std::isinf(radii[ray]), ray > 10 * SIDE && ray < 10 * (SIDE + 1)) << ray;
}

TEST(FreeRadius, NothingAboveAndBelowTheMesh) {
  for (const FreeRadii& radii : free_radii(tube(12), 0, 0, {-1e-9, HEIGHT + 1e-9}))
    EXPECT_TRUE(std::all_of(radii.begin(), radii.end(), [](double r) { return std::isinf(r); }));
}

// The axis outside of the mesh: only rays that point at it meet it, on its near side.
TEST(FreeRadius, FromOutside) {
  constexpr int SIDES = 4096;
  const FreeRadii radii = free_radii(tube(SIDES), -2 * RADIUS, 0, {HEIGHT / 2})[0];
  for (int ray = 0; ray < RAY_AZIMUTHS; ++ray) {
    const int away = std::min(ray, RAY_AZIMUTHS - ray);
    if (away == 30) continue;  // along the wall
    EXPECT_EQ(std::isfinite(radii[ray]), away < 30) << ray;
  }
  EXPECT_NEAR(radii[0], RADIUS, RADIUS_ROUNDING);
}

// A thorn between two rays is met by neither.
TEST(LeastRadius, IsThatBetweenRaysToo) {
  TriangleMesh mesh = tube(12);
  const double azimuth = azimuth_of(0) + PI / RAY_AZIMUTHS, tip = 0.03;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double off : {-0.1, 0.1})  // of a ray's step
    for (const double y : {0.0, HEIGHT})
      mesh.vertices.push_back(
          {RADIUS * std::cos(azimuth + off * 2 * PI / RAY_AZIMUTHS), y, RADIUS * std::sin(azimuth + off * 2 * PI / RAY_AZIMUTHS)});
  for (const double y : {0.0, HEIGHT}) mesh.vertices.push_back({tip * std::cos(azimuth), y, tip * std::sin(azimuth)});
  for (const std::uint32_t side : {0u, 2u}) {
    mesh.triangles.push_back({first + side, first + side + 1, first + 5});
    mesh.triangles.push_back({first + side, first + 5, first + 4});
  }
  const FreeRadii rays = free_radii(mesh, 0, 0, {0.04})[0];
  EXPECT_NEAR(*std::min_element(rays.begin(), rays.end()), RADIUS * std::cos(PI / 12), RADIUS_ROUNDING);
  const std::vector<double> least = least_radii(mesh, 0, 0, {0.04, 2 * HEIGHT});
  EXPECT_NEAR(least[0], tip, RADIUS_ROUNDING);
  EXPECT_TRUE(std::isinf(least[1]));
}

TEST(LeastRadius, OfAPolygonIsThatOfItsSides) {
  for (const int sides : {3, 7, 12})
    EXPECT_NEAR(least_radii(tube(sides), 0, 0, {HEIGHT / 2})[0], RADIUS * std::cos(PI / sides), RADIUS_ROUNDING) << sides;
  EXPECT_NEAR(least_radii(tube(12), -2 * RADIUS, 0, {HEIGHT / 2})[0], RADIUS, RADIUS_ROUNDING)
      << "from outside: to the nearest corner";
}

// ---- upright lines ----

// Every triangle that shares an edge or a corner counts.
std::vector<double> without_repeats(std::vector<double> heights) {
  EXPECT_TRUE(std::is_sorted(heights.begin(), heights.end()));
  heights.erase(std::unique(heights.begin(), heights.end(), [](double a, double b) { return b - a <= RADIUS_ROUNDING; }),
                heights.end());
  return heights;
}

void expect_heights(const std::vector<double>& found, const std::vector<double>& expected, const std::string& what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], RADIUS_ROUNDING) << what;
}

TEST(HeightsOnLine, ThroughFacesEdgesAndCorners) {
  const TriangleMesh box = box_mesh({-0.03, 0.01, -0.02}, {0.03, 0.09, 0.02});
  expect_heights(heights_on_line(box, 0.02, 0.01), {0.01, 0.09}, "faces: each once");
  expect_heights(without_repeats(heights_on_line(box, 0, 0)), {0.01, 0.09}, "the diagonals of floor and lid");
  expect_heights(without_repeats(heights_on_line(box, 0.03, 0.005)), {0.01, 0.09}, "along a side");
  expect_heights(without_repeats(heights_on_line(box, 0.03, 0.02)), {0.01, 0.09}, "corners");
  expect_heights(heights_on_line(box, 0.0301, 0), {}, "beside it");
  expect_heights(heights_on_line(box, 0, -0.0201), {}, "beside it");
}

// The tops of bodies whose corner or ridge lies on the line, at which sums of shares round differently in each triangle.
TEST(HeightsOnLine, ATipAndARidgeAreNotMissed) {
  TriangleMesh pyramid;
  pyramid.vertices = {{0.0123, 0.07, 0.0045}};
  constexpr int SIDES = 11;
  for (int i = 0; i < SIDES; ++i)
    pyramid.vertices.push_back({0.03 * std::cos(2 * PI * i / SIDES), 0, 0.03 * std::sin(2 * PI * i / SIDES)});
  for (std::uint32_t i = 0; i < SIDES; ++i) pyramid.triangles.push_back({0, (i + 1) % SIDES + 1, i + 1});
  expect_heights(without_repeats(heights_on_line(pyramid, 0.0123, 0.0045)), {0.07}, "tip");
  for (std::uint32_t i = 1; i <= SIDES; ++i) {  // places along the ridges
    for (const double t : {0.1, 1.0 / 3, 0.77}) {
      const Triple &tip = pyramid.vertices[0], &foot = pyramid.vertices[i];
      const auto at = [&](int k) { return tip[k] + t * (foot[k] - tip[k]); };
      expect_heights(without_repeats(heights_on_line(pyramid, at(0), at(2))), {at(1)}, "ridge");
    }
  }
}

TEST(HeightsOnLine, ABallIsMetTwice) {
  const TriangleMesh ball = icosphere(RADIUS, 5);
  double deepest = 0;  // of a facet's plane within the sphere
  for (const Corners& triangle : ball.triangles) {
    const glm::dvec3 a = to_vec3(ball.vertices[triangle[0]]), b = to_vec3(ball.vertices[triangle[1]]),
                     c = to_vec3(ball.vertices[triangle[2]]);
    deepest = std::max(deepest, RADIUS - glm::dot(a, glm::normalize(glm::cross(b - a, c - a))));
  }
  for (const double off : {0.0, 0.3, 0.6}) {
    const std::vector<double> heights = without_repeats(heights_on_line(ball, off * RADIUS, 0.1 * RADIUS));
    // the mesh lies between two spheres
    const auto height = [&](double radius) { return std::sqrt(radius * radius - RADIUS * RADIUS * (off * off + 0.01)); };
    const double high = height(RADIUS) + RADIUS_ROUNDING, low = height(RADIUS - deepest) - RADIUS_ROUNDING;
    ASSERT_EQ(heights.size(), 2u);
    EXPECT_TRUE(heights[0] >= -high && heights[0] <= -low && heights[1] >= low && heights[1] <= high) << off;
  }
}

}  // namespace
}  // namespace wholehand
