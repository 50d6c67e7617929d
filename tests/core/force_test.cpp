// SPDX-License-Identifier: MIT
// Kernel 7: the leaves against numbers worked out by hand, derivatives and searches.
#include "core/force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/held.h"
#include "tests/support/scenes.h"
#include "tests/support/special_values.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

// Rounding of a handful of products of numbers under 10.
constexpr double ROUNDING = 1e-14;

Vec3 random_arm(Random& random) {
  return Vec3(random.uniform(-0.05, 0.05), random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05));
}

Vec3 up_at(Vec3 pour, double tilt) { return core_f64::up_direction(pour, std::sin(tilt), std::cos(tilt)); }

double potential(double mass, Vec3 arm, Vec3 pour, double tilt) { return mass * G * glm::dot(arm, up_at(pour, tilt)); }

// ---- directions ----

TEST(Force, PourDirectionIsHorizontalAcrossTheLine) {
  const Vec3 along_x = core_f64::pour_direction({1, 0, 0}, 1);
  EXPECT_EQ(along_x, Vec3(0, 0, -1));  // the hand in front at +z, the vessel pours towards -z
  EXPECT_EQ(core_f64::pour_direction({1, 0, 0}, -1), Vec3(0, 0, 1));
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec3 d = random_unit(random), n = core_f64::pour_direction(d, 1);
    EXPECT_EQ(n.y, 0);
    EXPECT_NEAR(glm::length(n), 1, 1e-15);
    EXPECT_NEAR(glm::dot(n, d), 0, 1e-15);
    EXPECT_GT(glm::dot(glm::cross(Vec3(0, 1, 0), d), n), 0);
    EXPECT_EQ(core_f64::pour_direction(d, -1), -n);
  }
}

TEST(Force, UpDirectionTurnsFromTheAxisAgainstThePour) {
  const Vec3 n(0.6, 0, -0.8);
  EXPECT_EQ(up_at(n, 0), Vec3(0, 1, 0));
  EXPECT_NEAR(glm::distance(up_at(n, PI / 2), -n), 0, 1e-15);
  EXPECT_NEAR(glm::distance(up_at(n, PI), Vec3(0, -1, 0)), 0, 1e-15);
  EXPECT_NEAR(glm::distance(up_at(n, PI / 6), Vec3(-0.3, std::sqrt(0.75), 0.4)), 0, 1e-15);
}

TEST(Force, LoadCenterIsTheFixedPartAndTheLiquidsShare) {
  core_f64::Load load;
  load.fixed = {0.001, 0.02, -0.003};
  load.lean = 0.005;
  load.height = 0.03;
  EXPECT_NEAR(glm::distance(core_f64::load_center(load, {0.6, 0, -0.8}), Vec3(0.004, 0.05, -0.007)), 0, 1e-17);
}

// ---- torques ----

TEST(Force, PaperTorqueByHand) {
  // 0.5 kg, 40 mm: m g L = 0.5 x 9.80665 x 0.04 = 0.196133 N m
  const auto torque = [](double degree) { return core_f64::pendulum_torque(0.5, G, 0.04, std::sin(radians(degree))); };
  EXPECT_EQ(torque(0), 0);
  EXPECT_NEAR(torque(30), 0.0980665, ROUNDING);
  EXPECT_NEAR(torque(90), 0.196133, ROUNDING);
  EXPECT_NEAR(torque(150), 0.0980665, ROUNDING);
  EXPECT_NEAR(torque(180), 0, ROUNDING);
}

TEST(Force, ExactTorqueByHand) {
  // the center 30 mm above and 40 mm towards the pour: 0.5 x 9.80665 x (0.03 sin t + 0.04 cos t)
  const Vec3 n(0, 0, -1), arm(0, 0.03, -0.04);
  const auto torque = [&](double degree) {
    return core_f64::exact_pendulum_torque(0.5, G, arm, n, std::sin(radians(degree)), std::cos(radians(degree)));
  };
  EXPECT_NEAR(torque(0), 0.196133, ROUNDING);
  EXPECT_NEAR(torque(30), 0.5 * G * (0.015 + 0.04 * std::sqrt(0.75)), ROUNDING);
  EXPECT_NEAR(torque(90), 0.14709975, ROUNDING);
  EXPECT_NEAR(torque(180), -0.196133, ROUNDING);
}

TEST(Force, ExactTorqueIsMinusThePotentialsDerivativeByTheTilt) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 n = core_f64::pour_direction(random_unit(random), 1), arm = random_arm(random);
    const double tilt = random.uniform(0, PI), mass = random.uniform(0.05, 0.6), step = 1e-5;
    const double slope = (potential(mass, arm, n, tilt + step) - potential(mass, arm, n, tilt - step)) / (2 * step);
    // 1e-9 N m: the third derivative is the torque again, 0.7 N m, times step^2 / 6; rounding 1e-16 / step
    EXPECT_NEAR(core_f64::exact_pendulum_torque(mass, G, arm, n, std::sin(tilt), std::cos(tilt)), -slope, 1e-9) << i;
  }
}

TEST(Force, TorqueIsPositiveWhereTheVesselTopplesFurther) {
  const Vec3 n(0, 0, -1);
  const double s = std::sin(0.3), c = std::cos(0.3);
  EXPECT_GT(core_f64::exact_pendulum_torque(0.3, G, {0, 0.05, 0}, n, s, c), 0);   // held under the center of mass: topples
  EXPECT_LT(core_f64::exact_pendulum_torque(0.3, G, {0, -0.05, 0}, n, s, c), 0);  // held above: hangs and pulls back
  EXPECT_GT(core_f64::exact_pendulum_torque(0.3, G, {0, 0, -0.01}, n, s, c), 0);  // liquid that has run towards the pour
}

TEST(Force, ExactTorqueIsThePapersWhenCenterAndPivotLieOnTheAxis) {
  for (const double height : {-0.06, -0.01, 0.0, 0.02, 0.07}) {
    for (double degree = 0; degree <= 180; degree += 15) {
      const double s = std::sin(radians(degree)), c = std::cos(radians(degree));
      EXPECT_NEAR(std::abs(core_f64::exact_pendulum_torque(0.3, G, {0, height, 0}, {0.6, 0, 0.8}, s, c)),
                  core_f64::pendulum_torque(0.3, G, std::abs(height), s), ROUNDING)
          << height << " " << degree;
    }
  }
}

// ---- what is rendered ----

TEST(Force, NormalForceGrowsByItsRangeAtTheReference) {
  EXPECT_DOUBLE_EQ(core_f64::normal_force(0.8, 3, 0, 0.2), 0.8);
  EXPECT_DOUBLE_EQ(core_f64::normal_force(0.8, 3, 0.1, 0.2), 2.3);
  EXPECT_DOUBLE_EQ(core_f64::normal_force(0.8, 3, 0.2, 0.2), 3.8);
  EXPECT_DOUBLE_EQ(core_f64::normal_force(0.8, 3, 0.4, 0.2), 6.8);
}

TEST(Force, NormalForceIsTheBaseWithoutAReference) {
  EXPECT_EQ(core_f64::normal_force(0.8, 3, 0.1, 0), 0.8);
  EXPECT_EQ(core_f64::normal_force(0.8, 3, 0, 0), 0.8);
}

TEST(Force, GripReferenceTakesNoPivotShorterThanFiveMillimeters) {
  EXPECT_DOUBLE_EQ(core_f64::grip_reference(0.5, G, 0.04), 0.196133);
  EXPECT_DOUBLE_EQ(core_f64::grip_reference(0.5, G, 0.005), 0.5 * G * 0.005);
  EXPECT_DOUBLE_EQ(core_f64::grip_reference(0.5, G, 0.004), 0.5 * G * 0.005);
  EXPECT_DOUBLE_EQ(core_f64::grip_reference(0.5, G, 0), 0.5 * G * 0.005);
  EXPECT_EQ(core_f64::grip_reference(0, G, 0.04), 0);
}

TEST(Force, OpeningTermIsASpring) {
  EXPECT_DOUBLE_EQ(core_f64::opening_force(600, 5e-3), 3);  // the 3 N of 5 mm
  EXPECT_EQ(core_f64::opening_force(600, 0), 0);
  EXPECT_DOUBLE_EQ(core_f64::opening_force(600, -2e-3), -1.2);
}

TEST(Force, FeedbackIsClampedAtZeroAndAtTheLargest) {
  EXPECT_DOUBLE_EQ(core_f64::feedback_force(2, 1.5, 8), 3.5);
  EXPECT_EQ(core_f64::feedback_force(0.8, -1.2, 8), 0);
  EXPECT_EQ(core_f64::feedback_force(6, 3, 8), 8);
  EXPECT_EQ(core_f64::feedback_force(8, 0, 8), 8);
  EXPECT_EQ(core_f64::feedback_force(2, 1, 0), 0);
}

// ---- what the physics asks for ----

struct Held {
  double mass;
  Vec3 arm, direction, up;
  double friction, torsion;
};

// The smallest grip force by search: gravity along the line loads one contact and relieves the other by half of it each, the load
// across and the moment about the line are shared in halves, and both contacts must stay inside their limit surfaces.
double searched_hold_force(const Held& held) {
  const double weight = held.mass * G, along = glm::dot(held.direction, held.up);
  const double across = glm::length(weight * (held.up - along * held.direction)) / 2;
  const double moment = std::abs(glm::dot(held.direction, glm::cross(held.arm, weight * held.up))) / 2;
  const auto holds = [&](double grip) {
    for (const double side : {-1, 1}) {
      const double normal = grip + side * along * weight / 2;
      if (normal < 0) return false;
      const double slip = across / (held.friction * normal), twist = moment / (held.friction * held.torsion * normal);
      if (slip * slip + twist * twist > 1) return false;
    }
    return true;
  };
  double low = 0, high = 1e4;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

double hold_force(const Held& h) { return core_f64::hold_force(h.mass, G, h.arm, h.direction, h.up, h.friction, h.torsion); }

TEST(Force, HoldForceIsTheSmallestInsideBothLimitSurfaces) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Held held{random.uniform(0.02, 0.6), random_arm(random),       random_unit(random),
                    random_unit(random),       random.uniform(0.2, 1.2), random.uniform(1e-3, 2e-2)};
    const double found = searched_hold_force(held);
    EXPECT_NEAR(hold_force(held), found, 1e-12 * std::max(found, 1.0)) << i;  // N: rounding of forces up to 1e3 N
  }
}

// The published numbers, N at mm; nothing is known beyond the first and the last.
TEST(Force, StrengthFollowsTheMeasuredGrips) {
  const std::array<double, 4> strengths{231, 236, 208, 158};
  for (std::size_t k = 0; k < 4; ++k) {
    const double opening = 38.1e-3 + 12.7e-3 * static_cast<double>(k);
    EXPECT_NEAR(core_f64::strength_at(opening), strengths[k] / 236, ROUNDING) << k;
    if (k == 3) continue;
    for (const double share : {0.25, 0.5, 0.9}) {
      const double between = (1 - share) * strengths[k] + share * strengths[k + 1];
      EXPECT_NEAR(core_f64::strength_at(opening + share * 12.7e-3), between / 236, ROUNDING) << k << " " << share;
    }
  }
  for (const double narrow : {0.0, 0.01, 0.038}) EXPECT_NEAR(core_f64::strength_at(narrow), 231.0 / 236, ROUNDING);
  for (const double wide : {0.0763, 0.1, 1.0}) EXPECT_NEAR(core_f64::strength_at(wide), 158.0 / 236, ROUNDING);
}

TEST(Force, HoldForceAcrossTheLineIsHalfTheWeightOverFriction) {
  EXPECT_NEAR(hold_force({0.3, {0, 0.05, 0}, {1, 0, 0}, {0, 1, 0}, 0.6, 5e-3}), 0.3 * G / 1.2, ROUNDING);
}

TEST(Force, HoldForceAlongTheLineIsHalfTheWeight) {
  EXPECT_NEAR(hold_force({0.3, {0.02, 0.05, 0}, {0, 1, 0}, {0, 1, 0}, 0.6, 5e-3}), 0.3 * G / 2, ROUNDING);
  EXPECT_NEAR(hold_force({0.3, {0.02, 0.05, 0}, {0, -1, 0}, {0, 1, 0}, 0.6, 5e-3}), 0.3 * G / 2, ROUNDING);
}

TEST(Force, HoldForceOfAMomentAloneByHand) {
  // 50 mm lever across the line, weight 1 N: each contact carries 0.5 N and 25 N mm; on a radius of 5 mm those are 5 N
  const double mass = 1 / G;
  EXPECT_NEAR(hold_force({mass, {0, 0, 0.05}, {1, 0, 0}, {0, 1, 0}, 0.5, 5e-3}), std::sqrt(0.25 + 25) / 0.5, ROUNDING);
}

TEST(Force, HoldForceWithoutFrictionIsInfinite) {
  EXPECT_EQ(hold_force({0.3, {0, 0.05, 0}, {1, 0, 0}, {0, 1, 0}, 0, 5e-3}), INFINITE);
}

TEST(Force, HoldForceWithoutTorsionTakesNoMoment) {
  EXPECT_EQ(hold_force({0.3, {0, 0, 0.05}, {1, 0, 0}, {0, 1, 0}, 0.6, 0}), INFINITE);
  // a lever up to a thousandth of the pivot length, or of the least one, is none
  for (const double pivot : {0.0, 1e-3, 0.05, 2.0}) {
    const double longest = 1e-3 * std::max(pivot, 5e-3);
    for (const double lever : {0.0, 0.5 * longest, 0.999 * longest})
      EXPECT_DOUBLE_EQ(hold_force({0.3, {0, pivot, lever}, {1, 0, 0}, {0, 1, 0}, 0.6, 0}), 0.3 * G / 1.2) << pivot << " " << lever;
    EXPECT_EQ(hold_force({0.3, {0, pivot, 1.001 * longest}, {1, 0, 0}, {0, 1, 0}, 0.6, 0}), INFINITE) << pivot;
  }
  EXPECT_EQ(hold_force({0, {0, 0, 0.05}, {1, 0, 0}, {0, 1, 0}, 0.6, 0}), 0);
  EXPECT_EQ(hold_force({0.3, {0, 0.05, 0}, {1, 0, 0}, {0, 1, 0}, 0, 0}), INFINITE);
}

// Forces beyond the largest number, whichever division passes it.
TEST(Force, HoldForceOfTheLeastFrictionAndTorsionIsNeverNaN) {
  for (const double friction : {0.0, 5e-324, 1e-300, 1e-9})
    for (const double torsion : {0.0, 5e-324, 1e-300, 1e-9})
      for (const double lever : {0.0, 1e-12, 0.05}) {
        const double hold = hold_force({1e6, {0, 0.05, lever}, {1, 0, 0}, {0, 1, 0}, friction, torsion});
        EXPECT_GT(hold, 1e12) << friction << " " << torsion << " " << lever;
      }
}

TEST(Force, HoldForceOfNothingAcrossTheLineNeedsNoFriction) {
  EXPECT_EQ(hold_force({0, {0, 0.05, 0}, {1, 0, 0}, {0, 1, 0}, 0.6, 5e-3}), 0);
  EXPECT_EQ(hold_force({0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, 5e-3}), 0);
  EXPECT_DOUBLE_EQ(hold_force({0.3, {0, 0, 0}, {0, 1, 0}, {0, 1, 0}, 0, 5e-3}), 0.3 * G / 2);
}

// ---- before the grasp ----

TEST(Force, CouplingPushesATipThatIsInsideBackToItsProxy) {
  // 2 mm deep along +x at 800 N/m
  const Vec3 force = core_f64::coupling_force({0.038, 0, 0}, {0.04, 0, 0}, {1, 0, 0}, {0, 0, 0}, 800, 1);
  EXPECT_NEAR(glm::distance(force, Vec3(1.6, 0, 0)), 0, ROUNDING);
}

TEST(Force, CouplingDampsOnlyAlongTheNormal) {
  const Vec3 still = core_f64::coupling_force({0.038, 0, 0}, {0.04, 0, 0}, {1, 0, 0}, {0, 0.3, -0.2}, 800, 1);
  EXPECT_NEAR(glm::distance(still, Vec3(1.6, 0, 0)), 0, ROUNDING);
  const Vec3 entering = core_f64::coupling_force({0.038, 0, 0}, {0.04, 0, 0}, {1, 0, 0}, {-0.5, 0.3, 0}, 800, 1);
  EXPECT_NEAR(glm::distance(entering, Vec3(2.1, 0, 0)), 0, ROUNDING);
  const Vec3 leaving = core_f64::coupling_force({0.038, 0, 0}, {0.04, 0, 0}, {1, 0, 0}, {0.5, 0.3, 0}, 800, 1);
  EXPECT_NEAR(glm::distance(leaving, Vec3(1.1, 0, 0)), 0, ROUNDING);
}

TEST(Force, CouplingNeverPulls) {
  // leaving faster than the spring pushes
  EXPECT_EQ(core_f64::coupling_force({0.038, 0, 0}, {0.04, 0, 0}, {1, 0, 0}, {3, 0, 0}, 800, 1), Vec3(0, 0, 0));
  EXPECT_EQ(core_f64::coupling_force({0.05, 0, 0}, {0.05, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, 800, 1), Vec3(0, 0, 0));
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const Vec3 n = random_unit(random), tip = random_arm(random);
    const Vec3 proxy = tip + random.uniform(0, 0.005) * n;
    const Vec3 velocity = random.uniform(0, 3) * random_unit(random);
    EXPECT_GE(glm::dot(core_f64::coupling_force(tip, proxy, n, velocity, 800, 1), n), -ROUNDING) << i;
  }
}

}  // namespace
}  // namespace wholehand
