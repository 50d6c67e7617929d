// SPDX-License-Identifier: MIT
// Kernel 10 over the states of a grip, against every state solved by itself from nothing.
#include "core/grip_effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/counted_tilts.h"
#include "core/evaluator.h"
#include "core/planes.h"
#include "core/vectors.h"
#include "tests/support/loaded_grip.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::ContactPoint;
using core_f64::EFFORT_TOLERANCE;
using core_f64::EffortSolver;
using core_f64::FillEffort;
using core_f64::grip_effort;
using core_f64::GripEffort;
using core_f64::GripLoads;
using core_f64::HandStrength;
using core_f64::Vec3;
using core_f64::Wrench;

double effort_of(const std::vector<ContactPoint>& contacts, const HandStrength& hand, const Wrench& load) {
  return EffortSolver(contacts, hand, core_f64::contacts_center(contacts)).solve(load).effort;
}

// Both are brackets of EFFORT_TOLERANCE, and a state is left out where it is within as much of the worst.
void expect_same_effort(double found, double wanted, const std::string& where) {
  if (std::isinf(wanted)) {
    EXPECT_EQ(found, wanted) << where;
  } else {
    EXPECT_NEAR(found, wanted, 2 * EFFORT_TOLERANCE * wanted) << where;
  }
}

class GripEffortOf : public testing::TestWithParam<Handedness> {};

TEST_P(GripEffortOf, IsTheLargestOfAllStates) {
  int unheld = 0, above_one = 0;
  for (const LoadedGrip& grip : random_loaded_grips(45, GetParam(), 7)) {
    const GripLoads loads = grip.loads();
    std::vector<FillEffort> fills(grip.fills());
    const GripEffort found = grip_effort(grip.contacts, grip.tips, grip.hand, loads, fills);
    double worst = 0, tips_worst = 0;
    int states = 0;
    for (std::size_t fill = 0; fill < fills.size(); ++fill) {
      const std::string where = "fill " + std::to_string(fill);
      double tips = 0;
      // 1 is compared with brackets: a state whose effort is as near to it may count either way
      std::size_t surely_held = 0, perhaps_held = 0;
      for (std::size_t tilt = 0; tilt < grip.counted[fill]; ++tilt, ++states) {
        const double effort = effort_of(grip.contacts, grip.hand, loads.weight(fill, tilt));
        worst = std::max(worst, effort);
        tips = std::max(tips, effort_of(grip.tips, grip.hand, loads.weight(fill, tilt)));
        if (surely_held == tilt && effort <= 1 - 2 * EFFORT_TOLERANCE) ++surely_held;
        if (perhaps_held == tilt && effort <= 1 + 2 * EFFORT_TOLERANCE) ++perhaps_held;
      }
      expect_same_effort(fills[fill].tips, tips, where);
      EXPECT_GE(fills[fill].held, surely_held) << where;
      EXPECT_LE(fills[fill].held, perhaps_held) << where;
      tips_worst = std::max(tips_worst, tips);
    }
    expect_same_effort(found.worst, worst, "whole hand");
    expect_same_effort(found.tips_worst, tips_worst, "tips");
    expect_same_effort(effort_of(grip.contacts, grip.hand, loads.weight(found.fill, found.tilt)), worst, "its own state");
    EXPECT_EQ(found.states, states);
    EXPECT_LE(found.skipped, found.states);
    unheld += std::isinf(worst);
    above_one += worst > 1;
  }
  EXPECT_GT(above_one, unheld);  // both sides of 1 are among them
  EXPECT_LT(above_one, 45);
}

// The two halves of a tolerance together are no more than it, and what is to be known less closely takes fewer pivots. A single
// effort lies in its bracket, which is no wider than the tolerance of its upper end.
TEST_P(GripEffortOf, IsWithinTheToleranceOfTheFinest) {
  constexpr std::array<double, 4> tolerances{1e-1, 1e-2, 1e-3, 1e-5};
  constexpr double FINEST = 1e-8;
  std::array<int, 4> pivots{}, single_pivots{};
  int finite = 0;
  for (const LoadedGrip& grip : random_loaded_grips(45, GetParam(), 23)) {
    const GripLoads loads = grip.loads();
    std::vector<FillEffort> fills(grip.fills());
    const GripEffort finest = grip_effort(grip.contacts, grip.tips, grip.hand, loads, fills, FINEST);
    finite += std::isfinite(finest.worst);
    for (std::size_t k = 0; k < tolerances.size(); ++k) {
      const GripEffort found = grip_effort(grip.contacts, grip.tips, grip.hand, loads, fills, tolerances[k]);
      pivots[k] += found.pivots;
      const core_f64::Effort single =
          EffortSolver(grip.contacts, grip.hand, core_f64::contacts_center(grip.contacts)).solve(loads.weight(0, 0), tolerances[k]);
      single_pivots[k] += single.pivots;
      if (std::isfinite(single.effort)) {
        EXPECT_LE(single.effort - single.low, tolerances[k] * single.effort * (1 + 1e-9));
      }
      if (std::isinf(finest.worst)) {
        EXPECT_EQ(found.worst, finest.worst);
        continue;
      }
      EXPECT_NEAR(found.worst, finest.worst, (tolerances[k] + FINEST) * finest.worst) << tolerances[k];
    }
  }
  EXPECT_GT(finite, 10);
  for (std::size_t k = 1; k < tolerances.size(); ++k) {
    EXPECT_GT(pivots[k], pivots[k - 1]) << tolerances[k];
    EXPECT_GT(single_pivots[k], single_pivots[k - 1]) << tolerances[k];
  }
}

INSTANTIATE_TEST_SUITE_P(Hands, GripEffortOf, testing::Values(Handedness::right, Handedness::left));

// Twice the strength is half the effort, and more friction never takes more.
TEST(GripEffort, FallsWithStrengthAndFriction) {
  for (const LoadedGrip& grip : random_loaded_grips(15, Handedness::right, 11)) {
    std::vector<FillEffort> fills(grip.fills());
    const double once = grip_effort(grip.contacts, grip.tips, grip.hand, grip.loads(), fills).worst;
    HandStrength stronger = grip.hand, rougher = grip.hand;
    for (double& strength : stronger.digits) strength *= 2;
    rougher.friction *= 1.5;
    expect_same_effort(2 * grip_effort(grip.contacts, grip.tips, stronger, grip.loads(), fills).worst, once, "stronger");
    EXPECT_LE(grip_effort(grip.contacts, grip.tips, rougher, grip.loads(), fills).worst, once * (1 + 2 * EFFORT_TOLERANCE));
  }
}

// Bisection of single solves, which knows no cuts: the push to 1e-3 of itself and the tolerance of an effort, which the weight's
// share of the effort magnifies by 1 / (1 - effort).
TEST(GripEffort, PushIsWhatBisectionFinds) {
  int pushed = 0;
  for (const LoadedGrip& grip : random_loaded_grips(30, Handedness::right, 13)) {
    const std::size_t fullest = grip.fills() - 1;
    const Wrench weight = grip.loads().weight(fullest, 0);
    const Vec3 center = grip.states[fullest * grip.tilts.size()].fixed;
    const double found = core_f64::push_held(grip.contacts, grip.hand, weight, center);
    const double alone = effort_of(grip.contacts, grip.hand, weight);
    const auto is_held = [&](double force) {
      for (int side = 0; side < 6; ++side) {
        Vec3 direction(0);
        direction[side / 2] = side % 2 ? -1 : 1;
        const Wrench push = core_f64::wrench_at(center, force * direction);
        if (!(effort_of(grip.contacts, grip.hand, {weight.force + push.force, weight.moment + push.moment}) <= 1)) return false;
      }
      return true;
    };
    if (!is_held(0)) {
      EXPECT_EQ(found, 0);
      continue;
    }
    double low = 0, high = 1000;
    for (int step = 0; step < 30; ++step) {
      const double middle = (low + high) / 2;
      (is_held(middle) ? low : high) = middle;
    }
    EXPECT_NEAR(found, low, (1e-3 + 4 * EFFORT_TOLERANCE / (1 - alone)) * low + 1e-6);
    pushed += low > 0;
  }
  EXPECT_GT(pushed, 10);
}

// The hand holds with the reported friction, to the tolerance of an effort, and does not with one step less.
TEST(GripEffort, FrictionNeededIsTheLeast) {
  int finite = 0;
  for (const LoadedGrip& grip : random_loaded_grips(30, Handedness::right, 17)) {
    std::vector<FillEffort> fills(grip.fills());
    const GripEffort found = grip_effort(grip.contacts, grip.tips, grip.hand, grip.loads(), fills);
    const double friction = core_f64::friction_needed(grip.contacts, grip.hand, grip.loads(), found);
    const auto effort_with = [&](double mu) {
      HandStrength hand = grip.hand;
      hand.friction = mu;
      return grip_effort(grip.contacts, grip.tips, hand, grip.loads(), fills).worst;
    };
    if (std::isinf(friction)) {
      EXPECT_GT(effort_with(core_f64::MOST_FRICTION), 1 - EFFORT_TOLERANCE);
      continue;
    }
    EXPECT_LE(effort_with(friction), 1 + EFFORT_TOLERANCE);
    if (friction > core_f64::FRICTION_STEP) {
      EXPECT_GT(effort_with(friction - core_f64::FRICTION_STEP), 1 - EFFORT_TOLERANCE);
    }
    ++finite;
  }
  EXPECT_GT(finite, 10);
}

// What has poured no longer counts: the states beyond are neither the worst nor held, and the search asks for none of them.
TEST(GripEffort, OnlyCountedTiltsAreAsked) {
  Scene scene = three_beakers();
  scene.strength.emplace();
  ASSERT_FALSE(scene.until_poured);
  const auto evaluator = make_core_evaluator(scene);
  Scene poured = scene;
  poured.until_poured = 0.5;
  int fewer = 0, held = 0, checked = 0;
  Random random(29);
  while (checked < 30) {
    const std::size_t vessel = static_cast<std::size_t>(checked) % scene.vessels.size();
    GripInput input;
    input.height = random.uniform(0.1, 0.95) * scene.vessels[vessel].height;
    input.roll = radians(random.uniform(-90, 30));
    GripResult result;
    evaluator->grip(vessel, input, result);
    if (!result.plausible) continue;
    ++checked;
    LoadedGrip grip = held_grip(scene, *evaluator, vessel, input, result);
    std::vector<FillEffort> fills(grip.fills());
    const std::vector<std::size_t> all_tilts = grip.counted;
    grip.counted = counted_tilts(poured, vessel);
    // what does not count is made so heavy that it would be seen
    for (std::size_t fill = 0; fill < grip.fills(); ++fill)
      for (std::size_t tilt = grip.counted[fill]; tilt < grip.tilts.size(); ++tilt)
        grip.states[fill * grip.tilts.size() + tilt].mass *= 1000;
    LoadedGrip of_all = grip;
    of_all.counted = all_tilts;
    const GripEffort all = grip_effort(of_all.contacts, of_all.tips, of_all.hand, of_all.loads(), fills);
    const GripEffort found = grip_effort(grip.contacts, grip.tips, grip.hand, grip.loads(), fills);
    double worst = 0;
    int states = 0;
    for (std::size_t fill = 0; fill < grip.fills(); ++fill) {
      EXPECT_LE(fills[fill].held, grip.counted[fill]);
      fewer += grip.counted[fill] < grip.tilts.size();
      for (std::size_t tilt = 0; tilt < grip.counted[fill]; ++tilt, ++states)
        worst = std::max(worst, effort_of(grip.contacts, grip.hand, grip.loads().weight(fill, tilt)));
    }
    EXPECT_EQ(found.states, states);
    EXPECT_LT(found.tilt, grip.counted[found.fill]);
    expect_same_effort(found.worst, worst, "of those that count");
    if (std::isfinite(found.worst)) {
      EXPECT_GT(all.worst, 10 * found.worst);
      ++held;
    }
  }
  EXPECT_GT(fewer, 0);
  EXPECT_GT(held, 10);
}

// Nothing is to be held then but what pushes, and no friction is needed.
TEST(GripEffort, WithoutGravityNothingIsNeeded) {
  for (LoadedGrip grip : random_loaded_grips(9, Handedness::right, 11)) {
    grip.gravity = 0;
    const GripLoads loads = grip.loads();
    std::vector<FillEffort> fills(grip.fills());
    const GripEffort found = grip_effort(grip.contacts, grip.tips, grip.hand, loads, fills);
    EXPECT_EQ(found.worst, 0);
    EXPECT_EQ(found.tips_worst, 0);
    EXPECT_EQ(found.pivots, 0);
    for (std::size_t fill = 0; fill < fills.size(); ++fill) EXPECT_EQ(fills[fill].held, grip.counted[fill]);
    EXPECT_EQ(friction_needed(grip.contacts, grip.hand, loads, found), 0);
    // an axis that takes the least part of the strength takes all of it at the largest push: without weight they are reciprocal
    const Vec3 center(0, 0.05, 0);
    double hardest = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        Vec3 force(0);
        force[axis] = sign;
        hardest = std::max(hardest, effort_of(grip.contacts, grip.hand, core_f64::wrench_at(center, force)));
      }
    const double push = core_f64::push_held(grip.contacts, grip.hand, loads.weight(0, 0), center);
    if (std::isinf(hardest)) {
      EXPECT_EQ(push, 0);
    } else {
      EXPECT_NEAR(push * hardest, 1, 2 * EFFORT_TOLERANCE);
    }
  }
}

// Two tips on a level line press W / (2 mu) each against a weight W. Strengths of just that hold it, whichever way the numbers round, and
// do not hold twice the weight.
TEST(GripEffort, AllOfTheStrengthHoldsWhateverRounds) {
  Random random(31);
  int above = 0;
  for (int i = 0; i < 800; ++i) {
    const double half = random.uniform(0.01, 0.06), friction = random.uniform(0.1, 2), mass = random.uniform(0.05, 2);
    const double turn = random.uniform(-PI, PI), height = random.uniform(-0.1, 0.1);
    const Vec3 side(std::cos(turn), 0, std::sin(turn)), up(0, height, 0);
    const std::vector<ContactPoint> tips{{up + half * side, -side, 0}, {up - half * side, side, 1}};
    HandStrength hand{friction, 0.01, {}};
    hand.digits.fill(mass * 9.81 / (2 * friction));
    // a second fill of twice the weight, so that the grip is not held as a whole
    const std::vector<core_f64::Load> states{{mass, up, 0, 0}, {2 * mass, up, 0, 0}};
    const std::vector<core_f64::StateTilt> tilts(1);
    const std::vector<std::size_t> counted{1, 1};
    std::vector<FillEffort> fills(2);
    const GripEffort found = grip_effort(tips, std::nullopt, hand, GripLoads{states, tilts, counted, side, 9.81}, fills);
    EXPECT_NEAR(found.worst, 2, 2 * EFFORT_TOLERANCE);
    EXPECT_EQ(fills[0].held, 1u) << i;
    EXPECT_EQ(fills[1].held, 0u) << i;
    above += effort_of(tips, hand, GripLoads{states, tilts, counted, side, 9.81}.weight(0, 0)) > 1;
  }
  EXPECT_GT(above, 20);  // else nothing rounded
}

// A thumb alone holds nothing that hangs from it.
TEST(GripEffort, OneContactHoldsNothing) {
  LoadedGrip grip = random_loaded_grips(1, Handedness::right, 19).front();
  grip.contacts.resize(1);
  std::vector<FillEffort> fills(grip.fills());
  const GripEffort found = grip_effort(grip.contacts, grip.contacts, grip.hand, grip.loads(), fills);
  EXPECT_EQ(found.worst, std::numeric_limits<double>::infinity());
  EXPECT_EQ(found.tips_worst, std::numeric_limits<double>::infinity());
  for (const FillEffort& fill : fills) EXPECT_EQ(fill.held, 0u);
}

}  // namespace
}  // namespace wholehand
