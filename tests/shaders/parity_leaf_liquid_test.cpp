// SPDX-License-Identifier: MIT
// Leaf functions of the shaders against the core's (tests/support/leaf_parity.h): liquid, force and score.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <vector>

#include "tests/shaders/probe_table.h"
#include "tests/support/leaf_facade.h"
#include "tests/support/leaf_parity.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

// ---- liquid ----

TEST_F(ParityLeaf, CircularSegments) {
  Builder build(130);
  for (int i = 0; i < 1000; ++i) {
    const double r = build.random.uniform(1e-3, 0.05);
    build.add(r).uniform(-1.1 * r, 1.1 * r);
  }
  for (const double h : {-1.0, -0.999999, 0.0, 0.999999, 1.0}) build.add(0.04).add(0.04 * h);
  build.add(0).add(0);
  const Scene scene = three_beakers();
  const double r = 0.05;
  compare({"probe_liquid", PROBE_SEGMENT_AREA, 2, {{"area", PI * r * r}}}, build.table, scene);
  compare({"probe_liquid", PROBE_SEGMENT_MOMENT, 2, {{"moment", r * r * r}}}, build.table, scene);
}

TEST_F(ParityLeaf, LiquidInOnePiece) {
  const Scene scene = vessels_scene();
  Builder radii(140), crossings(141), pieces(142);
  for (const VesselData& vessel : scene.vessels) {
    for (const PreparedElement& element : prepare_vessel(vessel, true).cavity) {
      for (int i = 0; i < 21; ++i) radii.element(element).add(element.a[1] + (element.b[1] - element.a[1]) * i / 20.0);
      for (int i = 0; i < 12; ++i) {
        const double tilt = i == 0 ? 0 : i == 1 ? PI / 2 : i == 2 ? PI : crossings.random.uniform(1e-3, PI - 1e-3);
        const double s = i == 0 || i == 2 ? 0 : std::sin(tilt), c = i == 1 ? 0 : std::cos(tilt);
        const double level =
            c * crossings.random.uniform(element.a[1] - 0.02, element.b[1] + 0.02) + s * crossings.random.uniform(-0.05, 0.05);
        crossings.element(element).add(level).add(s).add(c).add(i % 2 == 0 ? 1 : -1);
        pieces.element(element).add(level).add(s).add(c);
      }
    }
  }
  // a whole cavity's volume and moment: pi r^2 h and, over the height, twice that again
  const double volume = PI * 0.05 * 0.05 * 0.15, moment = volume * 0.15;
  compare({.shader = "probe_liquid",
           .probe = PROBE_ELEMENT_RADIUS,
           .inputs = 9,
           .outputs = {{"radius", 0.05}},
           .fixed = {7},
           .takes = rises},
          radii.table, scene);
  compare({.shader = "probe_liquid",
           .probe = PROBE_PLANE_CROSSINGS,
           .inputs = 12,
           .outputs = repeated("height", 2, REACH),
           .fixed = {7, 11},
           .takes = rises},
          crossings.table, scene);
  compare({.shader = "probe_liquid",
           .probe = PROBE_PIECE_BELOW,
           .inputs = 11,
           .outputs = {{"volume", volume}, {"lean", moment}, {"height", moment}, {"surface", PI * 0.05 * 0.05}},
           .fixed = {7},
           .takes = rises},
          pieces.table, scene);
}

// Between the heights at which the plane meets a piece's wall, as piece_below asks; full, dry and empty stretches among them.
TEST_F(ParityLeaf, SlicesOfAPiece) {
  const Scene scene = vessels_scene();
  const auto leaves = make_double_leaves(scene, 0);
  Builder tilted(144), upright(145);
  for (const VesselData& vessel : scene.vessels) {
    for (const PreparedElement& element : prepare_vessel(vessel, true).cavity) {
      const double low = element.a[1], high = element.b[1];
      for (const auto& [from, to] : {std::array{low, high}, std::array{low, 0.5 * (low + high)}, std::array{high, low},
                                     std::array{high, high}, std::array{0.7 * low + 0.3 * high, high}})
        upright.element(element).add(from).add(to).add(FLT_MAX).add(0).add(1);
      for (int i = 0; i < 24; ++i) {
        const double tilt = i == 0 ? PI / 2 : tilted.random.uniform(1e-2, PI - 1e-2), s = std::sin(tilt),
                     c = i == 0 ? 0 : std::cos(tilt);
        const double level = c * tilted.random.uniform(low - 0.02, high + 0.02) + s * tilted.random.uniform(-0.05, 0.05);
        std::vector<double> breaks{low, high};
        for (const double sigma : {1.0, -1.0}) {
          Builder plane(0);
          plane.element(element).add(level).add(s).add(c).add(sigma);
          std::array<double, 2> heights{};
          leaves->evaluate(PROBE_PLANE_CROSSINGS, plane.table.data(), heights.data());
          breaks.insert(breaks.end(), heights.begin(), heights.end());
        }
        std::ranges::sort(breaks);
        for (std::size_t k = 1; k < breaks.size(); ++k)
          tilted.element(element).add(breaks[k - 1]).add(breaks[k]).add(level).add(s).add(c);
      }
    }
  }
  const double volume = PI * 0.05 * 0.05 * 0.15, moment = volume * 0.15;  // as above
  for (const Builder* build : {&tilted, &upright})
    compare({.shader = "probe_liquid",
             .probe = PROBE_INTEGRATE_SLICES,
             .inputs = 13,
             .outputs = {{"volume", volume}, {"lean", moment}, {"height", moment}, {"surface", PI * 0.05 * 0.05}},
             .fixed = {7},
             .takes = rises},
            build->table, scene);
}

// From nothing to the whole cavity, at levels off the joints of its pieces.
TEST_F(ParityLeaf, LiquidBelow) {
  const Scene scene = vessels_scene();
  const auto core = make_core_evaluator(scene);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const double capacity = core->capacity(v), height = scene.vessels[v].height, radius = largest_radius(scene.vessels[v]);
    Builder build(146 + v);
    for (int degree = 0; degree <= 180; degree += 4) {
      const double s = degree % 180 == 0 ? 0 : std::sin(radians(degree)), c = std::cos(radians(degree));
      const double low = std::min(0.0, c * height) - s * radius, high = std::max(0.0, c * height) + s * radius;
      for (int i = 0; i < 9; ++i) build.add(low + (high - low) * build.random.uniform(-0.05, 1.05)).add(s).add(c);
    }
    compare({"probe_liquid",
             PROBE_LIQUID_BELOW,
             3,
             {{"volume", capacity}, {"lean", capacity * height}, {"height", capacity * height}, {"surface", PI * radius * radius}}},
            build.table, scene, v);
  }
}

TEST_F(ParityLeaf, LiquidInTheCavity) {
  const Scene scene = vessels_scene();
  const auto core = make_core_evaluator(scene);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const double capacity = core->capacity(v), height = scene.vessels[v].height;
    Builder tilts(150 + v), states(160 + v);
    for (int degree = 0; degree <= 180; degree += 3) {
      const double s = degree % 180 == 0 ? 0 : std::sin(radians(degree)), c = degree == 90 ? 0 : std::cos(radians(degree));
      tilts.add(s).add(c);
      if (degree > 90) continue;  // then little is left, and volumes must not exceed it
      for (const double fill : {0.0, 1e-12, 1e-3, 0.1, 0.3, 0.5, 0.9}) {
        const double volume = fill * capacity;
        if (volume < 0.99 * core->liquid(v, 1, radians(degree)).volume) states.add(volume).add(s).add(c);
      }
    }
    compare({"probe_liquid", PROBE_LIP_CAPACITY, 2, {{"level", height}, {"bottom", height}, {"capacity", capacity}}}, tilts.table,
            scene, v);
    // a level found to LEVEL_TOLERANCE of the capacity: as good as a volume that much larger or smaller
    compare({.shader = "probe_liquid",
             .probe = PROBE_LIQUID_AT,
             .inputs = 3,
             .outputs = {{"volume", capacity}, {"lean", height}, {"height", height}},
             .stopped = {0},
             .stop_scale = capacity,
             .sharp_share = 0.5},  // centers of a film of liquid are as good as unknown
            states.table, scene, v);
  }
}

// ---- force and score ----

TEST_F(ParityLeaf, Force) {
  const Scene scene = three_beakers();
  Builder directions(170), centers(171), references(172), forces(173), openings(176);
  for (int i = 0; i < 555; ++i) {
    const double tilt = i % 9 == 0 ? 0 : directions.random.uniform(0, PI), s = std::sin(tilt), c = std::cos(tilt);
    const double azimuth = directions.random.uniform(-PI, PI), obliquity = directions.random.uniform(-1, 1);
    const Triple d{std::cos(obliquity) * std::cos(azimuth), std::sin(obliquity), -std::cos(obliquity) * std::sin(azimuth)};
    const Triple pour{-std::sin(azimuth), 0, -std::cos(azimuth)};
    directions.vec(d).add(i % 2 == 0 ? 1 : -1).add(s).add(c);
    centers.point(0.1).uniform(-0.05, 0.05).uniform(0, 0.1).vec(pour);
    references.uniform(0.05, 0.6).add(9.80665).uniform(0, 0.1);
    forces.uniform(0, 2)
        .uniform(0, 5)
        .uniform(0, 0.5)
        .add(i % 11 == 0 ? 0 : forces.random.uniform(0.1, 0.5))
        .uniform(-4.5, 4.5)
        .uniform(1, 8);
    openings.uniform(0, 0.12);
  }
  compare({.shader = "probe_force", .probe = PROBE_DIRECTIONS, .inputs = 6, .outputs = repeated("direction", 6, 1), .fixed = {3}},
          directions.table, scene);
  compare({"probe_force", PROBE_LOAD_CENTER, 8, repeated("coordinate", 3, REACH)}, centers.table, scene);
  compare({"probe_force", PROBE_REFERENCE, 3, {{"torque", 0.6 * 9.80665 * 0.2}}}, references.table, scene);
  compare({"probe_force", PROBE_FORCES, 6, {{"normal", 30}, {"feedback", 30}}}, forces.table, scene);
  compare({"probe_force", PROBE_STRENGTH_AT, 1, {{"share", 1}}}, openings.table, scene);
}

TEST_F(ParityLeaf, Score) {
  Builder build(180);
  for (int i = 0; i < 333; ++i) {
    build.add(i % 6).add(i % 25).uniform(0, 0.02).uniform(0, 0.02).uniform(0, 1).uniform(0, 8).add(i % 9 == 0 ? 0 : 8);
    build.uniform(0, 90).add(40).uniform(0, 1.5);
  }
  compare({.shader = "probe_force", .probe = PROBE_SCORE, .inputs = 10, .outputs = repeated("term", 7, 1), .fixed = {0, 1, 6}},
          build.table, three_beakers());
}

}  // namespace
}  // namespace wholehand
