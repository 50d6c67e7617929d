// SPDX-License-Identifier: MIT
// Every leaf function of the shaders against the core's (tests/support/leaf_parity.h); those of sdf.glsl's elements and lattice and of
// contact.glsl's proxies are in parity_leaf_sdf_test.cpp.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <string>
#include <vector>

#include "tests/shaders/probe_table.h"
#include "tests/support/leaf_facade.h"
#include "tests/support/leaf_parity.h"
#include "tests/support/leaf_probe.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand {
namespace {

// ---- trig: against long double ----

struct TrigErrors {
  double worst = 0;  // units in the last place of 1
  double at = 0;
  void add(long double is, long double should, double epsilon, double input) {
    const double error = static_cast<double>(std::abs(is - should)) / epsilon;
    if (error <= worst) return;
    worst = error;
    at = input;
  }
};

TEST_F(ParityLeaf, TrigIsWithinItsBounds) {
  const Scene scene = three_beakers();
  for (const Precision precision : precisions()) {
    const double epsilon = precision == Precision::single ? FLT_EPSILON : DBL_EPSILON;
    const LeafProbe probe(*device, scene, 0, precision, OUTLINE_SPECIALIZED);
    Builder angles(1), cosines(2), pairs(3);
    for (int i = 0; i <= 64000; ++i) angles.add(-16 + i / 2000.0);
    for (int quarter = -10; quarter <= 10; ++quarter)
      for (const double off : {-1e-3, -1e-6, -1e-9, 0.0, 1e-9, 1e-6, 1e-3}) angles.add(quarter * PI / 4 + off);
    for (int i = 0; i < 20000; ++i) angles.uniform(-PI, PI);
    for (int i = 0; i <= 40000; ++i) cosines.add(-1 + i / 20000.0);
    for (const double off : {1e-2, 1e-4, 1e-7, 1e-10, 1e-15, 0.0})
      cosines.add(1 - off).add(off - 1).add(off).add(-off).add(0.5 + off).add(-0.5 - off);
    for (int i = 0; i < 10000; ++i) {
      const Triple a = pairs.direction();
      Triple b = pairs.direction();
      if (i % 3 == 1) b = a;
      if (i % 3 == 2) b = {-a[0], -a[1], -a[2]};
      if (i % 3 != 0) {
        const double turn = std::pow(10.0, pairs.random.uniform(-9, -1));
        const Triple aside = pairs.direction();
        double size = 0;
        for (int k = 0; k < 3; ++k) size += (b[k] + turn * aside[k]) * (b[k] + turn * aside[k]);
        for (int k = 0; k < 3; ++k) b[k] = (b[k] + turn * aside[k]) / std::sqrt(size);
      }
      pairs.vec(a).vec(b);
    }
    const Table x = rounded(angles.table, precision), y = rounded(cosines.table, precision), ab = rounded(pairs.table, precision);
    const Table sc = probe.run("probe_trig", PROBE_SINE_COSINE, x, x.size(), 1, 2);
    const Table acos = probe.run("probe_trig", PROBE_ARC_COSINE, y, y.size(), 1, 1);
    const Table between = probe.run("probe_trig", PROBE_ANGLE_BETWEEN, ab, ab.size() / 6, 6, 1);
    TrigErrors sine, cosine, arc, angle;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sine.add(sc[2 * i], std::sin(static_cast<long double>(x[i])), epsilon, x[i]);
      cosine.add(sc[2 * i + 1], std::cos(static_cast<long double>(x[i])), epsilon, x[i]);
    }
    for (std::size_t i = 0; i < y.size(); ++i) arc.add(acos[i], std::acos(static_cast<long double>(y[i])), epsilon, y[i]);
    for (std::size_t i = 0; i < between.size(); ++i) {
      const double* v = &ab[6 * i];
      const Long3 a{v[0], v[1], v[2]}, b{v[3], v[4], v[5]};
      angle.add(between[i], std::atan2(length(cross(a, b)), dot(a, b)), epsilon, static_cast<double>(i));
    }
    const std::string name = precision == Precision::single ? "float" : "double";
    const auto within = [&](const char* function, const TrigErrors& errors, double bound) {
      EXPECT_LE(errors.worst, bound) << function << " in " << name << ", worst at " << errors.at;
      RecordProperty(std::string(function) + "_" + name, std::to_string(errors.worst));
    };
    // what shaders/trig.glsl states
    within("sine", sine, 1);
    within("cosine", cosine, 1);
    within("arc_cosine", arc, 3);
    within("angle_between", angle, 4);
  }
}

// Beyond its range an arc cosine is that of the nearest end, never NaN: rounding takes products of unit vectors there.
TEST_F(ParityLeaf, ArcCosineIsClamped) {
  const Scene scene = three_beakers();
  const LeafProbe probe(*device, scene, 0, Precision::single, OUTLINE_SPECIALIZED);
  const Table answers = probe.run("probe_trig", PROBE_ARC_COSINE, {1.0000001, -1.0000001, 2, -2}, 4, 1, 1);
  EXPECT_EQ(answers[0], 0);
  EXPECT_EQ(answers[2], 0);
  EXPECT_NEAR(answers[1], PI, 4 * FLT_EPSILON);
  EXPECT_NEAR(answers[3], PI, 4 * FLT_EPSILON);
}

// ---- hand ----

TEST_F(ParityLeaf, Hand) {
  const Scene plain = three_beakers();
  const Scene odd = scene_of({beaker1()}, Pose::articulated, odd_hand());
  Builder closures(11), fingers(12), thumbs(13);
  for (int i = 0; i <= 500; ++i) closures.add(i / 500.0);
  for (int i = 0; i < 777; ++i) {
    fingers.frame().point(0.1);
    thumbs.frame();
    for (int k = 0; k < 3; ++k) fingers.uniform(0, 0.07);
    for (int k = 0; k < 3; ++k) thumbs.uniform(0, 0.06);
    for (int k = 0; k < 3; ++k) fingers.uniform(-0.2, 1.8);
    for (int k = 0; k < 3; ++k) thumbs.uniform(-0.2, 1.2);
  }
  for (const Scene* scene : {&plain, &odd}) {
    compare({"probe_hand", PROBE_TRAJECTORY, 1, repeated("angle", 6, 1.6)}, closures.table, *scene);
    compare({"probe_hand", PROBE_TIP_TO_TIP, 1,
             together(repeated("way", 3, REACH), repeated("slope", 3, REACH), repeated("gap", 1, REACH))},
            closures.table, *scene);
    const auto core = make_core_evaluator(*scene);
    Builder gaps(14);
    const double open = core->gap_at(0) / scene->hand.scale, closed = core->gap_at(1) / scene->hand.scale;
    for (int i = 0; i <= 1000; ++i) gaps.add(open + (closed - open) * i / 1000.0);
    compare({.shader = "probe_hand", .probe = PROBE_CLOSURE_OF_GAP, .inputs = 1, .outputs = {{"closure", 1}}, .stopped = {0}},
            gaps.table, *scene);
  }
  Builder ends(15);
  for (int i = 0; i < 777; ++i) {
    ends.frame().point(0.1).add(i % 10 == 0 ? 0 : ends.random.uniform(0, 0.07));
    ends.add(i % 7 == 0 ? (i / 7 % 5 - 2) * PI / 2 : ends.random.uniform(-PI, PI));
  }
  compare({"probe_hand", PROBE_SEGMENT_END, 14, repeated("coordinate", 3, REACH)}, ends.table, plain);
  compare({"probe_hand", PROBE_FINGER_POINTS, 18, repeated("coordinate", 9, REACH)}, fingers.table, plain);
  compare({"probe_hand", PROBE_THUMB_POINTS, 15, repeated("coordinate", 9, REACH)}, thumbs.table, plain);
}

// ---- sdf and contact ----

Leaf distance_leaf() { return {"probe_sdf", PROBE_SIGNED_DISTANCE, 3, {{"distance", REACH}}}; }

// Few points lie on a medial axis, where gradient and nearest element change hands.
Leaf gradient_leaf() {
  return {"probe_sdf", PROBE_GRADIENT, 3, together(repeated("gradient", 3, 1), std::vector<Output>{{"element", 1, true}})};
}

Leaf support_leaf() {
  return {"probe_sdf", PROBE_SUPPORT, 3,
          together(repeated("distance", 2, REACH), repeated("normal", 3, 1),
                   std::vector<Output>{{"element", 1, true}, {"planar", 1, true}})};
}

TEST_F(ParityLeaf, SignedDistance) {
  const Scene scene = vessels_scene();
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const Table table = points_about(scene.vessels[v], 20 + v);
    compare(support_leaf(), table, scene, v);
    if (v != VASE && v != SHELL) continue;  // lines, arcs and hollows are all in these two
    compare(distance_leaf(), table, scene, v);
    compare(gradient_leaf(), table, scene, v);
  }
}

TEST_F(ParityLeaf, GridDistance) {
  const Scene scene = vessels_scene();
  const Table table = points_about(scene.vessels[VASE], 30);
  const Way way{OUTLINE_SPECIALIZED, 40};
  compare(distance_leaf(), table, scene, VASE, way);
  Leaf gradient = gradient_leaf();
  for (int k = 0; k < 3; ++k)
    gradient.outputs[k].scale = REACH / 3e-3;  // a difference of samples over the lattice's spacing, about 3 mm
  compare(gradient, table, scene, VASE, way);
}

// Storage buffer in the loop, uniform buffer copied once, specialization constants: the same arithmetic, so the same bits here. Vulkan
// does not promise that across pipelines: on another driver each is held to the core by the tests above.
TEST_F(ParityLeaf, EverySourceOfTheOutlineGivesTheSameBits) {
  const Scene scene = vessels_scene();
  const bool same_bits = device->info().kind == host::DeviceKind::cpu;
  for (const std::size_t v : {VASE, SHELL}) {
    const Table exact_table = points_about(scene.vessels[v], 40 + v);
    for (const OutlineSource source : {OUTLINE_BUFFER, OUTLINE_HOISTED}) {
      if (v == SHELL) compare(support_leaf(), exact_table, scene, v, {source, 0});
      for (const Precision precision : precisions()) {
        const Table table = rounded(exact_table, precision);
        const Table a =
            LeafProbe(*device, scene, v, precision, source).run("probe_sdf", PROBE_SUPPORT, table, table.size() / 3, 3, 7);
        const Table b = LeafProbe(*device, scene, v, precision, OUTLINE_SPECIALIZED)
                            .run("probe_sdf", PROBE_SUPPORT, table, table.size() / 3, 3, 7);
        if (same_bits) {
          EXPECT_EQ(a, b) << "source " << source;
        }
      }
    }
  }
}

TEST_F(ParityLeaf, SafeStep) {
  Builder build(50);
  for (int i = 0; i < 2000; ++i) {
    const double distance = build.random.uniform(0, 0.1);
    build.add(distance).uniform(distance, 0.2).vec(build.direction()).add(i % 2).uniform(0, 0.1).point(0.2);
    build.add(i % 17 == 0 ? 0 : build.random.uniform(0.2, 0.5)).add(i % 13 == 0 ? 0 : build.random.uniform(0, 1));
  }
  // a step of separation / speed: 0.1 / 0.2; to a plane that is receded from it is longer, and then bounded by what else is there
  compare({.shader = "probe_sdf", .probe = PROBE_SAFE_STEP, .inputs = 12, .outputs = {{"step", 1}}, .fixed = {5, 10}}, build.table,
          three_beakers());
}

TEST_F(ParityLeaf, Contact) {
  const Scene scene = vessels_scene();
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const VesselData& vessel = scene.vessels[v];
    const double radius = largest_radius(vessel);
    Builder build(60 + v);
    for (int i = 0; i < 999; ++i) {
      build.uniform(-1.2 * radius, 1.2 * radius)
          .uniform(-0.05 * vessel.height, 1.05 * vessel.height)
          .uniform(-1.2 * radius, 1.2 * radius);
      build.uniform(5e-3, 9e-3);
    }
    compare({.shader = "probe_sdf",
             .probe = PROBE_CONTACT,
             .inputs = 4,
             .outputs =
                 together(repeated("separation", 1, REACH), repeated("proxy", 3, REACH), std::vector<Output>{{"settled", 1, true}}),
             .stopped = {3}},
            build.table, scene, v);
  }
}

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

// Grips that close, and some for each reason not to. The core's tips are the inputs 6 and 7 larger (0 on the device): a tip's way is as
// good as one that ends with another radius, each side for itself.
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

// ---- projection ----

TEST_F(ParityLeaf, ProjectionPieces) {
  const Scene scene = three_beakers();
  Builder rates(90), turns(91), nearest(92), axes(93), points(94), roles(95);
  for (int i = 0; i < 333; ++i) {
    rates.uniform(0, 1.1).uniform(0, 0.6).uniform(0, 0.3).add(i % 4 - 1);
    turns.frame().point(0.1);
    const double tie = nearest.random.uniform(-0.01, 0.05);
    nearest.add(i % 5 == 0 ? tie : nearest.random.uniform(-0.01, 0.05)).add(i % 7 == 0 ? tie : nearest.random.uniform(-0.01, 0.05));
    nearest.add(i % 3 == 0 ? tie : nearest.random.uniform(-0.01, 0.05)).add(i % 3);
    const Triple mcp{axes.random.uniform(-0.1, 0.1), 0.1, axes.random.uniform(-0.1, 0.1)};
    axes.vec(mcp).add(mcp[0] + (i % 50 == 0 ? 0 : 0.05)).add(mcp[1] + (i % 50 == 0 ? 0 : -0.03)).add(mcp[2]).point(0.2).point(0.2);
    points.point(0.2).point(0.2).vec(points.direction()).uniform(-0.1, 0.1);
  }
  for (int point = 2; point <= 4; ++point)
    for (int before = 0; before < 32; ++before) roles.add(point).add(before);
  compare(
      {.shader = "probe_projection", .probe = PROBE_SEGMENT_RATES, .inputs = 4, .outputs = repeated("rate", 3, 2), .fixed = {3}},
      rates.table, scene);
  compare({"probe_projection", PROBE_QUARTER_TURN, 12, repeated("velocity", 3, REACH)}, turns.table, scene);
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

// All is copied but the room, one difference: equal to the bit but for that. Angles at, before and beyond the joints' limits.
TEST_F(ParityLeaf, TurnJoint) {
  for (const HandData& hand : {HandData{}, odd_hand()}) {
    Builder build(96);
    for (int i = 0; i < 600; ++i) {
      for (const double limit : hand.joint_limit) {
        const double off = i % 4 == 0 ? 0 : i % 4 == 1 ? hand.max_angle : build.random.uniform(-0.2, 1.5);
        build.add(limit - off);
      }
      build.uniform(0, 1).uniform(0, 1).add(i % 5 - 1).uniform(0, 1.5).uniform(0, 0.5).uniform(0, 0.8).add(i % 1025);
      build.point(0.05).add(i % 2).add(i % 3 == 0 ? 1 : 0).add(i / 5 % 4);
    }
    std::vector<Output> outputs = repeated("motion", 15, 2);
    for (std::size_t k = 0; k < outputs.size(); ++k) outputs[k].discrete = k != 8;
    outputs[8].name = "room";
    compare({.shader = "probe_projection", .probe = PROBE_TURN_JOINT, .inputs = 16, .outputs = outputs, .exact = true}, build.table,
            scene_of({beaker1()}, Pose::articulated, hand));
  }
}

// The rows of finger_step whose three points are clear of the vessel: no moving point is ever inside.
Table outside(const Table& table, const Scene& scene, std::size_t v) {
  constexpr std::size_t INPUTS = 24;
  const auto leaves = make_double_leaves(scene, v);
  Table clear;
  for (std::size_t row = 0; row < table.size(); row += INPUTS) {
    std::array<double, 9> points{};
    leaves->evaluate(PROBE_FINGER_POINTS, &table[row], points.data());
    bool all = true;
    for (std::size_t k = 0; k < 3; ++k) {
      double distance = 0;
      leaves->evaluate(PROBE_SIGNED_DISTANCE, &points[3 * k], &distance);
      all = all && distance - table[row + 18 + k] > STOP_TOLERANCE_F32;
    }
    if (all)
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
      for (Builder* build : {&steps, &motions}) build->uniform(0.03, 0.05).uniform(0.02, 0.03).uniform(0.018, 0.022);
      steps.uniform(0, 1.2).uniform(0, 1).uniform(0, 0.6);
      for (Builder* build : {&steps, &motions})
        for (int k = 0; k < 3; ++k) build->uniform(6e-3, 8e-3);
      const int joint = i % 4 - 1;
      steps.add(joint > 0 ? 0 : 1).add(joint > 1 ? 0 : 1.5).add(joint < 0 ? 1.8 : 1);
      motions.uniform(0.2, 1);
      turned.vec(base)
          .uniform(6e-3, 8e-3)
          .vec({base[0] * 1.3, base[1] + 0.05, base[2] * 1.3})
          .vec(turned.direction())
          .uniform(0.05, 0.6);
    }
    // the room that a point has over how fast it goes: a few hundredths of a metre over 0.02 m a unit at least. Which element bounds a step
    // changes with the point: near those changes it may jump
    compare({.shader = "probe_projection", .probe = PROBE_FINGER_STEP, .inputs = 24, .outputs = {{"step", 2}}, .sharp_share = 0.8},
            outside(steps.table, scene, v), scene, v);
    compare({.shader = "probe_projection",
             .probe = PROBE_FINGER_MOTION,
             .inputs = 19,
             .outputs = together(repeated("angle", 3, 2), std::vector<Output>{{"blocked", 1, true}, {"unsettled", 1, true}}),
             .stopped = {15}},
            motions.table, scene, v);
    compare({.shader = "probe_projection",
             .probe = PROBE_PROJECT_POINT,
             .inputs = 11,
             .outputs = together(repeated("coordinate", 3, REACH), std::vector<Output>{{"unsettled", 1, true}}),
             .stopped = {3}},
            turned.table, scene, v);
  }
}

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
  Builder radii(140), crossings(141), pieces(142), revolved(143);
  for (const VesselData& vessel : scene.vessels) {
    for (const PreparedElement& element : prepare_vessel(vessel, true).cavity) {
      revolved.element(element);
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
  compare({.shader = "probe_liquid",
           .probe = PROBE_REVOLVED,
           .inputs = 8,
           .outputs = {{"volume", volume}, {"height", moment}},
           .fixed = {7},
           .takes = rises},
          revolved.table, scene);
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
             .sharp_share = 0.5},  // centres of a film of liquid are as good as unknown
            states.table, scene, v);
  }
}

// ---- force and score ----

TEST_F(ParityLeaf, Force) {
  const Scene scene = three_beakers();
  Builder directions(170), centers(171), torques(172), forces(173), holds(174), couplings(175);
  for (int i = 0; i < 555; ++i) {
    const double tilt = i % 9 == 0 ? 0 : directions.random.uniform(0, PI), s = std::sin(tilt), c = std::cos(tilt);
    const double azimuth = directions.random.uniform(-PI, PI), obliquity = directions.random.uniform(-1, 1);
    const Triple d{std::cos(obliquity) * std::cos(azimuth), std::sin(obliquity), -std::cos(obliquity) * std::sin(azimuth)};
    const Triple pour{-std::sin(azimuth), 0, -std::cos(azimuth)};
    directions.vec(d).add(i % 2 == 0 ? 1 : -1).add(s).add(c);
    centers.point(0.1).uniform(-0.05, 0.05).uniform(0, 0.1).vec(pour);
    torques.uniform(0.05, 0.6).add(9.80665).uniform(0, 0.1).point(0.1).vec(pour).add(s).add(c);
    forces.uniform(0, 2)
        .uniform(0, 5)
        .uniform(0, 0.5)
        .add(i % 11 == 0 ? 0 : forces.random.uniform(0.1, 0.5))
        .uniform(0, 900)
        .uniform(-5e-3, 5e-3)
        .uniform(1, 8);
    holds.uniform(0.05, 0.6)
        .add(9.80665)
        .point(0.1)
        .vec(d)
        .vec({-s * pour[0], c, -s * pour[2]})
        .add(i % 13 == 0 ? 0 : holds.random.uniform(0.3, 0.9))
        .add(i % 17 == 0 ? 0 : holds.random.uniform(2e-3, 9e-3));
    couplings.point(0.1).point(0.1).vec(couplings.direction()).point(1).uniform(0, 900).uniform(0, 5);
  }
  compare({.shader = "probe_force", .probe = PROBE_DIRECTIONS, .inputs = 6, .outputs = repeated("direction", 6, 1), .fixed = {3}},
          directions.table, scene);
  compare({"probe_force", PROBE_LOAD_CENTER, 8, repeated("coordinate", 3, REACH)}, centers.table, scene);
  compare({"probe_force", PROBE_TORQUES, 11, repeated("torque", 3, 0.6 * 9.80665 * 0.2)}, torques.table, scene);
  compare({"probe_force", PROBE_FORCES, 7, {{"normal", 30}, {"opening", 5}, {"feedback", 30}}}, forces.table, scene);
  // largest: its weight over the smallest friction times the arm over the smallest torsion
  // one row in eight has no friction or no torsion, from where the smallest move is out of the infinite
  compare({.shader = "probe_force",
           .probe = PROBE_HOLD_FORCE,
           .inputs = 13,
           .outputs = {{"hold", 6 * 0.2 / (2 * 2e-3) / 0.3}},
           .sharp_share = 0.8},
          holds.table, scene);
  compare({"probe_force", PROBE_COUPLING_FORCE, 14, repeated("force", 3, 900 * 0.4)}, couplings.table, scene);
}

TEST_F(ParityLeaf, Score) {
  Builder build(180);
  for (int i = 0; i < 333; ++i) {
    build.add(i % 6).add(i % 25).uniform(0, 0.02).uniform(0, 0.02).uniform(0, 1).uniform(0, 8).add(i % 9 == 0 ? 0 : 8);
    build.uniform(0, 90).add(40);
  }
  compare({.shader = "probe_force", .probe = PROBE_SCORE, .inputs = 9, .outputs = repeated("term", 6, 1), .fixed = {0, 1, 6}},
          build.table, three_beakers());
}

}  // namespace
}  // namespace wholehand
