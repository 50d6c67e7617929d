// SPDX-License-Identifier: MIT
// How a vessel slides and turns between two tips, against the physics engine.
// sanitizers: none
#include "device/session/slide.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "evidence/trials/held_body.h"
#include "tests/support/contact_rig.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::ContactPoint;
using core_f64::HandStrength;
using core_f64::Vec2;
using core_f64::Vec3;

// Two tips press along x on a body of 0.3 kg, with a share of the force that holds it. Its center of mass lies beside their line, by (y, z), and its
// weight points along -y, turned about x by `tilt`.
struct SlidingCase {
  double share = 0.5, gamma = 5e-3;  // m
  Vec2 lever{};                      // m
  double tilt = 0;                   // rad
};

constexpr double SLID_MASS = 0.3, SLID_MU = 0.6, SLIDES_FOR = 0.1;  // kg, 1, s

Vec2 slid_weight(const SlidingCase& of) { return SLID_MASS * G * Vec2(-std::cos(of.tilt), std::sin(of.tilt)); }

double holding_force(const SlidingCase& of) {
  const Vec2 weight = slid_weight(of);
  const double moment = of.lever.x * weight.y - of.lever.y * weight.x;
  return std::hypot(glm::length(weight), moment / of.gamma) / (2 * SLID_MU);
}

struct Slid {
  Vec2 moved{};                // of the center of mass, m
  double turned = 0;           // rad
  device::SlideMotion motion;  // at the end
};

Slid by_engine(const SlidingCase& of) {
  HandStrength hand{SLID_MU, of.gamma, {}};
  hand.digits.fill(1e3);
  const std::vector<ContactPoint> tips{{Vec3(-0.04, 0, 0), Vec3(1, 0, 0), 0}, {Vec3(0.04, 0, 0), Vec3(-1, 0, 0), 1}};
  const Vec3 center(0, of.lever.x, of.lever.y);
  const double force = of.share * holding_force(of);
  const Vec2 weight = slid_weight(of);
  HeldBody body(load_mujoco(), rig_setup(tips, hand, {SLID_MASS, center, false}));
  press_and_release(body, {force, force}, Vec3(0, weight.x, weight.y));
  const int steps = static_cast<int>(std::lround(SLIDES_FOR / TIME_STEP));
  for (int k = 0; k < steps; ++k) body.step();
  const Vec3 moved = body.moved(center) - center;
  const auto rotation = body.rotation();
  return {{moved.y, moved.z}, std::atan2(rotation[7], rotation[8]), {}};
}

Slid by_model(const SlidingCase& of) {
  device::SlidingBody body{SLID_MASS, SLID_MASS * 0.08 * 0.08 / 6, of.lever};
  const device::SlideFriction friction = device::slide_friction(of.share * holding_force(of), 0, SLID_MU, of.gamma);
  Slid slid;
  constexpr double TICK = 1e-3;
  for (int k = 0; k < std::lround(SLIDES_FOR / TICK); ++k) {
    const device::SlideStep step = device::slide_step(body, slid_weight(of), friction, TICK, slid.motion);
    slid.moved += step.moved;
    slid.turned += step.turned;
    body.lever += step.moved;
  }
  return slid;
}

// The two may differ by the way of one step of the engine, which moves by the velocity at a step's end, and by what its soft contacts give.
TEST(SlidingLaw, GoesAsTheEngine) {
  constexpr double SOFT = 0.05e-3, SOFT_TURN = radians(0.05);  // m; 0.05 mm over the cube's 40 mm is 0.07 degrees
  const std::array<SlidingCase, 10> cases{{{1.02},
                                           {0.95},
                                           {0.5},
                                           {0},
                                           {0.9, 5e-3, {0, 10e-3}},
                                           {0.5, 5e-3, {0, 10e-3}},
                                           {0.2, 5e-3, {0, -20e-3}},
                                           {0.5, 20e-3, {-20e-3, 10e-3}},
                                           {0.5, 1e-3, {-20e-3, 0}, radians(45)},
                                           {0.7, 5e-3, {20e-3, 5e-3}, radians(120)}}};
  int slid = 0, turned = 0;
  for (const SlidingCase& of : cases) {
    SCOPED_TRACE(testing::Message() << "case " << (&of - cases.data()));
    const Slid engine = by_engine(of), model = by_model(of);
    EXPECT_NEAR(engine.moved.x, model.moved.x, TIME_STEP * std::abs(model.motion.velocity.x) + SOFT);
    EXPECT_NEAR(engine.moved.y, model.moved.y, TIME_STEP * std::abs(model.motion.velocity.y) + SOFT);
    EXPECT_NEAR(engine.turned, model.turned, TIME_STEP * std::abs(model.motion.spin) + SOFT_TURN);
    EXPECT_EQ(of.share >= 1, model.motion.is_rest());
    slid += glm::length(model.moved) > 10 * SOFT;
    turned += std::abs(model.turned) > 10 * SOFT_TURN;
  }
  EXPECT_EQ(slid, 9);
  EXPECT_EQ(turned, 6);
}

}  // namespace
}  // namespace wholehand
