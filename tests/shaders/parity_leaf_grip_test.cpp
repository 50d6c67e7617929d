// SPDX-License-Identifier: MIT
// Leaf functions of the shaders against the core's (tests/support/leaf_parity.h): closure and projection.
// sanitizers: none
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/shaders/probe_table.h"
#include "tests/support/leaf_facade.h"
#include "tests/support/leaf_parity.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

// ---- closure ----

TEST_F(ParityLeaf, TraceTip) {
  const Scene scene = vessels_scene();
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const VesselData& vessel = scene.vessels[v];
    const double radius = largest_radius(vessel);
    Builder build(70 + v);
    for (int i = 0; i < 999; ++i) {
      const double azimuth = build.random.uniform(-PI, PI), offset = build.random.uniform(-1.3 * radius, 1.3 * radius);
      build.add(offset * std::sin(azimuth)).uniform(0.02 * vessel.height, 0.98 * vessel.height).add(offset * std::cos(azimuth));
      build.add(azimuth).uniform(-0.5, 0.5).add(i % 2 == 0 ? 1 : -1).uniform(6e-3, 8e-3);
    }
    compare({.shader = "probe_closure",
             .probe = PROBE_TRACE_TIP,
             .inputs = 7,
             .outputs = together(std::vector<Output>{{"t", REACH}, {"reason", 1, true}}, repeated("normal", 3, 1),
                                 std::vector<Output>{{"element", 1, true}}),
             .stopped = {6},
             .fixed = {5}},
            build.table, scene, v);
  }
}

TEST_F(ParityLeaf, PlaceHand) {
  Builder build(80);
  for (int i = 0; i < 777; ++i)
    build.uniform(0, 1).uniform(-PI, PI).uniform(-1.2, 1.2).uniform(-2, 1).point(0.15).uniform(0.8, 1.2);
  const std::vector<Output> outputs = together(repeated("rotation", 9, 1), repeated("translation", 3, REACH),
                                               repeated("e1_x", 1, 1), repeated("base", 3, REACH), repeated("axis", 6, 1));
  compare({"probe_closure", PROBE_PLACE_HAND, 8, outputs}, build.table, three_beakers());
  compare({"probe_closure", PROBE_PLACE_HAND, 8, outputs}, build.table, scene_of({beaker1()}, Pose::articulated, odd_hand()));
}

// Grips that close, and some for each reason not to. The core's tips are the inputs 6 and 7 larger (0 on the device): a tip's way
// is as good as one that ends with another radius, each side for itself.
TEST_F(ParityLeaf, CloseFingers) {
  const Scene scene = vessels_scene();
  const Scene odd = scene_of({beaker1()}, Pose::articulated, odd_hand());
  std::array<int, REASON_ON_MOUTH + 1> seen{};
  const auto check = [&](const Scene& on, std::size_t v) {
    const VesselData& vessel = on.vessels[v];
    const double radius = largest_radius(vessel);
    Builder build(190 + v);
    for (int i = 0; i < 1200; ++i) {
      const double reach = i % 8 == 0 ? 1.3 : 0.4;
      build.uniform(0.02 * vessel.height, (i % 8 == 1 ? 1.1 : 0.98) * vessel.height).uniform(-PI, PI);
      build.add(i % 50 == 2 ? PI / 2 : i % 50 == 3 ? -PI / 2 : build.random.uniform(-0.5, 0.5)).uniform(-2, 1);
      build.uniform(i % 8 == 6 ? radius : -reach * radius, (i % 8 == 6 ? 1.3 : reach) * radius);
      const double scale = i % 8 == 4 ? build.random.uniform(0.3, 0.8) : i % 8 == 5 ? build.random.uniform(2, 6) : 1;
      build.add(scale * build.random.uniform(0.9, 1.1)).add(0).add(0);
    }
    const auto leaves = make_double_leaves(on, v);
    for (std::size_t row = 0; row < build.table.size(); row += 8) {
      std::array<double, 27> answer{};
      leaves->evaluate(PROBE_CLOSE_FINGERS, &build.table[row], answer.data());
      ++seen[static_cast<std::size_t>(answer[0])];
    }
    compare({.shader = "probe_closure",
             .probe = PROBE_CLOSE_FINGERS,
             .inputs = 8,
             .outputs = together(std::vector<Output>{{"reason", 1, true}}, repeated("direction", 3, 1), repeated("t", 2, REACH),
                                 repeated("gap", 1, REACH), repeated("midpoint", 3, REACH), repeated("closure", 1, 1),
                                 repeated("angle", 2, PI), std::vector<Output>{{"grazing", 1, true}}, repeated("rotation", 9, 1),
                                 repeated("translation", 3, REACH), repeated("scale", 1, 4)),
             .stopped = {6, 7},
             // two tolerances for either side's stop and two for the gap's inverse, six in all: spreads count twice
             .stop_scale = 1.5,
             .undecided = 1e-3},
            build.table, on, v);
  };
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) check(scene, v);
  check(odd, 0);
  for (const int reason : {REASON_NONE, REASON_DEGENERATE, REASON_MISSES, REASON_TOO_WIDE, REASON_TOO_NARROW, REASON_ON_MOUTH})
    EXPECT_GE(seen[static_cast<std::size_t>(reason)], 20) << "reason " << reason;
}

// ---- wrist ----

constexpr double FARTHEST = 0.7;  // m: of a shoulder

TEST_F(ParityLeaf, ReachWrist) {
  Scene scene = three_beakers();
  scene.arm.emplace();
  Builder build(85);
  for (int i = 0; i < 777; ++i) {
    build.point(0.15).uniform(-FARTHEST, FARTHEST).uniform(0.1, FARTHEST).uniform(-FARTHEST, FARTHEST);
    const double turn = build.random.uniform(-PI, PI);
    build.add(std::cos(turn)).add(0).add(std::sin(turn));
  }
  compare({"probe_closure", PROBE_REACH_WRIST, 9, repeated("number", 11, 1), {}, 1, 0.8}, build.table, scene);
}

// One place of the elbow, and the best of all, above a table and without one, of a body of revolution and of another.
TEST_F(ParityLeaf, Wrist) {
  Scene scene = vessels_scene();
  scene.vessels.push_back(lopsided());
  scene.arm.emplace();
  for (const bool on_table : {false, true}) {
    if (on_table) scene.table.emplace();
    for (const std::size_t v : {std::size_t(0), scene.vessels.size() - 1}) {
      Builder eased(86 + v), found(96 + v);
      for (int i = 0; i < 555; ++i) {
        for (Builder* build : {&eased, &found})
          build->uniform(0, 1)
              .uniform(-PI, PI)
              .uniform(-0.6, 0.6)
              .uniform(-PI, PI)
              .uniform(-0.1, 0.1)
              .uniform(0, 0.2)
              .uniform(-0.1, 0.1)
              .uniform(0.8, 1.2);
        eased.uniform(-0.4, 0.4).uniform(0.2, 0.5).uniform(0.2, 0.5).uniform(-PI, PI).add(i % 7 / 6.0);
      }
      compare({"probe_closure", PROBE_EASE_WRIST, 13, together(repeated("angle", 3, PI), repeated("share", 1, 8)), {}, 1, 0.8},
              eased.table, scene, v);
      compare({"probe_closure", PROBE_FIND_WRIST, 8, {{"share", 8}}, {}, 1, 0.8}, found.table, scene, v);
    }
  }
}

// ---- projection ----

TEST_F(ParityLeaf, ProjectionPieces) {
  const Scene scene = three_beakers();
  Builder sums(90), nearest(92), axes(93), points(94), roles(95);
  for (int i = 0; i < 333; ++i) {
    sums.uniform(0, 1.1).uniform(0, 0.6).uniform(0, 0.3);
    const double tie = nearest.random.uniform(-0.01, 0.05);
    nearest.add(i % 5 == 0 ? tie : nearest.random.uniform(-0.01, 0.05)).add(i % 7 == 0 ? tie : nearest.random.uniform(-0.01, 0.05));
    nearest.add(i % 3 == 0 ? tie : nearest.random.uniform(-0.01, 0.05)).add(i % 3);
    const Triple mcp{axes.random.uniform(-0.1, 0.1), 0.1, axes.random.uniform(-0.1, 0.1)};
    axes.vec(mcp).add(mcp[0] + (i % 50 == 0 ? 0 : 0.05)).add(mcp[1] + (i % 50 == 0 ? 0 : -0.03)).add(mcp[2]).point(0.2).point(0.2);
    points.point(0.2).point(0.2).vec(points.direction()).uniform(-0.1, 0.1);
  }
  for (int point = 2; point <= 4; ++point)
    for (int before = 0; before < 32; ++before) roles.add(point).add(before);
  compare({.shader = "probe_projection", .probe = PROBE_CHAIN_SUMS, .inputs = 3, .outputs = repeated("sum", 3, 2)}, sums.table,
          scene);
  compare({.shader = "probe_projection", .probe = PROBE_NEAREST_POINT, .inputs = 4, .outputs = {{"point", 1, true}}, .fixed = {3}},
          nearest.table, scene);
  compare(
      {"probe_projection", PROBE_PAPER_AXIS, 12, together(repeated("direction", 3, 1), std::vector<Output>{{"exists", 1, true}})},
      axes.table, scene);
  compare({"probe_projection", PROBE_TURNED_POINT, 10, repeated("coordinate", 3, REACH)}, points.table, scene);
  compare(
      {.shader = "probe_projection", .probe = PROBE_PROJECTION_ROLE, .inputs = 2, .outputs = {{"role", 1, true}}, .fixed = {0, 1}},
      roles.table, scene);
}

// All is copied but where the segments are and the room, a few sums: equal to the bit but for these. Angles at, before and beyond the
// joints' limits.
TEST_F(ParityLeaf, TurnJoint) {
  for (const HandData& hand : {paper_hand(), odd_hand()}) {
    Builder build(96);
    for (int i = 0; i < 600; ++i) {
      double angle = 0;
      for (const double limit : hand.joint_limit) {
        const double off = i % 4 == 0 ? 0 : i % 4 == 1 ? hand.max_angle : build.random.uniform(-0.2, 1.5);
        angle += limit - off;
        build.add(angle);
      }
      const int joint = i % 5 - 1;
      build.add(joint > 0 ? 0 : 1).add(joint > 1 ? 0 : 1).add(1).add(joint);
      build.uniform(0, i % 3 == 0 ? 0 : 0.5).uniform(0, 0.8).add(i % 1025);
      build.add(i % 2).add(i % 3 == 0 ? 1 : 0).add(i / 5 % 4);
    }
    std::vector<Output> outputs = repeated("motion", 12, 4);
    for (std::size_t k = 3; k < outputs.size(); ++k) outputs[k].discrete = k != 8;
    outputs[8].name = "room";
    compare({.shader = "probe_projection", .probe = PROBE_TURN_JOINT, .inputs = 13, .outputs = outputs, .exact = true}, build.table,
            scene_of({beaker1()}, Pose::articulated, hand));
  }
}

// The rows of place_step whose place is clear of the vessel: no moving place is ever inside.
Table outside(const Table& table, const Scene& scene, std::size_t v) {
  constexpr std::size_t INPUTS = 26;
  const auto leaves = make_double_leaves(scene, v);
  Table clear;
  for (std::size_t row = 0; row < table.size(); row += INPUTS) {
    std::array<double, 11> place{};
    leaves->evaluate(PROBE_WATCHED_PLACE, &table[row], place.data());
    double distance = 0;
    leaves->evaluate(PROBE_SIGNED_DISTANCE, place.data(), &distance);
    if (distance - place[3] > STOP_TOLERANCE_F32)
      clear.insert(clear.end(), table.begin() + static_cast<std::ptrdiff_t>(row),
                   table.begin() + static_cast<std::ptrdiff_t>(row + INPUTS));
  }
  return clear;
}

// Fingers that start beside the vessel and close on it or past it.
TEST_F(ParityLeaf, FingersOnTheirWay) {
  const Scene scene = vessels_scene();
  for (const std::size_t v : {std::size_t(0), std::size_t(2), VASE}) {
    const VesselData& vessel = scene.vessels[v];
    Builder steps(100 + v), motions(110 + v), turned(120 + v);
    for (int i = 0; i < 250; ++i) {
      const double angle = steps.random.uniform(-PI, PI), away = largest_radius(vessel) * steps.random.uniform(1.2, 2.2);
      const Triple base{away * std::cos(angle), steps.random.uniform(0.1, 0.9) * vessel.height, away * std::sin(angle)};
      steps.frame(base).vec(base);
      motions.frame(base).vec(base);
      for (Builder* build : {&steps, &motions}) {
        build->uniform(0.03, 0.05).uniform(0.02, 0.03).uniform(0.018, 0.022);
        for (int k = 0; k < 4; ++k) build->uniform(6e-3, 8e-3);
      }
      steps.uniform(0, 1.2).uniform(0, 1).uniform(0, 0.6);
      const int joint = i % 4 - 1;
      // one place in ten may rest, beside the joint that turns, and then has no step
      const int first = i / 4 % 5 == 0 ? 0 : std::max(joint, 0);
      steps.add(joint > 0 ? 0 : 1).add(joint > 1 ? 0 : 1.5).add(joint < 0 ? 1.8 : 1).add(first + i / 4 % (3 - first));
      motions.uniform(0.2, 1);
      turned.vec(base)
          .uniform(6e-3, 8e-3)
          .vec({base[0] * 1.3, base[1] + 0.05, base[2] * 1.3})
          .vec(turned.direction())
          .uniform(0.05, 0.6);
    }
    // the room that a point has over how fast it goes: a few hundredths of a meter over 0.02 m a unit at least. Which element
    // bounds a step changes with the point: near those changes it may jump
    compare({.shader = "probe_projection",
             .probe = PROBE_WATCHED_PLACE,
             .inputs = 26,
             .outputs = together(repeated("place", 4, REACH), repeated("derivative", 7, 2)),
             .fixed = {25}},
            steps.table, scene, v);
    compare({.shader = "probe_projection",
             .probe = PROBE_PLACE_STEP,
             .inputs = 26,
             .outputs = {{"step", 2}},
             .sharp_share = 0.8,
             .fixed = {25}},
            outside(steps.table, scene, v), scene, v);
    compare({.shader = "probe_projection",
             .probe = PROBE_FINGER_MOTION,
             .inputs = 20,
             .outputs = together(repeated("angle", 3, 2), std::vector<Output>{{"blocked", 1, true}, {"unsettled", 1, true}}),
             .stopped = {16, 17, 18}},
            motions.table, scene, v);
    compare({.shader = "probe_projection",
             .probe = PROBE_PROJECT_POINT,
             .inputs = 11,
             .outputs = together(repeated("coordinate", 3, REACH), std::vector<Output>{{"unsettled", 1, true}}),
             .stopped = {3}},
            turned.table, scene, v);
  }
}

}  // namespace
}  // namespace wholehand
