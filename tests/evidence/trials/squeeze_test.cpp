// SPDX-License-Identifier: MIT
// With what forces the hand of a trial presses: they balance the load, in the cones of the friction that they were found with.
#include "evidence/trials/squeeze.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/grip_effort.h"
#include "tests/support/contact_sets.h"

namespace wholehand {
namespace {

using core_f64::ContactForce;
using core_f64::EffortSolver;
using core_f64::HandStrength;
using core_f64::Vec3;
using core_f64::Wrench;

constexpr double SQUEEZE = 1.25;

Wrench times(const Wrench& load, double factor) { return {factor * load.force, factor * load.moment}; }

// The largest of |(f, tau / gamma)| / (mu N) over the contacts.
double share_of_cones(const ContactSet& set, const Squeeze& found) {
  double most = 0;
  for (std::size_t i = 0; i < set.contacts.size(); ++i) {
    const ContactForce& contact = found.forces[i];
    const double normal = glm::dot(contact.force, set.contacts[i].normal);
    const double along = glm::length(contact.force - normal * set.contacts[i].normal);
    const double twist = set.hand.torsion > 0 ? contact.torsion / set.hand.torsion : contact.torsion == 0 ? 0 : 1e9;
    const double size = std::hypot(along, twist);
    EXPECT_GE(normal, -1e-9);
    if (size > 1e-9) most = std::max(most, size / (found.friction * normal));
  }
  return most;
}

// The largest share of its strength that a digit presses with.
double share_of_strength(const ContactSet& set, const Squeeze& found) {
  std::array<double, core_f64::DIGITS> sum{};
  for (std::size_t i = 0; i < set.contacts.size(); ++i)
    sum[static_cast<std::size_t>(set.contacts[i].digit)] += glm::dot(found.forces[i].force, set.contacts[i].normal);
  double most = 0;
  for (std::size_t digit = 0; digit < sum.size(); ++digit)
    if (sum[digit] > 0) most = std::max(most, sum[digit] / set.hand.digits[digit]);
  return most;
}

// By how much the forces miss `factor` times the load, as a share of it.
double missed(const ContactSet& set, const Squeeze& found, double factor) {
  Wrench rest = times(set.load, factor);
  for (std::size_t i = 0; i < set.contacts.size(); ++i) {
    const Wrench part = core_f64::wrench_at(set.contacts[i].place, found.forces[i].force);
    rest.force += part.force;
    rest.moment += part.moment + found.forces[i].torsion * set.contacts[i].normal;
  }
  const Vec3 about = core_f64::contacts_center(set.contacts);
  return wrench_size(rest, about, 0.05) / (factor * wrench_size(set.load, about, 0.05));
}

double effort_at(const ContactSet& set, double friction) {
  HandStrength hand = set.hand;
  hand.friction = friction;
  return EffortSolver(set.contacts, hand, core_f64::contacts_center(set.contacts)).solve(set.load).effort;
}

// Loads of a third of what is resisted and more: within the strength, beyond it, and resisted by nothing.
TEST(Squeeze, PressesSoThatTheLoadIsBalancedWithinConesAndStrength) {
  int light = 0, heavy = 0, slippery = 0, blind = 0;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    const ContactSet set = contact_set(seed);
    const Squeeze found = squeeze_forces(set.contacts, set.hand, set.load, SQUEEZE);
    ASSERT_EQ(found.forces.size(), set.contacts.size());
    EXPECT_LE(share_of_strength(set, found), 1 + 1e-6) << seed;
    EXPECT_LE(share_of_cones(set, found), 1 + 1e-6) << seed;
    if (!std::isfinite(found.effort)) {
      ++blind;
      continue;
    }
    const bool is_within = found.effort * SQUEEZE <= 1;
    EXPECT_LT(missed(set, found, is_within ? SQUEEZE : 1 / found.effort), 1e-6) << seed;
    if (found.friction > set.hand.friction * (1 + 1e-9)) {
      ++slippery;  // what holds is more friction than there is
      EXPECT_FALSE(std::isfinite(effort_at(set, set.hand.friction))) << seed;
    } else if (is_within) {
      ++light;  // with the least friction of those that are tried
      const double share = found.friction / set.hand.friction;
      for (const double smaller : FRICTION_SHARES) {
        if (smaller < share - 1e-9) {
          EXPECT_GT(effort_at(set, smaller * set.hand.friction) * SQUEEZE, 1) << seed;
        }
      }
    } else {
      ++heavy;  // with all friction and all strength
      EXPECT_DOUBLE_EQ(found.friction, set.hand.friction) << seed;
      EXPECT_GT(share_of_strength(set, found), 0.99) << seed;
    }
  }
  for (const int count : {light, heavy, slippery, blind}) EXPECT_GT(count, 10);
}

// No friction makes a single contact pull: a quarter of the strength, shared by a digit's contacts, along the normals.
TEST(Squeeze, WhatNothingResistsGetsAQuarterOfTheStrength) {
  ContactSet set;
  set.contacts = {{Vec3(-0.04, 0, 0), Vec3(1, 0, 0), 0}, {Vec3(-0.04, 0.02, 0), Vec3(1, 0, 0), 0}};
  set.hand = {0.6, 5e-3, {}};
  set.hand.digits.fill(40);
  const Squeeze found = squeeze_forces(set.contacts, set.hand, core_f64::wrench_at(Vec3(0), Vec3(3, 0, 0)), SQUEEZE);
  EXPECT_FALSE(std::isfinite(found.effort));
  for (const ContactForce& contact : found.forces) {
    EXPECT_EQ(contact.force, Vec3(5, 0, 0));
    EXPECT_EQ(contact.torsion, 0);
  }
}

TEST(Squeeze, NoContactsHaveNoForces) {
  EXPECT_TRUE(squeeze_forces({}, {}, core_f64::wrench_at(Vec3(0), Vec3(0, -3, 0)), SQUEEZE).forces.empty());
}

}  // namespace
}  // namespace wholehand
