// SPDX-License-Identifier: MIT
// Kernel 7 in the hand is kernel 7 of a sweep: one piece, asked both ways.
// sanitizers: address
#include "core/held.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/closure.h"
#include "core/evaluator.h"
#include "core/load.h"
#include "core/vectors.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

void expect_same(double a, double b, const char* what) {
  if (std::isinf(b)) {
    EXPECT_EQ(a, b) << what;
  } else {
    EXPECT_NEAR(a, b, 1e-12 * std::max(1.0, std::abs(b))) << what;  // the same formulas, rounded in another order
  }
}

TEST(HeldForces, AreThoseOfASweepsState) {
  for (const Torque torque : {Torque::paper, Torque::exact}) {
    for (const TorqueReference reference : {TorqueReference::per_object, TorqueReference::per_grip}) {
      for (const Pour pour : {Pour::away, Pour::towards}) {
        Scene scene = three_beakers();
        scene.vessels.push_back(lopsided());
        scene.force.torque = torque;
        scene.force.reference = reference;
        scene.liquid->pour = pour;
        const auto evaluator = make_core_evaluator(scene);
        int feasible = 0, open_ended = 0;
        for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
          const core_f64::Vessel vessel = ready_vessel(scene.vessels[v], true);
          core_f64::ForceScale scale = core_f64::load_force(scene, scene.vessels[v]);
          const LiquidResult most = evaluator->liquid(v, scene.liquid->fills.back(), 0);
          const core_f64::Load largest = core_f64::load_with(vessel, most.mass, most.lean, most.height);
          scale.reference = core_f64::object_reference(largest, scale.gravity, 0, scene.vessels[v].height);
          for (const GripInput& grip : sample_grips(scene.vessels[v], 25, 31 + v)) {
            GripResult result;
            evaluator->grip(v, grip, result);
            if (result.reason != Reason::none) continue;
            ++feasible;
            open_ended += !result.antipodal;
            const Vec3 direction = core_f64::grip_direction(grip.azimuth, grip.obliquity);
            for (const double fill : {0.0, 0.4, 1.0}) {
              for (const double tilt : {0.0, 0.3, 1.2, 2.4, PI}) {
                for (const double squeeze : {-2e-3, 0.0, 3e-3}) {
                  const LiquidResult liquid = evaluator->liquid(v, fill, tilt);
                  const StateResult state = evaluator->state(v, grip, result, liquid, tilt, squeeze);
                  const core_f64::HeldForces held = core_f64::held_forces(
                      scale, core_f64::load_with(vessel, liquid.mass, liquid.lean, liquid.height), largest, direction,
                      to_vec3(result.midpoint), core_f64::pour_direction(direction, pour == Pour::towards ? -1 : 1), std::sin(tilt),
                      std::cos(tilt), result.antipodal, squeeze);
                  expect_same(held.pivot_length, state.pivot_length, "pivot");
                  expect_same(held.torque, state.torque, "torque");
                  expect_same(held.exact_torque, state.exact_torque, "exact torque");
                  expect_same(held.normal, state.normal_force, "normal force");
                  expect_same(held.feedback, state.feedback_force, "feedback");
                  expect_same(held.hold, state.hold_force, "hold force");
                  expect_same(held.opening, scene.force.k_open * squeeze, "opening force");
                  EXPECT_NEAR(glm::length(held.center - to_vec3(state.center_of_mass)), 0, 1e-15);
                }
              }
            }
          }
        }
        EXPECT_GT(feasible, 30);
        EXPECT_GT(open_ended, 0);
      }
    }
  }
}

// Two masses: the center lies between them as they divide the whole.
TEST(LoadWith, IsTheMassWeightedCenter) {
  core_f64::Vessel vessel;
  vessel.mass = 0.3;
  vessel.center_of_mass = Vec3(0.01, 0.05, -0.02);
  const Vec3 pour(0.6, 0, 0.8);
  const core_f64::Load load = core_f64::load_with(vessel, 0.2, 0.03, 0.08);
  const Vec3 expected = (0.3 * vessel.center_of_mass + 0.2 * (0.03 * pour + Vec3(0, 0.08, 0))) / 0.5;
  EXPECT_NEAR(glm::length(core_f64::load_center(load, pour) - expected), 0, 1e-17);
  EXPECT_EQ(load.mass, 0.5);
  vessel.mass = 0;  // nothing at all
  EXPECT_EQ(core_f64::load_with(vessel, 0, 0, 0).mass, 0);
  EXPECT_EQ(core_f64::load_center(core_f64::load_with(vessel, 0, 1, 1), pour), vessel.center_of_mass);
}

TEST(ObjectReference, IsAboutTheFartherEnd) {
  core_f64::Load load;
  load.mass = 2;
  load.fixed = Vec3(0, 0.02, 0);
  load.height = 0.01;
  EXPECT_NEAR(core_f64::object_reference(load, 10, 0, 0.1), 2 * 10 * 0.07, 1e-15);
  EXPECT_NEAR(core_f64::object_reference(load, 10, 0, 0.05), 2 * 10 * 0.03, 1e-15);
  EXPECT_NEAR(core_f64::object_reference(load, 10, -0.06, 0.1), 2 * 10 * 0.09, 1e-15);
}

}  // namespace
}  // namespace wholehand
