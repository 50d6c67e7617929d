// SPDX-License-Identifier: MIT
// Leaf functions of loop.glsl against the core's (tests/support/leaf_parity.h).
// sanitizers: none
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shaders/layout.h"
#include "tests/shaders/probe_table.h"
#include "tests/support/leaf_parity.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

// Devices: mass 20 g to 2 kg, damping to 20 N s/m, a finger's spring to 5 kN/m; periods 0.1 ms to 4 ms. The fastest mode is then
// under
// 6 / period, so that a propagator is doubled six times at most: each doubling may double its relative error, which is 64 roundings
// at the end, twice the forward ones.
constexpr double DOUBLED = 2;
constexpr double MASS_LEAST = 0.02, PERIOD_MOST = 4e-3, SPRING_MOST = 5000;
constexpr double FASTEST = 500;  // 1/s: (SPRING_MOST / MASS_LEAST)^(1/2)

double logarithmic(Random& random, double low, double high) { return low * std::pow(high / low, random.uniform(0, 1)); }

Builder& plant(Builder& build) {
  build.add(logarithmic(build.random, MASS_LEAST, 2)).uniform(0, 20);
  return build.add(build.random.uniform(0, 1) < 0.3 ? 0 : build.random.uniform(0, SPRING_MOST));
}
Builder& period(Builder& build) { return build.add(logarithmic(build.random, 1e-4, PERIOD_MOST)); }

// Places to 20 mm, speeds to 0.5 m/s and forces to 20 N; a speed may gain what a force gives the lightest mass in a period.
constexpr double PLACE = 0.02, SPEED = 0.5, FORCE = 20;
constexpr double PLACE_AFTER = PLACE + SPEED * PERIOD_MOST + FORCE / MASS_LEAST * PERIOD_MOST * PERIOD_MOST / 2;
constexpr double SPEED_AFTER = SPEED + FASTEST * PLACE + FORCE / MASS_LEAST * PERIOD_MOST;

TEST_F(ParityLeaf, Propagator) {
  Builder build(300);
  for (int i = 0; i < 1501; ++i) period(plant(build));
  compare({.shader = "probe_loop",
           .probe = PROBE_PROPAGATOR,
           .inputs = 4,
           .outputs = {{"place of place", DOUBLED},
                       {"place of speed", DOUBLED * PERIOD_MOST},
                       {"place of force", DOUBLED * PERIOD_MOST * PERIOD_MOST / 2 / MASS_LEAST},
                       {"speed of place", DOUBLED * FASTEST},
                       {"speed of speed", DOUBLED},
                       {"speed of force", DOUBLED * PERIOD_MOST / MASS_LEAST}}},
          build.table, vessels_scene());
}

// Up to 16 sub-steps, each of which may round twice where the exact propagator's doublings do: the forward bound of 16 products.
TEST_F(ParityLeaf, SteppedPropagator) {
  Builder build(305);
  for (int i = 0; i < 1501; ++i) {
    period(plant(build)).add(i % 3 == 0 ? LOOP_EXACT : i % 3 == 1 ? LOOP_EULER : LOOP_SEMI_IMPLICIT);
    build.add(1 + i % 16);
  }
  constexpr double PRODUCTS = 16;
  compare({.shader = "probe_loop",
           .probe = PROBE_STEPPED,
           .inputs = 6,
           .outputs = {{"place of place", PRODUCTS},
                       {"place of speed", PRODUCTS * PERIOD_MOST},
                       {"place of force", PRODUCTS * PERIOD_MOST * PERIOD_MOST / 2 / MASS_LEAST},
                       {"speed of place", PRODUCTS * FASTEST * FASTEST * PERIOD_MOST},
                       {"speed of speed", PRODUCTS},
                       {"speed of force", PRODUCTS * PERIOD_MOST / MASS_LEAST}},
           .fixed = {4, 5}},
          build.table, vessels_scene());
}

TEST_F(ParityLeaf, LetGo) {
  constexpr double STIFFNESS = 5000;
  Builder build(306);
  for (int i = 0; i < 1001; ++i) {
    build.uniform(0, STIFFNESS).uniform(0, 2);
    period(build).add(0).add(i % 3 == 0 ? 0 : 12).add(i % (LOOP_DELAYS + 1)).add(i % 7 == 0 ? 1 : 0).uniform(-PLACE, PLACE);
  }
  compare({.shader = "probe_loop",
           .probe = PROBE_LET_GO,
           .inputs = 8,
           .outputs = together(std::vector<Output>{{"place", PLACE}, {"speed", 1}, {"reading", PLACE}},
                               repeated("waiting", LOOP_DELAYS, STIFFNESS * PLACE)),
           .fixed = {3, 4, 5, 6}},
          build.table, vessels_scene());
}

TEST_F(ParityLeaf, AdvanceWithAndWithoutFriction) {
  Builder build(301);
  for (int i = 0; i < 2003; ++i) {
    plant(build).uniform(-PLACE, PLACE);
    build.add(i % 7 == 0 ? 0 : build.random.uniform(-SPEED, SPEED)).uniform(-FORCE, FORCE);
    period(build.add(i % 3 == 0 ? 0 : build.random.uniform(0.01, 5)));
  }
  compare({.shader = "probe_loop",
           .probe = PROBE_ADVANCE,
           .inputs = 8,
           .outputs = {{"place", DOUBLED * PLACE_AFTER}, {"speed", DOUBLED * SPEED_AFTER}},
           // friction of nothing is no friction, and rest is rest: neither is moved
           .takes = [](const double* row) { return row[6] >= 0.005 || row[6] == 0; }},
          build.table, vessels_scene());
}

TEST_F(ParityLeaf, WallForce) {
  constexpr double STIFFNESS = 1e4, DAMPING = 10;
  Builder build(302);
  for (int i = 0; i < 2003; ++i) {
    build.uniform(0, STIFFNESS).uniform(-DAMPING, DAMPING).add(1e-3);
    build.add(i % 3 == 0 ? 0 : logarithmic(build.random, 1e-6, 1e-3)).add(i % 2 == 0 ? 0 : build.random.uniform(1, 12));
    build.add(i % 5 == 0 ? 1 : 0).uniform(-PLACE, PLACE).uniform(-SPEED, SPEED);
  }
  compare({.shader = "probe_loop",
           .probe = PROBE_WALL_FORCE,
           .inputs = 8,
           .outputs = {{"reading", PLACE}, {"force", STIFFNESS * PLACE + DAMPING * SPEED}},
           .sharp_share = 0.5,  // a reading near the middle between two steps is as good as either
           .fixed = {2, 3, 4, 5}},
          build.table, vessels_scene());
}

TEST_F(ParityLeaf, StepLoop) {
  constexpr double STIFFNESS = 5000, DAMPING = 2;
  Builder build(303);
  for (int i = 0; i < 2003; ++i) {
    plant(build).uniform(0, STIFFNESS).uniform(0, DAMPING);
    period(build).add(i % 2 == 0 ? 0 : 1e-5).add(i % 3 == 0 ? 0 : 12);
    build.add(i % (LOOP_DELAYS + 1)).add(i % 7 == 0 ? 1 : 0).uniform(-PLACE, PLACE).uniform(-SPEED, SPEED);
    build.add(build.table[build.table.size() - 2] - 1e-4 * build.random.uniform(-1, 1));
    for (int k = 0; k < LOOP_DELAYS; ++k) build.uniform(-FORCE, 0);
    build.uniform(0, FORCE).add(i % 4 == 0 ? build.random.uniform(0.1, 1) : 0);
  }
  const double rate = DAMPING * 1e-4 / 1e-4 + DAMPING * PLACE / 1e-4;  // of readings that cancel
  const double most = STIFFNESS * PLACE + rate + FORCE;
  compare({.shader = "probe_loop",
           .probe = PROBE_STEP_LOOP,
           .inputs = 19,
           .outputs =
               together(std::vector<Output>{{"place", DOUBLED * (PLACE_AFTER + most / MASS_LEAST * PERIOD_MOST * PERIOD_MOST / 2)},
                                            {"speed", DOUBLED * (SPEED_AFTER + most / MASS_LEAST * PERIOD_MOST)},
                                            {"reading", PLACE}},
                        repeated("waiting", LOOP_DELAYS, most)),
           .sharp_share = 0.8,  // where the encoder may read either of two steps
           .fixed = {6, 7, 8, 9},
           .takes = [](const double* row) { return row[18] >= 0.05 || row[18] == 0; }},
          build.table, vessels_scene());
}

TEST_F(ParityLeaf, LoopEnergy) {
  Builder build(304);
  for (int i = 0; i < 1001; ++i)
    plant(build)
        .add(i % 4 == 0 ? 0 : build.random.uniform(100, 1e4))
        .uniform(-PLACE, PLACE)
        .uniform(-SPEED, SPEED)
        .uniform(0, FORCE);
  // a soft spring is far from its rest: the press over 100 N/m
  compare({.shader = "probe_loop",
           .probe = PROBE_LOOP_ENERGY,
           .inputs = 7,
           .outputs = {{"energy", 1.5e4 * 0.2 * 0.2}},
           .sharp_share = 0.5,  // rest is where press and springs say, anywhere where there is next to no spring
           .takes = [](const double* row) { return row[2] >= 0 && row[3] >= 0 && row[2] + row[3] > 1; }},
          build.table, vessels_scene());
}

}  // namespace
}  // namespace wholehand
