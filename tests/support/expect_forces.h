// SPDX-License-Identifier: MIT
// What the forces of an effort must be: they balance the load, each lies in its cone, and no digit presses with more than its part.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/effort.h"
#include "tests/support/contact_sets.h"

namespace wholehand {

// One contact: its normal force, what of its cone it uses (|f| and tau / gamma together), and the size of its force, N.
struct ContactLoad {
  double normal = 0, across = 0, size = 0;
  bool twists_in_vain = false;  // a torsion where gamma is 0
};

struct ForceSums {
  std::vector<ContactLoad> contacts;
  std::array<double, core_f64::DIGITS> pressed{};  // normal forces of each digit, N
  core_f64::Wrench rest{};                         // of the load, that is not balanced
};

inline ForceSums sums_of_forces(std::span<const core_f64::ContactPoint> contacts, std::span<const core_f64::ContactForce> forces,
                                double torsion, const core_f64::Wrench& load) {
  ForceSums sums;
  sums.rest = load;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto& [place, normal, digit, is_tip] = contacts[i];
    const auto& [force, twist] = forces[i];
    const double along = glm::dot(normal, force);
    const double across = std::hypot(glm::length(force - along * normal), torsion > 0 ? twist / torsion : 0);
    sums.contacts.push_back({along, across, glm::length(force), !(torsion > 0) && twist != 0});
    sums.pressed[static_cast<std::size_t>(digit)] += along;
    sums.rest.force += force;
    sums.rest.moment += glm::cross(place, force) + twist * normal;
  }
  return sums;
}

constexpr double WRENCH_LEVER = 0.05;    // m: moments of a wrench's size
constexpr double FORCES_SUMMED = 1e-12;  // rounding of sums of some 10 numbers of the size of the forces
constexpr double FORCES_BALANCED =
    1e-9;  // of the load, what counts as an answer. Found: 6e-12 at most, from bases of nearly parallel columns

inline void expect_forces_hold(const ContactSet& set, const core_f64::EffortSolver& solver, const core_f64::Effort& found,
                               const core_f64::Vec3& about, const std::string& which) {
  std::vector<core_f64::ContactForce> forces(set.contacts.size());
  solver.forces(forces);
  const ForceSums sums = sums_of_forces(set.contacts, forces, set.hand.torsion, set.load);
  for (const ContactLoad& contact : sums.contacts) {
    EXPECT_GE(contact.normal, 0) << which;
    EXPECT_LE(contact.across, (set.hand.friction + FORCES_SUMMED) * contact.normal) << which;
    EXPECT_FALSE(contact.twists_in_vain) << which;
  }
  EXPECT_LE(wrench_size(sums.rest, about, WRENCH_LEVER), FORCES_BALANCED * wrench_size(set.load, about, WRENCH_LEVER)) << which;
  for (std::size_t digit = 0; digit < core_f64::DIGITS; ++digit)
    EXPECT_LE(sums.pressed[digit], found.effort * set.hand.digits[digit] * (1 + FORCES_SUMMED)) << which << " digit " << digit;
}

}  // namespace wholehand
