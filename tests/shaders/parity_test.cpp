// SPDX-License-Identifier: MIT
// The whole way of a grip on a device against the core, in float and in double; that a broken constant, or a hand moved by
// micrometers, is noticed. Sanitized runs have the same way in parity_shortcuts_test.cpp.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/absent.h"
#include "core/counted_tilts.h"
#include "core/hand_size.h"
#include "core/people/person.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/compare.h"
#include "host/grip_backend.h"
#include "sweeps/plan/plan.h"
#include "sweeps/plan/variables.h"
#include "tests/support/scenes.h"
#include "tests/support/vulkan_listener.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

using host::GripBackend;
using host::GripBackendOptions;

TEST(Parity, ArticulatedHand) {
  expect_parity(wet_scene({beaker1(), beaker2(), beaker3(), shell_of(beaker3()), vase(), facets()}, Pose::articulated),
                "articulated");
}

// Wide ranges by Sobol points: off the axis, in hands of several sizes, a shell's rim, a near-empty glass.
TEST(Parity, SobolScene) {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  for (VesselData& vessel : scene.vessels) vessel.surface = Surface::shell;
  scene.liquid->fills = {0.01, 1};
  scene.tilts = linspace(0, PI, 5);
  const auto range = [](Axis& axis, double from, double to) { axis = {{from, to}, true}; };
  range(scene.grips.height, 0.02, 1.1);
  range(scene.grips.azimuth, -PI, PI);
  range(scene.grips.obliquity, -1, 1);
  range(scene.grips.roll, -PI, PI);
  range(scene.grips.offset, -0.03, 0.03);
  range(scene.grips.hand_scale, 0.8, 1.3);
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 512;
  const sweeps::Plan plan(scene, true);
  const FieldSet fields = compared_fields(scene);
  const auto truth = make_core_evaluator(scene);
  for (const Precision precision : {Precision::single, Precision::full}) {
    const auto backend = backend_of(scene, fields, precision);
    Comparer comparer(scene, *truth, allowance(precision));
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      std::vector<GripInput> grips(plan.grips());
      plan.fill(v, 0, grips.size(), grips.data());
      comparer.add(v, grips, gather(*backend, v, grips), gather(*truth, fields, v, grips));
    }
    EXPECT_GT(3 * comparer.feasible(), comparer.grips());
    EXPECT_TRUE(comparer.holds()) << table_of(comparer);
  }
}

TEST(Parity, PaperPoseExactTorquePerGrip) {
  Scene scene = wet_scene({beaker1(), beaker2(), beaker3()}, Pose::paper);
  scene.force.torque = Torque::exact;
  scene.force.reference = TorqueReference::per_grip;
  expect_parity(scene, "paper");
}

TEST(Parity, RiggedHandPouringTowards) {
  Scene scene = wet_scene({beaker1(), beaker2(), beaker3()}, Pose::rigged);
  scene.force.reference = TorqueReference::per_grip;
  scene.liquid->pour = Pour::towards;
  expect_parity(scene, "rigged");
}

TEST(Parity, LeftHandOffCenterVessel) {
  Scene scene = wet_scene({lopsided(), beaker2()}, Pose::articulated, left_hand());
  scene.force.torque = Torque::exact;
  expect_parity(scene, "left");
}

TEST(Parity, HandsOnATable) {
  Scene scene = wet_scene({beaker1(), vase()}, Pose::articulated, left_hand());
  scene.table = TableData{5e-3};
  expect_parity(scene, "table");
  scene = scene_of({ledges()}, Pose::paper, odd_hand());
  scene.table = TableData{0};
  scene.vessels[0].base = -10e-3;
  expect_parity(scene, "table_paper");
}

TEST(Parity, HandsOnArms) {
  Scene scene = wet_scene({beaker1(), lopsided(), vase()}, Pose::articulated, left_hand());
  scene.table = TableData{5e-3};
  scene.arm.emplace();
  scene.arm->shoulder = {-0.15, 0.3, 0.45};
  expect_parity(scene, "arm");
  scene = scene_of({ledges()}, Pose::paper, odd_hand());
  scene.arm.emplace();
  scene.vessels[0].base = -10e-3;
  expect_parity(scene, "arm_paper");
}

TEST(Parity, SpheresBetweenJoints) {
  Scene scene = wet_scene({beaker1(), beaker2(), shell_of(beaker3())}, Pose::articulated);
  scene.hand.between = 2;
  expect_parity(scene, "between");
  scene = wet_scene({vase()}, Pose::articulated, left_hand());
  scene.hand.between = 8;
  scene.table = TableData{5e-3};
  expect_parity(scene, "between_left");
  for (const Pose pose : {Pose::paper, Pose::rigged}) {
    scene = scene_of({ledges()}, pose, odd_hand());
    scene.hand.between = pose == Pose::paper ? 1 : 3;
    expect_parity(scene, "between_" + std::to_string(scene.hand.between));
  }
}

// A short and narrow hand, and a long and broad one.
TEST(Parity, HandsOfPeople) {
  for (const auto& [sex, percentile] : {std::pair{Sex::female, 5}, std::pair{Sex::male, 95}}) {
    HandData hand = paper_hand();
    set_size(hand, surveyed_size(sex, percentile));
    expect_parity(wet_scene({beaker1(), beaker3()}, Pose::articulated, hand), "person" + std::to_string(percentile));
  }
}

// A hand with proportions of its own, whose trajectories may end early: the first of the population that is so, and the first that
// is not.
TEST(Parity, HandsOfAPopulation) {
  bool has_early = false, has_whole = false;
  for (std::uint64_t number = 0; !(has_early && has_whole); ++number) {
    ASSERT_LT(number, 100u);
    const HandData plain, hand = hand_of(plain, draw_person({}, 1, number));
    bool& has = hand.mcp.closed != plain.mcp.closed ? has_early : has_whole;
    if (!has) expect_parity(wet_scene({beaker1(), beaker3()}, Pose::articulated, hand), "population" + std::to_string(number));
    has = true;
  }
}

// Another hand in every number, vessels without a cavity, no liquid, no tilts.
TEST(Parity, OddHandDryAndUntilted) {
  expect_parity(scene_of({ledges()}, Pose::articulated, odd_hand()), "odd");
  Scene tilted = scene_of({ledges()}, Pose::paper, odd_hand());
  tilted.tilts = linspace(0, PI, 7);
  expect_parity(tilted, "odd_tilted");
}

// More states than a block of the force kernel holds: fills are cut in the middle, and go on from where they were cut.
TEST(Parity, StatesOfManyBlocks) {
  Scene scene = wet_scene({beaker2()}, Pose::rigged);
  scene.tilts = linspace(0, PI, 300);
  scene.force.max = scene.force.base + 0.3 * scene.force.range;  // so that safe tilts end within a fill
  expect_parity(scene, "many", 60);
  scene.liquid.reset();
  scene.tilts = linspace(0, PI, 600);
  expect_parity(scene, "many_dry", 60);
}

// States that are left out: of liquid by the device and by the core, within a block of the force kernel and in all of one.
TEST(Parity, TiltsUntilTheLiquidIsOut) {
  Scene scene = wet_scene({beaker1(), beaker2(), facets()}, Pose::articulated);
  for (const double share : {0.3, 1.0}) {
    scene.until_poured = share;
    expect_parity(scene, "until_poured");
  }
  Scene many = wet_scene({beaker2()}, Pose::rigged);
  many.tilts = linspace(0, PI, 600);
  many.until_poured = 0.5;
  many.force.max = many.force.base + 0.3 * many.force.range;  // so that safe tilts end among those that count
  expect_parity(many, "many_until_poured", 60);
  ASSERT_LT(2 * 600 + counted_tilts(many, 0)[2], 6u * STATES_IN_BLOCK) << "the seventh block is left out, all of it";
  const FieldSet fields = all_fields(many);
  const auto grips = grips_of(many, 0, 60);
  for (const Precision precision : {Precision::single, Precision::full}) {
    const auto backend = backend_of(many, fields, precision);
    const GatheredPlanes planes = gather(*backend, 0, grips);
    EXPECT_EQ(describe(misplaced_values(many, 0, fields, planes.count, planes.count, planes.reals.data(), planes.uints.data())),
              "");
  }
}

TEST(Parity, LatticeDistance) {
  const Scene scene = scene_of({beaker2()});
  const FieldSet fields = all_fields(scene);
  const auto grips = grips_of(scene, 0, 100);
  for (const int bits : {32, 16}) {
    GripBackendOptions options;
    options.evaluator.lattice_samples = 64;
    options.evaluator.lattice_bits = bits;
    const auto backend = backend_of(scene, fields, Precision::full, options);
    const auto core = make_core_evaluator(scene, options.evaluator);
    Comparer comparer(scene, *core, allowance(Precision::full));
    comparer.add(0, grips, gather(*backend, 0, grips), gather(*core, fields, 0, grips));
    EXPECT_TRUE(comparer.holds()) << bits << " bits\n" << table_of(comparer);
  }
}

// ---- what must be noticed ----

// Whether planes of `broken`, by the device or by the core in float, pass for the core's of `scene`.
bool passes(const Scene& scene, const Scene& broken, bool device) {
  const FieldSet fields = all_fields(scene);
  const auto truth = make_core_evaluator(scene), core = make_core_float_evaluator(scene);
  const auto grips = grips_of(scene, 0, COUNT);
  Comparer comparer(scene, *truth, allowance(Precision::single));
  const auto against = [&](const GatheredPlanes& planes, const std::vector<LiquidResult>& liquid) {
    comparer.add(0, grips, planes, gather(*core, fields, 0, grips));
    comparer.add_liquid(0, liquid, core_liquid(scene, *core, 0));
  };
  if (device) {
    const auto backend = backend_of(broken, fields, Precision::single);
    against(gather(*backend, 0, grips), backend->liquid(0));
  } else {
    const auto other = make_core_float_evaluator(broken);
    against(gather(*other, fields, 0, grips), core_liquid(broken, *other, 0));
  }
  return comparer.holds();
}

TEST(Parity, AConstantBrokenOnOneSideIsNoticed) {
  const Scene scene = wet_scene({beaker2()}, Pose::articulated);
  EXPECT_TRUE(passes(scene, scene, true));
  EXPECT_TRUE(passes(scene, scene, false));
  Scene tolerance = scene, radius = scene, segment = scene, gravity = scene, density = scene, wall = scene, friction = scene,
        limit = scene;
  tolerance.hand.contact_tolerance += 50e-6;
  radius.hand.fingers[3].radii[4] += 50e-6;
  segment.hand.fingers[2].segments[2] += 50e-6;
  gravity.gravity = 9.81;
  density.liquid->density = 998;
  wall.vessels[0].wall += 5e-6;
  friction.force.friction += 1e-3;
  limit.hand.max_angle -= radians(1);
  EXPECT_FALSE(passes(scene, tolerance, true)) << "contact tolerance";
  EXPECT_FALSE(passes(scene, radius, true)) << "a fingertip's radius";
  EXPECT_FALSE(passes(scene, segment, false)) << "a segment's length";
  EXPECT_FALSE(passes(scene, gravity, false)) << "gravity";
  EXPECT_FALSE(passes(scene, density, false)) << "density of the liquid";
  EXPECT_FALSE(passes(scene, wall, false)) << "wall";
  EXPECT_FALSE(passes(scene, friction, false)) << "friction";
  EXPECT_FALSE(passes(scene, limit, false)) << "a joint's largest turn";
  Scene some = scene;
  some.until_poured = 0.5;
  EXPECT_TRUE(passes(some, some, true));
  EXPECT_FALSE(passes(some, scene, true)) << "states that are left out";
  EXPECT_FALSE(passes(scene, some, false)) << "states that are not left out";
}

// A joint out of place by 20 um is noticed, one coordinate of it alone too, and in nearly every grip; noise of single precision is
// not.
TEST(Parity, ShiftsAreNoticedAndNoiseIsNot) {
  const Scene scene = wet_scene({beaker3()}, Pose::articulated);
  const FieldSet fields = all_fields(scene);
  const auto truth = make_core_evaluator(scene);
  const auto grips = grips_of(scene, 0, COUNT);
  const GatheredPlanes planes = gather(*truth, fields, 0, grips);
  std::size_t feasible = 0;
  for (std::size_t i = 0; i < grips.size(); ++i)
    feasible += (planes.uint(FIELD_STATUS, i) & STATUS_REASON_MASK) == REASON_NONE ? 1 : 0;
  ASSERT_GT(feasible, 100u);
  const auto compared = [&](Precision precision, const GatheredPlanes& other) {
    Comparer comparer(scene, *truth, allowance(precision));
    comparer.add(0, grips, other, planes);
    return comparer;
  };

  for (const int joint : {0, THUMB_TIP, INDEX_TIP, 13, 18, 23}) {
    GatheredPlanes shifted = planes;
    for (std::size_t i = 0; i < grips.size(); ++i)
      shifted.reals[(fields.plane[FIELD_POSED] + 3 * joint + 1) * planes.count + i] += 20e-6;
    for (const Precision precision : {Precision::single, Precision::full}) {
      const Comparer comparer = compared(precision, shifted);
      EXPECT_FALSE(comparer.holds());
      // those that it passes are grips in which a finger ends at grazing incidence
      const auto row = std::ranges::find(comparer.rows(), "posed joints", &Comparison::quantity);
      ASSERT_NE(row, comparer.rows().end());
      EXPECT_GE(10 * row->outside, (precision == Precision::single ? 8 : 10) * feasible) << "joint " << joint;
    }
  }

  const auto noisy = [&](auto change) {
    GatheredPlanes other = planes;
    Random random(7);
    for (const int field : {FIELD_MIDPOINT, FIELD_JOINTS, FIELD_POSED, FIELD_SEPARATION, FIELD_PROXIES})
      for (int p = 0; p < field_planes(field, scene_fills(scene), scene.tilts.size()); ++p)
        for (std::size_t i = 0; i < grips.size(); ++i) {
          double& value = other.reals[(fields.plane[field] + p) * other.count + i];
          value = change(value, random);
        }
    return other;
  };
  const GatheredPlanes rounded = noisy([](double value, Random&) { return static_cast<double>(static_cast<float>(value)); });
  const GatheredPlanes hissing = noisy([](double value, Random& random) { return value + random.uniform(-1e-7, 1e-7); });
  EXPECT_TRUE(compared(Precision::single, rounded).holds());
  EXPECT_TRUE(compared(Precision::single, hissing).holds());
  EXPECT_FALSE(compared(Precision::full, hissing).holds());
}

}  // namespace
}  // namespace wholehand
