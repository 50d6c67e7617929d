// SPDX-License-Identifier: MIT
// Leaf functions of the shaders against the core's (tests/support/leaf_parity.h): force and score.
// sanitizers: none
#include <gtest/gtest.h>

#include <cmath>

#include "tests/shaders/probe_table.h"
#include "tests/support/leaf_parity.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

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
