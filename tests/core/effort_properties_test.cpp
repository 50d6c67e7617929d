// SPDX-License-Identifier: MIT
// sanitizers: none
// Kernel 10 against the properties of an effort, on random contact sets. These tests do not depend on how the search works.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/effort.h"
#include "tests/support/contact_sets.h"
#include "tests/support/expect_forces.h"
#include "tests/support/special_values.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

using core_f64::ContactPoint;
using core_f64::Effort;
using core_f64::EffortSolver;
using core_f64::Vec3;
using core_f64::Wrench;

constexpr std::uint64_t EFFORT_SETS = 1200;
constexpr double FINE = 1e-9;

// What rounding may widen a bracket by, or move it by where the same question is put in other numbers. A direction of the load that
// hardly any contact resists has a price of up to UNRESISTED_EFFORT = 1e6, and rounding of 1e-16 in the load or a contact costs 1e6
// times that; a basis of nearly parallel columns multiplies it by 100 or so. Found in 6,000 sets: 2e-8 at most.
constexpr double ROUNDED = 1e-7;

const Vec3 ABOUT(0.005, 0.05, -0.003);  // the solver's center

Effort effort_of(const ContactSet& set, Vec3 center = ABOUT) {
  return EffortSolver(set.contacts, set.hand, center).solve(set.load, FINE);
}

Wrench times(double scale, const Wrench& wrench) { return {scale * wrench.force, scale * wrench.moment}; }
Wrench sum(const Wrench& a, const Wrench& b) { return {a.force + b.force, a.moment + b.moment}; }

// Brackets of the same number have a point in common.
void expect_overlap(const Effort& a, const Effort& b, std::uint64_t seed) {
  EXPECT_LE(a.low, b.effort * (1 + ROUNDED)) << "seed " << seed;
  EXPECT_LE(b.low, a.effort * (1 + ROUNDED)) << "seed " << seed;
}

Effort scaled_by(double scale, Effort effort) {
  effort.effort *= scale;
  effort.low *= scale;
  return effort;
}

void expect_not_above(const Effort& a, const Effort& b, std::uint64_t seed) {
  EXPECT_LE(a.low, b.effort * (1 + ROUNDED)) << "seed " << seed;
}

// ---- what an answer must have ----

// The most power, in W, with which a contact of unit normal force can oppose a motion: the largest -(force.velocity +
// moment.turning) over its cone.
double opposed(const ContactPoint& contact, const core_f64::HandStrength& hand, Vec3 velocity, Vec3 turning) {
  const Vec3 against = -(velocity + glm::cross(turning, contact.place - ABOUT));
  const double along = glm::dot(against, contact.normal), spin = hand.torsion * glm::dot(turning, contact.normal);
  return along + hand.friction * std::hypot(glm::length(against - along * contact.normal), spin);
}

// Along its escape the load does work, and contacts next to none against it. A normal force N of a contact does N times `opposed`
// at most, so normal forces of 100 times the load's own size would not be enough. Most escapes show 1e5 to 1e6 times. They show
// less, in proportion, where the load is near one that is resisted: of 6,000 loads at random 150 times at least.
constexpr double OPPOSED = 1e-2;

void expect_escape(const ContactSet& set, const Effort& found, const std::string& which) {
  const Vec3 velocity(found.escape[0], found.escape[1], found.escape[2]),
      turning(found.escape[3], found.escape[4], found.escape[5]);
  const double power = glm::dot(set.load.force, velocity) + glm::dot(set.load.moment - glm::cross(ABOUT, set.load.force), turning);
  ASSERT_TRUE(std::isfinite(power)) << which;
  EXPECT_GT(power, 0) << which;
  const double size = wrench_size(set.load, ABOUT, WRENCH_LEVER);
  for (const ContactPoint& contact : set.contacts) {
    const bool presses = set.hand.digits[static_cast<std::size_t>(contact.digit)] > 0;
    EXPECT_TRUE(!presses || size * opposed(contact, set.hand, velocity, turning) <= OPPOSED * power) << which;
  }
}

Effort expect_sound(const ContactSet& set, double tolerance, const std::string& which, double rounded = ROUNDED) {
  EffortSolver solver(set.contacts, set.hand, ABOUT);
  const Effort found = solver.solve(set.load, tolerance);
  EXPECT_FALSE(std::isnan(found.effort) || std::isnan(found.low)) << which;
  EXPECT_GE(found.low, 0) << which;
  EXPECT_LE(found.low, found.effort) << which;
  // FINE is near rounding: without friction, where Z has corners, one of a hundred solves turns round among equal bases until the
  // cap
  EXPECT_TRUE(tolerance <= FINE || found.pivots < core_f64::EFFORT_PIVOTS) << which;
  if (std::isfinite(found.effort)) {
    EXPECT_LE(found.effort - found.low, std::max(tolerance, rounded) * found.effort) << which;
    expect_forces_hold(set, solver, found, ABOUT, which);
  } else {
    expect_escape(set, found, which);
  }
  return found;
}

// ---- sets at random ----

TEST(EffortProperties, AnswersAreSound) {
  int resisted = 0;
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    const ContactSet set = contact_set(seed);
    const Effort coarse = expect_sound(set, core_f64::EFFORT_TOLERANCE, "seed " + std::to_string(seed));
    expect_overlap(coarse, expect_sound(set, FINE, "fine, seed " + std::to_string(seed)), seed);
    resisted += std::isfinite(coarse.effort) ? 1 : 0;
  }
  EXPECT_GT(resisted, 800);  // half of them by the way they are made
  EXPECT_LT(resisted, 1100);
}

TEST(EffortProperties, StrengthsDivideAndLoadsMultiply) {
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    const ContactSet set = contact_set(seed);
    ContactSet stronger = set, heavier = set;
    for (double& digit : stronger.hand.digits) digit *= 3.7;
    heavier.load = times(7.3, set.load);
    const Effort found = effort_of(set);
    expect_overlap(scaled_by(3.7, effort_of(stronger)), found, seed);
    expect_overlap(effort_of(heavier), scaled_by(7.3, found), seed);
  }
}

TEST(EffortProperties, MoreToHoldWithNeverTakesMore) {
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    const ContactSet set = contact_set(seed);
    Random random(seed);
    ContactSet another = set, rougher = set, softer = set;
    another.contacts.push_back(random_contact(random));
    rougher.hand.friction *= random.uniform(1, 2);
    softer.hand.torsion += random.uniform(0, 0.02);
    const Effort found = effort_of(set);
    for (const ContactSet& more : {another, rougher, softer}) expect_not_above(effort_of(more), found, seed);
  }
}

TEST(EffortProperties, LoadsTogetherTakeNoMoreThanEachForItself) {
  int resisted = 0;
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    ContactSet set = contact_set(seed);
    Random random(seed);
    const Effort one = effort_of(set);
    const Wrench load = set.load;
    set.load = random.uniform(0, 1) < 0.5 ? balanced_load(set, random) : random_load(random);
    const Effort other = effort_of(set);
    set.load = sum(load, set.load);
    EXPECT_LE(effort_of(set).low, (one.effort + other.effort) * (1 + ROUNDED)) << "seed " << seed;
    resisted += std::isfinite(one.effort + other.effort) ? 1 : 0;
  }
  EXPECT_GT(resisted, 600);
}

TEST(EffortProperties, TheCenterOfMomentsChangesNothing) {
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    const ContactSet set = contact_set(seed);
    const Effort found = effort_of(set);
    for (const Vec3& center : {Vec3(0), Vec3(-0.05, 0.2, 0.1)}) expect_overlap(effort_of(set, center), found, seed);
  }
}

TEST(EffortProperties, AMotionOfContactsAndLoadChangesNothing) {
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    const ContactSet set = contact_set(seed);
    Random random(seed);
    const Vec3 axis = random_unit(random), shift = 0.1 * random_unit(random);
    const double angle = random.uniform(-PI, PI);
    const auto turned = [&](const Vec3& p) {  // Rodrigues
      return std::cos(angle) * p + std::sin(angle) * glm::cross(axis, p) + (1 - std::cos(angle)) * glm::dot(axis, p) * axis;
    };
    ContactSet moved = set;
    for (ContactPoint& contact : moved.contacts) {
      contact.place = turned(contact.place) + shift;
      contact.normal = turned(contact.normal);
    }
    moved.load.force = turned(set.load.force);
    moved.load.moment = turned(set.load.moment) + glm::cross(shift, moved.load.force);
    expect_overlap(effort_of(moved), effort_of(set), seed);
  }
}

// ---- one load after another ----

TEST(EffortProperties, TheNextLoadOfASolverIsThatOfAFreshOne) {
  int bounded = 0;
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    const ContactSet set = contact_set(seed);
    Random random(seed);
    EffortSolver solver(set.contacts, set.hand, ABOUT);
    EXPECT_EQ(solver.bound(set.load), INFINITE);
    const Effort fresh = effort_of(set);
    const Wrench other = random_load(random);
    const Wrench near = {set.load.force + 0.1 * other.force, set.load.moment + 0.1 * other.moment};
    for (const Wrench& before : {other, near, times(-1, set.load), Wrench{}}) {
      solver.solve(before);
      const double bound = solver.bound(set.load);
      EXPECT_GE(bound * (1 + ROUNDED), fresh.low) << "seed " << seed;
      bounded += std::isfinite(bound) ? 1 : 0;
      const Effort next = solver.solve(set.load, FINE);
      expect_overlap(next, fresh, seed);
      if (std::isfinite(next.effort)) expect_forces_hold(set, solver, next, ABOUT, "next, seed " + std::to_string(seed));
    }
  }
  EXPECT_GT(bounded, 30);  // else `bound` was hardly asked
}

// ---- the ends of the ranges ----

TEST(EffortProperties, NoLoadTakesNothing) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    ContactSet set = contact_set(seed);
    set.load = {};
    const Effort found = expect_sound(set, FINE, "seed " + std::to_string(seed));
    EXPECT_EQ(found.effort, 0);
    EXPECT_EQ(found.low, 0);
  }
}

TEST(EffortProperties, NothingToHoldWithIsInfinite) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    ContactSet none = contact_set(seed), weak = none;
    none.contacts.clear();
    weak.hand.digits = {};
    for (const ContactSet& set : {none, weak}) {
      const Effort found = expect_sound(set, FINE, "seed " + std::to_string(seed));
      EXPECT_EQ(found.effort, INFINITE) << seed;
      EXPECT_EQ(found.low, INFINITE) << seed;
    }
  }
}

// Contacts without friction resist in few directions: prices stay at 1e6 in the others, and nearly parallel normals multiply their
// rounding by up to 1e5. Found: a bracket 3e-6 of its effort wide, of three contacts.
constexpr double ROUNDED_WITHOUT_FRICTION = 1e-5;

// Without friction, without torsion, without either, with digits that do not press: each with a load that can be balanced and one
// at random.
TEST(EffortProperties, DegenerateHandsAreSound) {
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    ContactSet set = contact_set(seed);
    Random random(seed);
    const int what = static_cast<int>(random.uniform(0, 4));
    if (what == 0 || what == 2) set.hand.friction = 0;
    if (what == 1 || what == 2) set.hand.torsion = 0;
    if (what == 3)
      for (double& digit : set.hand.digits) digit = random.uniform(0, 1) < 0.5 ? 0 : digit;
    for (const double tolerance : {core_f64::EFFORT_TOLERANCE, FINE}) {
      set.load = random_load(random);
      expect_sound(set, tolerance, "random, seed " + std::to_string(seed), ROUNDED_WITHOUT_FRICTION);
      set.load = balanced_load(set, random);
      const Effort found = expect_sound(set, tolerance, "balanced, seed " + std::to_string(seed), ROUNDED_WITHOUT_FRICTION);
      EXPECT_TRUE(what == 3 || std::isfinite(found.effort)) << "seed " << seed;
    }
  }
}

// Digits of 0.1 N beside digits of 10 kN, at the named tolerance: the prices round by 1e5 times more than of even digits, too
// coarse for FINE.
TEST(EffortProperties, HandsOfUnevenStrengthAreSound) {
  int resisted = 0;
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    ContactSet set = contact_set(seed);
    Random random(seed);
    for (double& digit : set.hand.digits) digit = std::pow(10, random.uniform(-1, 4));
    const Effort found = expect_sound(set, core_f64::EFFORT_TOLERANCE, "uneven, seed " + std::to_string(seed));
    // as strong as the weakest digit, and as the strongest
    ContactSet weak = set, strong = set;
    weak.hand.digits.fill(*std::min_element(set.hand.digits.begin(), set.hand.digits.end()));
    strong.hand.digits.fill(*std::max_element(set.hand.digits.begin(), set.hand.digits.end()));
    expect_not_above(effort_of(strong), found, seed);
    expect_not_above(found, effort_of(weak), seed);
    resisted += std::isfinite(found.effort) ? 1 : 0;
  }
  EXPECT_GT(resisted, 800);
}

// Strengths up to 10^8 apart and torsions from 1 nm: rounding may leave a level below zero. Such a level counts as none, and the force that it
// carried is missing from the balance. The search must not accept such forces: allowing an error of 1e-7 of the load left 3e-8 in three of these
// sets.
TEST(EffortProperties, ForcesOfStrengthsFarApartBalanceTheLoad) {
  int resisted = 0;
  for (const std::uint64_t first : {1600u, 7100u})
    for (std::uint64_t seed = first; seed < first + 60; ++seed) {
      ContactSet set = contact_set(seed);
      Random random(seed);
      for (double& digit : set.hand.digits) digit = std::pow(10, random.uniform(-4, 4));
      set.hand.torsion = std::pow(10, random.uniform(-9, -1));
      set.load = balanced_load(set, random);
      EffortSolver solver(set.contacts, set.hand, ABOUT);
      const Effort found = solver.solve(set.load);
      if (!std::isfinite(found.effort)) continue;
      expect_forces_hold(set, solver, found, ABOUT, "seed " + std::to_string(seed));
      ++resisted;
    }
  EXPECT_GT(resisted, 110);
}

TEST(EffortProperties, LoadsOfAnySizeAreAlike) {
  for (std::uint64_t seed = 0; seed < EFFORT_SETS; ++seed) {
    const ContactSet set = contact_set(seed);
    const Effort found = effort_of(set);
    for (const double size : {1e-9, 1e6}) {
      ContactSet other = set;
      const double scale = size / wrench_size(set.load, ABOUT, WRENCH_LEVER);
      other.load = times(scale, set.load);
      expect_overlap(expect_sound(other, FINE, "seed " + std::to_string(seed)), scaled_by(scale, found), seed);
    }
  }
}

// A single contact has no choice: it presses as much as the load does against its normal.
TEST(EffortProperties, OneContactPressesAgainstTheLoad) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    ContactSet set = random_contact_set(ContactKind::single, random);
    set.load = balanced_load(set, random);
    const ContactPoint& contact = set.contacts[0];
    const double normal = -glm::dot(contact.normal, set.load.force);
    const double exact = normal / set.hand.digits[static_cast<std::size_t>(contact.digit)];
    const Effort found = effort_of(set);
    EXPECT_NEAR(found.effort, exact, ROUNDED * exact) << "seed " << seed;
    EXPECT_NEAR(found.low, exact, ROUNDED * exact) << "seed " << seed;
  }
}

}  // namespace
}  // namespace wholehand
