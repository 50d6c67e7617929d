// SPDX-License-Identifier: MIT
// What forces at contacts add up to, by plain sums: what an answer of the search for the least effort is checked with.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/effort.h"

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

}  // namespace wholehand
