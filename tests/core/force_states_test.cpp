// SPDX-License-Identifier: MIT
// Kernel 7: whole states against the specification in long double, of right hands and of left ones.
#include "core/force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/evaluator.h"
#include "tests/support/scenes.h"
#include "tests/support/special_values.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

// ---- whole states ----

struct ReferenceState {
  long double mass, pivot_length, torque, exact_torque, normal_force, feedback_force, hold_force;
  Long3 center_of_mass;
};

struct Glass {
  long double mass;
  Long3 center;
  long double full_liquid_mass, full_liquid_height;  // upright, at the scene's largest fill
};

// Kernel 7 from the specification, for a right hand.
ReferenceState reference_state(const Scene& scene, const VesselData& vessel, const Glass& glass, const GripInput& grip,
                               const GripResult& result, const LiquidResult& liquid, long double tilt, long double opening) {
  const ForceData& force = scene.force;
  const long double g = scene.gravity;
  const Long3 up_axis{0, 1, 0}, d = rotation_y(grip.azimuth) * (rotation_z(grip.obliquity) * Long3{1, 0, 0});
  const Long3 sideways = cross(up_axis, d);
  const bool towards = scene.liquid && scene.liquid->pour == Pour::towards;
  const Long3 n = ((towards ? -1 : 1) / length(sideways)) * sideways;
  const Long3 M = widened(result.midpoint);

  ReferenceState state{};
  state.mass = glass.mass + liquid.mass;
  const Long3 liquid_center = static_cast<long double>(liquid.lean) * n + static_cast<long double>(liquid.height) * up_axis;
  state.center_of_mass = (1 / state.mass) * (glass.mass * glass.center + static_cast<long double>(liquid.mass) * liquid_center);
  const Long3 arm = state.center_of_mass - M;
  const long double weight = state.mass * g, sine = std::sin(tilt), cosine = std::cos(tilt);
  state.pivot_length = length(arm);
  state.torque = weight * state.pivot_length * sine;
  state.exact_torque = weight * dot(arm, sine * up_axis + cosine * n);

  const long double full_mass = glass.mass + glass.full_liquid_mass;
  const Long3 full_center =
      (1 / full_mass) * (glass.mass * glass.center + (glass.full_liquid_mass * glass.full_liquid_height) * up_axis);
  const long double lever = force.reference == TorqueReference::per_object
                                ? std::max(full_center[1], vessel.height - full_center[1])
                                : std::max(length(full_center - M), 5e-3L);
  const long double reference = full_mass * g * lever;
  const long double entering = force.torque == Torque::exact ? std::abs(state.exact_torque) : state.torque;
  const long double range = vessel.force_range.value_or(force.range);
  state.normal_force = reference > 0 ? force.base + range * entering / reference : force.base;
  state.feedback_force = std::clamp(state.normal_force + force.k_open * opening, 0.0L, static_cast<long double>(force.max));

  const Long3 u = cosine * up_axis - sine * n;
  const long double w = dot(d, u), twist = weight * std::abs(dot(d, cross(arm, u))) / (2 * static_cast<long double>(force.torsion));
  state.hold_force = result.antipodal
                         ? std::sqrt(weight * weight * (1 - w * w) / 4 + twist * twist) / force.friction + weight * std::abs(w) / 2
                         : std::numeric_limits<long double>::infinity();
  return state;
}

void expect_state(const StateResult& state, const ReferenceState& expected, const std::string& where) {
  // each 1e-12 in its unit: rounding of a few products of numbers under 10, the vessel's capacity to 1e-12 among them
  constexpr double TIGHT = 1e-12;
  EXPECT_NEAR(state.mass, double(expected.mass), TIGHT) << where;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(state.center_of_mass[k], double(expected.center_of_mass[k]), TIGHT) << where;
  EXPECT_NEAR(state.pivot_length, double(expected.pivot_length), TIGHT) << where;
  EXPECT_NEAR(state.torque, double(expected.torque), TIGHT) << where;
  EXPECT_NEAR(state.exact_torque, double(expected.exact_torque), TIGHT) << where;
  EXPECT_NEAR(state.normal_force, double(expected.normal_force), 1e-11) << where;  // N: torques over references of 0.1 N m
  EXPECT_NEAR(state.feedback_force, double(expected.feedback_force), 1e-11) << where;
  if (std::isinf(expected.hold_force)) {
    EXPECT_EQ(state.hold_force, INFINITE) << where;
  } else {
    EXPECT_NEAR(state.hold_force, double(expected.hold_force), 1e-10) << where;  // N: moments over gamma of 5 mm and mu
  }
}

// A cylinder whose liquid upright is in closed form, its glass given and off the axis.
Scene lopsided_scene() {
  Scene scene = three_beakers();
  scene.vessels = {lopsided()};
  scene.liquid->fills = {0, 0.3, 0.8};
  scene.tilts = linspace(0, PI, 13);
  return scene;
}

Glass lopsided_glass() {
  const long double volume = 3.14159265358979323846L * 38.5e-3L * 38.5e-3L * 108.5e-3L * 0.8L;
  return {0.2, {7e-3, 45e-3, -4e-3}, 1000 * volume, 1.5e-3L + 0.8L * 108.5e-3L / 2};
}

TEST(Force, StatesAreTheSpecificationsForEveryTorqueReferenceAndPour) {
  int feasible = 0, without_hold = 0;
  for (const Torque torque : {Torque::paper, Torque::exact}) {
    for (const TorqueReference reference : {TorqueReference::per_object, TorqueReference::per_grip}) {
      for (const Pour pour : {Pour::away, Pour::towards}) {
        Scene scene = lopsided_scene();
        scene.force.torque = torque;
        scene.force.reference = reference;
        scene.liquid->pour = pour;
        scene.force.friction = 0.3;
        scene.force.torsion = 7e-3;
        const auto evaluator = make_core_evaluator(scene);
        for (const GripInput& grip : sample_grips(scene.vessels[0], 25, 9)) {
          GripResult result;
          evaluator->grip(0, grip, result);
          if (result.reason != Reason::none) continue;
          ++feasible;
          without_hold += !result.antipodal;
          for (const double fill : scene.liquid->fills) {
            for (const double tilt : scene.tilts) {
              const LiquidResult liquid = evaluator->liquid(0, fill, tilt);
              for (const double opening : {0.0, 4e-3, -4e-3}) {
                expect_state(evaluator->state(0, grip, result, liquid, tilt, opening),
                             reference_state(scene, scene.vessels[0], lopsided_glass(), grip, result, liquid, tilt, opening),
                             std::to_string(feasible) + " fill " + std::to_string(fill) + " tilt " + std::to_string(degrees(tilt)));
              }
            }
          }
        }
      }
    }
  }
  EXPECT_GT(feasible, 80);
  EXPECT_GT(without_hold, 20);
}

TEST(Force, StatesOfTheDefaultScene) {
  // the glass of beaker1 in closed form: a hollow cylinder with a floor
  const long double pi = 3.14159265358979323846L;
  const long double outer = pi * 40e-3L * 40e-3L * 110e-3L, inner = pi * 38.5e-3L * 38.5e-3L * 108.5e-3L;
  const Glass glass{
      2230 * (outer - inner), {0, (outer * 55e-3L - inner * 55.75e-3L) / (outer - inner), 0}, 1000 * inner, 55.75e-3L};
  const Scene scene = three_beakers();
  const auto evaluator = make_core_evaluator(scene);
  int feasible = 0;
  for (const GripInput& grip : sample_grips(scene.vessels[0], 25, 10)) {
    GripResult result;
    evaluator->grip(0, grip, result);
    if (result.reason != Reason::none) continue;
    ++feasible;
    for (const double fill : scene.liquid->fills) {
      for (const double tilt : scene.tilts) {
        const LiquidResult liquid = evaluator->liquid(0, fill, tilt);
        expect_state(evaluator->state(0, grip, result, liquid, tilt),
                     reference_state(scene, scene.vessels[0], glass, grip, result, liquid, tilt, 0),
                     std::to_string(feasible) + " fill " + std::to_string(fill) + " tilt " + std::to_string(degrees(tilt)));
      }
    }
  }
  EXPECT_GT(feasible, 10);
}

TEST(Force, WithoutLiquidTheReferenceIsThatOfTheEmptyGlass) {
  Scene scene = lopsided_scene();
  scene.liquid.reset();
  const auto evaluator = make_core_evaluator(scene);
  const Glass glass{0.2, {7e-3, 45e-3, -4e-3}, 0, 0};
  GripInput grip;
  grip.height = 60e-3;
  grip.azimuth = 0.4;
  GripResult result;
  evaluator->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  for (const double tilt : scene.tilts) {
    expect_state(evaluator->state(0, grip, result, LiquidResult{}, tilt),
                 reference_state(scene, scene.vessels[0], glass, grip, result, LiquidResult{}, tilt, 0), std::to_string(tilt));
  }
}

TEST(Force, GripAtTheCenterOfMassHasAFiveMillimeterReference) {
  Scene scene = scene_of({beaker1()});
  scene.vessels[0].mass = 0.2;
  scene.vessels[0].center_of_mass = {0, 50e-3, 0};
  scene.tilts = {0, PI / 2};
  scene.force.reference = TorqueReference::per_grip;
  const auto evaluator = make_core_evaluator(scene);
  GripInput grip;
  grip.height = 52e-3;  // 2 mm above it, and 0.5 mm beside: half the difference of the tips' radii of 8 and 7 mm
  GripResult result;
  evaluator->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  // 1e-6 N: the tips stand where tracing stopped, to 1e-9 m of 5 mm, of a range of 2 N
  EXPECT_NEAR(evaluator->state(0, grip, result, {}, PI / 2).normal_force, 0.8 + 2 * std::hypot(2e-3, 0.5e-3) / 5e-3, 1e-6);
}

TEST(Force, WithoutGravityTheNormalForceIsTheBase) {
  Scene scene = lopsided_scene();
  scene.gravity = 0;
  const auto evaluator = make_core_evaluator(scene);
  GripInput grip;
  grip.height = 60e-3;
  GripResult result;
  evaluator->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  for (const TorqueReference reference : {TorqueReference::per_object, TorqueReference::per_grip}) {
    scene.force.reference = reference;
    const StateResult state = make_core_evaluator(scene)->state(0, grip, result, evaluator->liquid(0, 0.8, 1), 1);
    EXPECT_EQ(state.torque, 0);
    EXPECT_EQ(state.normal_force, 0.8);
    EXPECT_EQ(state.feedback_force, 0.8);
    EXPECT_EQ(state.hold_force, 0);
  }
}

TEST(Force, VesselsOwnRangeComesBeforeTheScenes) {
  Scene scene = three_beakers();
  scene.force.range = 1;
  scene.vessels[1].force_range.reset();
  const auto evaluator = make_core_evaluator(scene);
  for (std::size_t v : {0, 1}) {
    GripInput grip;
    grip.height = 50e-3;
    GripResult result;
    evaluator->grip(v, grip, result);
    ASSERT_EQ(result.reason, Reason::none);
    const LiquidResult full = evaluator->liquid(v, 1, 0);
    // at 90 degrees with what it held upright, per_object: the reference is that load's longest lever
    const StateResult state = evaluator->state(v, grip, result, full, PI / 2);
    const double y = state.center_of_mass[1], lever = std::max(y, scene.vessels[v].height - y);
    EXPECT_NEAR(state.normal_force, 0.8 + (v == 0 ? 2 : 1) * state.pivot_length / lever, 1e-11) << v;
  }
}

TEST(Force, PourTowardsLeansTheLiquidTheOtherWay) {
  Scene scene = three_beakers();
  GripInput grip;
  grip.height = 50e-3;  // line along +x: away is -z
  for (const Pour pour : {Pour::away, Pour::towards}) {
    scene.liquid->pour = pour;
    const auto evaluator = make_core_evaluator(scene);
    GripResult result;
    evaluator->grip(0, grip, result);
    const LiquidResult liquid = evaluator->liquid(0, 0.5, 0.6);
    ASSERT_GT(liquid.lean, 1e-3);
    const StateResult state = evaluator->state(0, grip, result, liquid, 0.6);
    EXPECT_EQ(state.center_of_mass[0], 0);
    EXPECT_NEAR(state.center_of_mass[2], (pour == Pour::away ? -1 : 1) * liquid.lean * liquid.mass / state.mass, 1e-15);
  }
}

// ---- left hands ----

Triple mirrored_point(const Triple& point) { return {-point[0], point[1], point[2]}; }

void expect_mirrored(const Triple& left, const Triple& right, const char* what) {
  const Triple expected = mirrored_point(right);
  // 1e-9 m: two iterative solves that differ by rounding of the azimuth stop within twice 1e-9 of each other
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(left[k], expected[k], 1e-9) << what << " " << k;
}

TEST(Force, LeftHandIsTheRightHandInTheMirroredScene) {
  Scene left_scene = lopsided_scene();
  left_scene.hand.handedness = Handedness::left;
  Scene right_scene = lopsided_scene();
  right_scene.vessels[0].center_of_mass = mirrored_point(right_scene.vessels[0].center_of_mass);
  const auto left = make_core_evaluator(left_scene), right = make_core_evaluator(right_scene);
  EXPECT_EQ(left->empty_center_of_mass(0), left_scene.vessels[0].center_of_mass);  // as given, in the world
  int feasible = 0;
  for (const GripInput& grip : sample_grips(left_scene.vessels[0], 20, 11)) {
    GripResult l, r;
    left->grip(0, grip, l);
    right->grip(0, mirrored_grip(grip), r);
    ASSERT_EQ(l.reason, r.reason);
    if (l.reason != Reason::none) continue;
    ++feasible;
    EXPECT_NEAR(l.closure, r.closure, 1e-7);  // 1e-9 m of gap over a slope of 0.1 m
    EXPECT_NEAR(l.gap, r.gap, 1e-9);
    EXPECT_EQ(l.used_mask, r.used_mask);
    EXPECT_EQ(l.antipodal, r.antipodal);
    expect_mirrored(l.midpoint, r.midpoint, "midpoint");
    for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
      expect_mirrored(l.joints[j], r.joints[j], "joint");
    }
    for (const double tilt : {0.0, 0.5, 1.4}) {
      const LiquidResult liquid = left->liquid(0, 0.8, tilt);
      const StateResult ls = left->state(0, grip, l, liquid, tilt), rs = right->state(0, mirrored_grip(grip), r, liquid, tilt);
      expect_mirrored(ls.center_of_mass, rs.center_of_mass, "center of mass");
      EXPECT_NEAR(ls.torque, rs.torque, 1e-8);  // N m, N: weights of 6 N times 1e-9 m; gamma of 5 mm divides the last
      EXPECT_NEAR(ls.exact_torque, rs.exact_torque, 1e-8);
      EXPECT_NEAR(ls.feedback_force, rs.feedback_force, 1e-6);
      if (l.antipodal) {
        EXPECT_NEAR(ls.hold_force, rs.hold_force, 1e-5);
      }
    }
  }
  EXPECT_GT(feasible, 8);
}

TEST(Force, LeftHandsMidpointLiesOnItsLineInTheWorld) {
  Scene scene = lopsided_scene();
  scene.hand = left_hand();
  const auto evaluator = make_core_evaluator(scene);
  GripInput grip;
  grip.height = 60e-3;
  grip.offset = 10e-3;
  grip.azimuth = 0.3;
  GripResult result;
  evaluator->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  // o = (0, h, 0) + s unit(d x y), d = (cos a, 0, -sin a); tips of 8 and 7 mm touch a cylinder of 40 on circles of 48 and 47 mm
  const double along = (std::sqrt(47e-3 * 47e-3 - 1e-4) - std::sqrt(48e-3 * 48e-3 - 1e-4)) / 2;
  EXPECT_NEAR(result.midpoint[0], 10e-3 * std::sin(0.3) + along * std::cos(0.3), 1e-8);  // m: tracing stops at 1e-9
  EXPECT_NEAR(result.midpoint[1], 60e-3, 1e-8);
  EXPECT_NEAR(result.midpoint[2], 10e-3 * std::cos(0.3) - along * std::sin(0.3), 1e-8);
  const Triple& thumb = result.joints[THUMB_TIP];
  const Triple& index = result.joints[INDEX_TIP];
  EXPECT_NEAR((index[0] - thumb[0]) / result.gap, std::cos(0.3), 1e-6);  // the line still runs from thumb to index along d
  EXPECT_NEAR((index[2] - thumb[2]) / result.gap, -std::sin(0.3), 1e-6);
}

}  // namespace
}  // namespace wholehand
