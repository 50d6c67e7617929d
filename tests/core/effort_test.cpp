// SPDX-License-Identifier: MIT
// Kernel 10 against closed forms: loads whose answer follows from statics by hand.
#include "core/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/held.h"
#include "core/scene.h"

namespace wholehand {
namespace {

using core_f64::ContactPoint;
using core_f64::Effort;
using core_f64::EffortSolver;
using core_f64::HandStrength;
using core_f64::Vec3;
using core_f64::Wrench;
using core_f64::wrench_at;

constexpr double MU = 0.6, GAMMA = 5e-3, HALF_SPAN = 0.04, WEIGHT = 2.5;
constexpr double NEVER_HELD = std::numeric_limits<double>::infinity();

// Every contact its own digit of strength 1: the effort is then the largest normal force, N. One digit for all: their sum.
HandStrength unit_strength(double friction = MU, double torsion = GAMMA) { return {friction, torsion, {1, 1, 1, 1, 1, 1}}; }

std::vector<ContactPoint> of_one_digit(std::vector<ContactPoint> contacts) {
  for (ContactPoint& contact : contacts) contact.digit = 0;
  return contacts;
}

// Two tips on a level line along x. `lean`: of the walls, which narrow upwards.
std::vector<ContactPoint> two_tips(double lean = 0) {
  const double c = std::cos(lean), s = std::sin(lean);
  return {{{HALF_SPAN, 0, 0}, {-c, -s, 0}, 0}, {{-HALF_SPAN, 0, 0}, {c, -s, 0}, 1}};
}

// At 0, 120 and 240 degrees round a cylinder's axis y; the first at +x.
std::vector<ContactPoint> three_round_a_cylinder() {
  std::vector<ContactPoint> contacts;
  for (int k = 0; k < 3; ++k) {
    const double angle = radians(120.0 * k), c = std::cos(angle), s = std::sin(angle);
    contacts.push_back({{HALF_SPAN * c, 0, HALF_SPAN * s}, {-c, 0, -s}, k});
  }
  return contacts;
}

// At the named tolerance the bracket holds the answer and is as narrow as it says; asked as finely as double bears, both ends are the answer. Where
// a smooth cone takes more than EFFORT_PIVOTS for that, the bracket is wider, and still holds the answer.
void expect_effort(const std::vector<ContactPoint>& contacts, const HandStrength& hand, const Wrench& load, double answer,
                   const std::string& what) {
  SCOPED_TRACE(what);
  for (const double tolerance : {core_f64::EFFORT_TOLERANCE, 1e-9}) {
    EffortSolver solver(contacts, hand, {0.001, 0.002, -0.003});
    const Effort found = solver.solve(load, tolerance);
    if (std::isinf(answer)) {
      EXPECT_TRUE(std::isinf(found.effort)) << found.effort;
      EXPECT_TRUE(std::isinf(found.low)) << found.low;
      continue;
    }
    // an artificial column costs 1e6, so that a direction's worth rounds at 1e6 x 2^-53, times some hundred of a basis of near points
    const double rounding = 1e-7 * answer;
    EXPECT_LE(found.low, answer + rounding);
    EXPECT_GE(found.effort, answer - rounding);
    if (found.pivots < core_f64::EFFORT_PIVOTS) {
      EXPECT_LE(found.effort - found.low, tolerance * found.effort + rounding);
    }
    EXPECT_NEAR(found.effort, answer, 2e-3 * answer);
  }
}

Wrench weight_at(Vec3 center) { return wrench_at(center, {0, -WEIGHT, 0}); }

// The center of mass in the plane of symmetry: the two-tip formula of kernel 7, whose normals lie along the line of the tips.
TEST(Effort, OfTwoTipsIsTheHoldForce) {
  for (const double below : {0.0, 0.005, 0.02, 0.05})
    for (const double tilt : {0.0, 20.0, 45.0, 90.0, 160.0}) {
      const Vec3 arm(0, -below, 0);
      const Vec3 up = core_f64::up_direction({0, 0, -1}, std::sin(radians(tilt)), std::cos(radians(tilt)));
      const double hold = core_f64::hold_force(WEIGHT, 1, arm, {1, 0, 0}, up, MU, GAMMA);
      expect_effort(two_tips(), unit_strength(), wrench_at(arm, -WEIGHT * up), hold,
                    std::to_string(below) + " " + std::to_string(tilt));
    }
}

// The nearer tip carries more: N = mg (1/2 + s / 2a) / mu.
TEST(Effort, OfTwoTipsGrowsOffTheMiddle) {
  for (const double off : {-0.03, 0.0, 0.01, 0.03})
    expect_effort(two_tips(), unit_strength(), weight_at({off, 0, 0}), WEIGHT * (0.5 + std::abs(off) / (2 * HALF_SPAN)) / MU,
                  std::to_string(off));
}

// A wall that leans by phi and narrows upwards pushes the tips off: N = mg / (2 (mu cos phi - sin phi)), none from tan phi = mu on.
TEST(Effort, OnALeaningWall) {
  for (const double lean : {-0.3, 0.1, 0.4, 0.5})
    expect_effort(two_tips(lean), unit_strength(), weight_at({}), WEIGHT / (2 * (MU * std::cos(lean) - std::sin(lean))),
                  std::to_string(lean));
  for (const double lean : {std::atan(MU) + 1e-3, 0.7})
    expect_effort(two_tips(lean), unit_strength(), weight_at({}), NEVER_HELD, std::to_string(lean));
}

// Along the axis the three share mg / mu. Away from one contact the other two carry: each mg / (1 + mu sqrt 3). Onto a contact it alone does
// with the least sum, and where the largest counts the other two help by friction against their normals.
TEST(Effort, OfThreeRoundACylinder) {
  const auto three = three_round_a_cylinder();
  const double root = std::sqrt(3.0);
  expect_effort(three, unit_strength(), weight_at({}), WEIGHT / MU / 3, "axis, largest");
  expect_effort(of_one_digit(three), unit_strength(), weight_at({}), WEIGHT / MU, "axis, sum");
  const Wrench away = wrench_at({}, {-WEIGHT, 0, 0}), onto = wrench_at({}, {WEIGHT, 0, 0});
  expect_effort(three, unit_strength(), away, WEIGHT / (1 + MU * root), "away, largest");
  expect_effort(of_one_digit(three), unit_strength(), away, WEIGHT / (0.5 + MU * root / 2), "away, sum");
  expect_effort(of_one_digit(three), unit_strength(), onto, WEIGHT, "onto, sum");
  // contact 0 gives N, the others N' each along their normals -1/2 and friction mu sqrt 3 / 2: more by mu sqrt 3 - 1 > 0
  expect_effort(three, unit_strength(), onto, WEIGHT / (1 + (MU * root - 1)), "onto, largest");
}

// Nobody pulls.
TEST(Effort, FromOneSideIsNever) {
  const std::vector<ContactPoint> contacts{
      {{HALF_SPAN, 0, 0}, {-1, 0, 0}, 0}, {{HALF_SPAN, 0.02, 0}, {-1, 0, 0}, 1}, {{HALF_SPAN, 0.02, 0.01}, {-1, 0, 0}, 2}};
  expect_effort(contacts, unit_strength(), weight_at({}), NEVER_HELD, "three");
  expect_effort({}, unit_strength(), weight_at({}), NEVER_HELD, "none");
}

// A vessel that stands on a finger: its weight, as long as it stands above it.
TEST(Effort, OnAFingerBelow) {
  const std::vector<ContactPoint> below{{{0, -0.05, 0}, {0, 1, 0}, 3}};
  expect_effort(below, unit_strength(), weight_at({}), WEIGHT, "above it");
  expect_effort(below, unit_strength(), weight_at({0.03, 0, 0}), NEVER_HELD, "beside it");
}

TEST(Effort, WithoutFrictionOrTorsion) {
  expect_effort(two_tips(), unit_strength(0), weight_at({}), NEVER_HELD, "mu 0");
  expect_effort(two_tips(), unit_strength(MU, 0), weight_at({0, -0.02, 0}), WEIGHT / (2 * MU), "below the line");
  expect_effort(two_tips(), unit_strength(MU, 0), weight_at({0, -0.02, 0.01}), NEVER_HELD, "beside it nothing resists the turn");
}

// A load on tips beside their line by a lever: held as without the lever up to a thousandth of the way from their middle, or of 5 mm, and by
// nothing beyond.
TEST(Effort, OfTipsWithoutTorsionALeverIsNoneOrHeldByNothing) {
  auto tips = two_tips();
  for (ContactPoint& tip : tips) tip.is_tip = true;
  const double answer = WEIGHT / (2 * MU);
  for (const double below : {0.0, 1e-3, 0.05, 0.3}) {
    const double longest = 1e-3 * std::max(5e-3, below);
    const auto load = [&](double lever) { return weight_at({0, -below, lever}); };
    const std::string where = "below " + std::to_string(below) + ", lever ";
    const double without = EffortSolver(tips, unit_strength(MU, 0), {}).solve(load(0)).effort;
    for (const double lever : {1e-12, 1e-11, 1e-9, 1e-6, 0.999 * longest})
      for (const double side : {lever, -lever}) {
        expect_effort(tips, unit_strength(MU, 0), load(side), answer, where + std::to_string(side));
        EXPECT_NEAR(EffortSolver(tips, unit_strength(MU, 0), {}).solve(load(side)).effort, without, 1e-9 * answer);
      }
    for (const double lever : {1.001 * longest, 2 * longest, 0.1})
      for (const double side : {lever, -lever})
        expect_effort(tips, unit_strength(MU, 0), load(side), NEVER_HELD, where + std::to_string(side));
  }
}

// A third contact turns the vessel about the line of the tips in one sense alone: what the tips hold, it leaves held.
TEST(Effort, WithoutTorsionMoreContactsLeaveALeverNone) {
  std::vector<ContactPoint> contacts = two_tips();
  for (ContactPoint& tip : contacts) tip.is_tip = true;
  contacts.push_back({{0, -0.003, 0.024}, {0, 0.8, -0.6}, 2});
  for (const double lever : {1e-11, 1e-9, 1e-6, 4.9e-6})
    for (const double side : {lever, -lever})
      EXPECT_LE(EffortSolver(contacts, unit_strength(MU, 0), {}).solve(weight_at({0, 0, side})).effort, WEIGHT / (2 * MU) * 1.001)
          << side;
}

// Contacts that are not two tips carry the shortest lever.
TEST(Effort, WithoutTorsionOtherContactsCarryALever) {
  const auto three = three_round_a_cylinder();
  EffortSolver solver(three, unit_strength(MU, 0), {});
  const Wrench load = weight_at({1e-6, -0.02, 1e-6});
  EXPECT_NEAR(solver.solve(load).effort, WEIGHT / MU / 3, 2e-3 * WEIGHT);
  std::vector<core_f64::ContactForce> forces(three.size());
  solver.forces(forces);
  Vec3 moment = load.moment;
  for (std::size_t i = 0; i < three.size(); ++i) moment += glm::cross(three[i].place, forces[i].force);
  EXPECT_LT(glm::length(moment), 1e-9 * WEIGHT);
}

// A smooth wall that two weak digits hold with 25 times the load each: held, however strong the digits are that do not touch.
TEST(Effort, StrengthOfDigitsThatDoNotPressChangesNothing) {
  constexpr double SMOOTH = 0.02;
  const auto tips = two_tips();
  for (const double strength : {0.1, 10000.0}) {
    HandStrength hand{SMOOTH, GAMMA, {0.1, 0.1, 14, 35, strength, strength}};
    EffortSolver solver(tips, hand, {});
    EXPECT_NEAR(solver.solve(weight_at({})).effort, WEIGHT * 25 / 0.1, 2e-3 * WEIGHT * 25 / 0.1) << strength;
    hand.digits[1] = strength;
    EffortSolver uneven(tips, hand, {});
    EXPECT_NEAR(uneven.solve(weight_at({})).effort, WEIGHT * 25 / 0.1, 2e-3 * WEIGHT * 25 / 0.1) << strength;
  }
}

// The thumb presses against the middle between index and middle finger on a plate, which hangs by friction; no contact turns. Statics: half of the
// weight hangs on each side, each finger carries a quarter W / 4, and the thumb's effort is N = W / 2 mu at least. Shares s and 1 - s of N turn the
// plate by d (2 s - 1) N about the vertical, against a level force F on each side over the plate's thickness h. A finger's friction leaves
// sqrt((mu s N)^2 - (W / 4)^2) for F, and the thumb's is as much as both fingers' with equal shares.
TEST(Effort, SharesOfTwoFingersOppositeTheThumb) {
  const double apart = 0.01, thickness = 0.003, room = 1.2, press = room * WEIGHT / (2 * MU);
  const std::vector<ContactPoint> contacts{{{0, 0, -thickness / 2}, {0, 0, 1}, 0},
                                           {{-apart, 0, thickness / 2}, {0, 0, -1}, 1},
                                           {{apart, 0, thickness / 2}, {0, 0, -1}, 2}};
  const auto level = [&](double share) {
    return std::sqrt(std::max(0.0, std::pow(MU * share * press, 2) - std::pow(WEIGHT / 4, 2)));
  };
  double answer = 0.5,
         beyond = 1 - WEIGHT / 4 / (MU * press);  // there the weaker finger carries its quarter by all of its friction
  for (int k = 0; k < 60; ++k) {
    const double middle = (answer + beyond) / 2;
    (apart * (2 * middle - 1) * press <= thickness * (level(middle) + level(1 - middle)) ? answer : beyond) = middle;
  }
  ASSERT_GT(answer, 0.52);
  ASSERT_LT(answer, 0.58);
  const HandStrength hand{MU, 0, {1, 5, 5, 5, 5, 5}};
  const Wrench load = wrench_at({}, {0, -WEIGHT, 0});
  for (const int digit : {1, 2}) {
    for (const double off : {-1e-3, 1e-3}) {  // far beyond the bracket of 1e-6, which moves the answer by some 1e-5
      const double effort = press, most = answer + off;
      for (const core_f64::ShareBound& bound : {core_f64::ShareBound{digit, most, true}, {digit, 1 - most, false}}) {
        EffortSolver solver(contacts, hand, {});
        solver.set_share(bound);
        const Effort found = solver.solve(load, 1e-6);
        EXPECT_EQ(found.effort <= effort, off < 0) << digit << " " << bound.share;
        EXPECT_EQ(found.low <= effort, off < 0) << digit << " " << bound.share;
      }
    }
  }
}

TEST(Effort, NothingToHoldIsNoEffort) {
  EffortSolver solver({}, unit_strength(), {});
  const Effort found = solver.solve({});
  EXPECT_EQ(found.effort, 0);
  EXPECT_EQ(found.low, 0);
}

// The forces of three contacts add up to the weight, each within its cone.
TEST(Effort, ForcesBalanceTheLoad) {
  const auto three = three_round_a_cylinder();
  const Wrench load = weight_at({0.005, -0.02, 0.004});
  EffortSolver solver(three, unit_strength(), {});
  const Effort found = solver.solve(load);
  std::vector<core_f64::ContactForce> forces(three.size());
  solver.forces(forces);
  Vec3 force = load.force, moment = load.moment;
  for (std::size_t i = 0; i < three.size(); ++i) {
    force += forces[i].force;
    moment += glm::cross(three[i].place, forces[i].force) + forces[i].torsion * three[i].normal;
    const double normal = glm::dot(forces[i].force, three[i].normal);
    const double across = glm::length(forces[i].force - normal * three[i].normal), spin = forces[i].torsion / GAMMA;
    EXPECT_LE(std::hypot(across, spin), MU * normal * (1 + 1e-12));
    EXPECT_LE(normal, found.effort * (1 + 1e-12));
  }
  EXPECT_LT(glm::length(force), 1e-9 * WEIGHT);
  EXPECT_LT(glm::length(moment), 1e-9 * WEIGHT);
}

}  // namespace
}  // namespace wholehand
