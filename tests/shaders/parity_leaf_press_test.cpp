// SPDX-License-Identifier: MIT
// What a contact can do along a direction, of gauge.glsl against core/effort.cpp (tests/support/leaf_parity.h).
// sanitizers: none
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/shaders/probe_table.h"
#include "tests/support/leaf_parity.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

constexpr double MOST_FRICTION = 1.2;

// Arms and both halves of a direction have coordinates of at most 1. A contact then moves at 3 a coordinate, one of a direction and
// two of a cross product, and its height is that along the normal and the friction times that across. A force has 1 + mu, and a
// moment about an arm twice that a coordinate and the torsion's.
std::vector<Output> height_and_wrench() {
  constexpr double SPEED = 3 * 1.75, FORCE = 1 + MOST_FRICTION;  // of three coordinates: the root of 3, rounded up
  return together(std::vector<Output>{{"height", SPEED * (1 + MOST_FRICTION)}}, repeated("force", 3, FORCE),
                  repeated("moment", 3, 2 * FORCE + MOST_FRICTION));
}

TEST_F(ParityLeaf, Press) {
  Builder build(340);
  for (int i = 0; i < 2001; ++i) {
    build.point(1).vec(build.direction());
    build.add(i % 7 == 0 ? 0 : build.random.uniform(0.05, MOST_FRICTION)).add(i % 11 == 0 ? 0 : build.random.uniform(0.02, 1));
    build.point(1).point(1);
  }
  compare({"probe_press", PROBE_PRESS, 14, height_and_wrench()}, build.table, three_beakers());
}

// Where a contact moves along its normal alone, or not at all, any force in its cone's rim does as much, and the one along the
// normal is named. Normals are along axes and numbers have a few bits, so that it moves across by exactly 0. Nothing is moved, as
// the least moves on from there to the rim. A normal of 0 is that of a joint that does not press.
TEST_F(ParityLeaf, PressAlongTheNormal) {
  Builder build(341);
  const auto few_bits = [&](double most) { return std::round(build.random.uniform(-8 * most, 8 * most)) / 8; };
  for (int i = 0; i < 600; ++i) {
    const int axis = i % 3;
    const double sense = i % 2 == 0 ? 1 : -1, speed = few_bits(1), turn = i % 5 == 0 ? few_bits(1) : 0;
    Triple arm{few_bits(1), few_bits(1), few_bits(1)}, normal{}, velocity{}, turning{};
    normal[axis] = i % 20 == 19 ? 0 : sense;
    velocity[axis] = speed;
    turning[axis] = turn;
    if (turn != 0) arm[(axis + 1) % 3] = arm[(axis + 2) % 3] = 0;  // on the axis that it turns about
    if (i % 20 == 19) velocity = {few_bits(1), few_bits(1), few_bits(1)};
    const double friction = 0.125 * (i % 8), gamma = turn != 0 ? 0 : 0.125 * (i % 5);
    build.vec(arm).vec(normal).add(friction).add(gamma).vec(velocity).vec(turning);
  }
  compare({.shader = "probe_press", .probe = PROBE_PRESS, .inputs = 14, .outputs = height_and_wrench(), .exact = true}, build.table,
          three_beakers());
}

}  // namespace
}  // namespace wholehand
