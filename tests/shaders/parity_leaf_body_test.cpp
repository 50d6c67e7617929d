// SPDX-License-Identifier: MIT
// Leaf functions of body.glsl and table.glsl against the core's (tests/support/leaf_parity.h).
// sanitizers: none
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/real.h"
#include "tests/shaders/probe_table.h"
#include "tests/support/leaf_parity.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

constexpr double THICKEST = 0.012;  // m: radius of a joint, at most

Builder& radii(Builder& build) { return build.uniform(2e-3, THICKEST).uniform(2e-3, THICKEST); }

// On a joint at either end too, and between joints in one place.
TEST_F(ParityLeaf, BallBetween) {
  Builder build(310);
  for (int i = 0; i < 999; ++i) {
    const Triple start{build.random.uniform(-0.1, 0.1), build.random.uniform(-0.1, 0.1), build.random.uniform(-0.1, 0.1)};
    build.vec(start);
    if (i % 7 == 0) {
      build.vec(start);
    } else {
      build.point(0.1);
    }
    radii(build).add(i % 5 == 0 ? 0 : i % 5 == 1 ? 1 : build.random.uniform(0, 1));
  }
  compare({"probe_body", PROBE_BALL_BETWEEN, 9, together(repeated("place", 3, REACH), repeated("radius", 1, THICKEST))},
          build.table, three_beakers());
}

// Bones of any length, also of none.
TEST_F(ParityLeaf, AroundBone) {
  Builder build(313);
  for (int i = 0; i < 999; ++i) {
    const Triple start{build.random.uniform(-0.1, 0.1), build.random.uniform(-0.1, 0.1), build.random.uniform(-0.1, 0.1)};
    build.vec(start).uniform(2e-3, THICKEST);
    if (i % 7 == 0) {
      build.vec(start);
    } else {
      build.point(0.1);
    }
    build.uniform(2e-3, THICKEST);
  }
  compare({"probe_body", PROBE_AROUND_BONE, 8, together(repeated("place", 3, REACH), repeated("radius", 1, REACH))}, build.table,
          three_beakers());
}

// Spheres apart and in each other, and a depth that no two spheres of their size can have.
TEST_F(ParityLeaf, OverlapMore) {
  Builder build(314);
  for (int i = 0; i < 999; ++i) {
    build.point(0.05).uniform(2e-3, 0.04).point(0.05).uniform(2e-3, 0.04);
    if (i % 9 == 0) {
      build.add(0.1);
    } else {
      build.uniform(-0.1, 0.06);
    }
  }
  compare({"probe_body", PROBE_OVERLAP_MORE, 9, {{"more", 1, true}}}, build.table, three_beakers());
}

// A share is x itself, 0 or 1: the same number or wrong.
TEST_F(ParityLeaf, NearestShare) {
  constexpr double NEVER = std::numeric_limits<double>::infinity();
  Builder build(311);
  for (int i = 0; i < 333; ++i) build.uniform(-1, 2);
  for (const double x : {0.0, -0.0, 1.0, 1e-30, -1e-30, 1 - 1e-6, 1 + 1e-6, NEVER, -NEVER, std::nan("")}) build.add(x);
  compare({.shader = "probe_body", .probe = PROBE_NEAREST_SHARE, .inputs = 1, .outputs = {{"share", 1, true}}, .exact = true},
          build.table, three_beakers());
}

// Where axes meet at a small angle, the share s on the lines is a quotient of differences of nearly equal products, and its
// rounding is not that of moved inputs. Both products have two scalar products of three terms, of 3 units each, and a rounding of
// their own: 7 units, or 7 epsilon for the two. Their size is |u| |v|^2 |r| in the numerator and |u|^2 |v|^2 in the denominator,
// which itself is |u|^2 |v|^2 sin^2. So s is off by 7 epsilon (1 + |r| / |u|) / sin^2, and by 1 at most. Over that way the distance
// of the axes changes by no more than sin |u| each unit of s. If the radii change by more than that, the overlap is largest at an
// end, which is evaluated; otherwise the radii change the overlap by less than that again. Device and core may be off in opposite
// directions: twice. A bone of no length has products of exactly 0.
double rounding_of_overlap(const double* given, double epsilon) {
  using core_f64::Vec3;
  const auto at = [&](int k) { return Vec3(given[k], given[k + 1], given[k + 2]); };
  const Vec3 u = at(3) - at(0), v = at(11) - at(8), r = at(0) - at(8);
  const double length = glm::length(u), lengths = length * glm::length(v);
  if (!(lengths > 0)) return 0;
  const double sine = glm::length(glm::cross(u, v)) / lengths;
  const double off = 7 * epsilon * (1 + glm::length(r) / length);
  return 2 * length * (off < sine * sine ? off / sine : sine);
}

// Bones in every place to each other. Some are parallel, or nearly so, some have no length, and some share a joint or all of their
// axis. A bone of no length whose radii differ may jump where it gets a length. Two of them would do so in most places, so they are
// spheres. The deepest pair so far is a depth that most pairs do not reach, or one that all do.
TEST_F(ParityLeaf, BonesOverlap) {
  Builder build(312);
  const auto triple = [&](double size) {
    const auto one = [&] { return build.random.uniform(-size, size); };
    const double x = one(), y = one();
    return Triple{x, y, one()};
  };
  const auto moved = [](const Triple& from, double by, const Triple& way) {
    return Triple{from[0] + by * way[0], from[1] + by * way[1], from[2] + by * way[2]};
  };
  for (int i = 0; i < 3001; ++i) {
    const Triple along = triple(0.04), a = triple(0.05);
    const int kind = i % 12;
    const Triple a_end = kind == 0 || kind == 1 ? a : moved(a, 1, along);
    Triple b = triple(0.05), b_end = triple(0.05);
    if (kind == 1 || kind == 2) b_end = b;
    if (kind >= 3 && kind <= 6) b_end = moved(b, build.random.uniform(-2, 2), along);               // parallel, apart
    if (kind == 5) b_end = moved(b_end, std::pow(10, build.random.uniform(-9, -1)), triple(0.04));  // nearly
    if (kind == 6) {                                                                                // in one line
      b = moved(a, build.random.uniform(-2, 2), along);
      b_end = moved(a, build.random.uniform(-2, 2), along);
    }
    if (kind == 7) b = i % 24 == 7 ? a : a_end;  // a joint in common
    if (kind == 8) {                             // axes that cross
      const Triple across = triple(0.05), middle = moved(a, build.random.uniform(-0.2, 1.2), along);
      b = moved(middle, -build.random.uniform(-0.2, 1), across);
      b_end = moved(b, 1, across);
    }
    if (kind == 9 && i % 24 == 9) b = a, b_end = a_end;
    build.vec(a).vec(a_end);
    if (kind == 1) {  // two spheres
      const double of_a = build.random.uniform(2e-3, THICKEST), of_b = build.random.uniform(2e-3, THICKEST);
      build.add(of_a).add(of_a).vec(b).vec(b_end).add(of_b).add(of_b).add(-1);
      continue;
    }
    radii(build).vec(b).vec(b_end);
    radii(build).add(i % 2 == 0 ? -1 : build.random.uniform(-0.05, 0.02));
  }
  compare({.shader = "probe_body",
           .probe = PROBE_BONES_OVERLAP,
           .inputs = 17,
           .outputs = {{"overlap", REACH}},
           .more = rounding_of_overlap},
          build.table, three_beakers());
}

// Vessels on tables of several heights and clearances, and points above a table, below it and in contact with it.
TEST_F(ParityLeaf, DepthInTable) {
  Scene scene = vessels_scene();
  scene.table = TableData{};
  for (const double clearance : {0.0, 2e-3, 0.03}) {
    scene.table->clearance = clearance;
    for (const std::size_t v : {std::size_t(0), VASE}) {
      const double top = scene.vessels[v].base + clearance;
      Builder points(320 + v), fingers(330 + v);
      for (int i = 0; i < 333; ++i) {
        const double radius = i % 5 == 0 ? 0 : points.random.uniform(2e-3, THICKEST);
        points.uniform(-0.1, 0.1).add(i % 7 == 0 ? top + radius : points.random.uniform(-0.1, 0.1)).uniform(-0.1, 0.1).add(radius);
        for (int k = 0; k < 3; ++k) fingers.uniform(-0.1, 0.1).uniform(-0.1, 0.1).uniform(-0.1, 0.1);
        for (int k = 0; k < 3; ++k) fingers.add(i % 5 == k ? 0 : fingers.random.uniform(2e-3, THICKEST));
      }
      compare({"probe_body", PROBE_DEPTH_IN_TABLE, 4, {{"depth", REACH}}}, points.table, scene, v);
      compare({"probe_body", PROBE_FINGER_IN_TABLE, 12, {{"depth", REACH}}}, fingers.table, scene, v);
    }
  }
}

}  // namespace
}  // namespace wholehand
