// SPDX-License-Identifier: MIT
// Leaf functions of the shaders against the core's (tests/support/leaf_parity.h): trig, hand, distances and contact; those of
// sdf.glsl's elements and lattice and of contact.glsl's proxies are in parity_leaf_sdf_test.cpp.
// sanitizers: none
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <string>
#include <vector>

#include "tests/shaders/probe_table.h"
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
    const LeafProbe probe(*device, scene, 0, precision, OUTLINE_COPIED);
    Builder angles(1), cosines(2), pairs(3), planar(4);
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
    for (int i = 0; i < 10000; ++i) {
      const double turn = i % 2 == 0 ? planar.random.uniform(-PI, PI)
                                     : i % 8 * PI / 4 + (i % 3 - 1) * std::pow(10.0, planar.random.uniform(-9, -1));
      planar.add(std::sin(turn)).add(std::cos(turn));
    }
    for (const double end : {0.0, 1.0, -1.0}) planar.add(end).add(0).add(0).add(end);
    const Table x = rounded(angles.table, precision), y = rounded(cosines.table, precision), ab = rounded(pairs.table, precision),
                yx = rounded(planar.table, precision);
    const Table sc = probe.run("probe_trig", PROBE_SINE_COSINE, x, x.size(), 1, 2);
    const Table acos = probe.run("probe_trig", PROBE_ARC_COSINE, y, y.size(), 1, 1);
    const Table between = probe.run("probe_trig", PROBE_ANGLE_BETWEEN, ab, ab.size() / 6, 6, 1);
    const Table turned = probe.run("probe_trig", PROBE_DIRECTION_ANGLE, yx, yx.size() / 2, 2, 1);
    TrigErrors sine, cosine, arc, angle, turn;
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
    for (std::size_t i = 0; i < turned.size(); ++i) {
      const long double exact = std::atan2(static_cast<long double>(yx[2 * i]), static_cast<long double>(yx[2 * i + 1]));
      turn.add(turned[i], exact, epsilon, static_cast<double>(i));
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
    within("direction_angle", turn, 4);
  }
}

// Beyond its range an arc cosine is that of the nearest end, never NaN: rounding takes products of unit vectors there.
TEST_F(ParityLeaf, ArcCosineIsClamped) {
  const Scene scene = three_beakers();
  const LeafProbe probe(*device, scene, 0, Precision::single, OUTLINE_COPIED);
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

TEST_F(ParityLeaf, LatticeDistance) {
  const Scene scene = vessels_scene();
  const Table table = points_about(scene.vessels[VASE], 30);
  const Way way{OUTLINE_COPIED, 40};
  compare(distance_leaf(), table, scene, VASE, way);
  Leaf gradient = gradient_leaf();
  for (int k = 0; k < 3; ++k)
    gradient.outputs[k].scale = REACH / 3e-3;  // a difference of samples over the lattice's spacing, about 3 mm
  compare(gradient, table, scene, VASE, way);
}

// Read in the loop or copied once: the same arithmetic, so the same bits here. Vulkan does not promise that across pipelines: on another driver
// each is held to the core by the tests above.
TEST_F(ParityLeaf, EverySourceOfTheOutlineGivesTheSameBits) {
  const Scene scene = vessels_scene();
  const bool same_bits = device->info().kind == host::DeviceKind::cpu;
  for (const std::size_t v : {VASE, SHELL}) {
    const Table exact_table = points_about(scene.vessels[v], 40 + v);
    if (v == SHELL) compare(support_leaf(), exact_table, scene, v, {OUTLINE_BUFFER, 0});
    for (const Precision precision : precisions()) {
      const Table table = rounded(exact_table, precision);
      const auto run = [&](OutlineSource source) {
        return LeafProbe(*device, scene, v, precision, source).run("probe_sdf", PROBE_SUPPORT, table, table.size() / 3, 3, 7);
      };
      if (same_bits) {
        EXPECT_EQ(run(OUTLINE_BUFFER), run(OUTLINE_COPIED));
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

}  // namespace
}  // namespace wholehand
