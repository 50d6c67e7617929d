// SPDX-License-Identifier: MIT
// What the forces of an effort must be: they balance the load, each lies in its cone, and no digit presses with more than its part.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "core/effort.h"
#include "tests/support/contact_sets.h"
#include "tests/support/force_sums.h"

namespace wholehand {

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
