// SPDX-License-Identifier: MIT
// Contacts of a hand on walls of revolution or on vessels, at random, with a load: what effort is tested on.
#pragma once

#include <cstdint>
#include <vector>

#include "core/effort.h"
#include "tests/support/scenes.h"

namespace wholehand {

// own_digits: no two contacts of one digit. one_side: azimuths within 80 degrees. level: places in one plane. coincident: most places are
// those of another contact.
enum class ContactKind { around, own_digits, one_side, level, coincident, single };
constexpr int CONTACT_KINDS = 6;

struct ContactSet {
  ContactKind kind{};
  std::vector<core_f64::ContactPoint> contacts;  // 2 to 24; 2 to 6 of own digits; 1 of a single one
  core_f64::HandStrength hand;                   // mu 0.1 to 2; gamma 0 to 30 mm, 0 for a third of all sets; strengths 5 to 80 N
  core_f64::Wrench load;                         // half of them certainly resisted
};

ContactSet random_contact_set(ContactKind kind, Random& random);
// The kinds in turn, each set from its own seed.
ContactSet contact_set(std::uint64_t seed);
// On the surface of a vessel of scenes.h: 2 to 24 contacts, each count as often. A fifth of the sets each is from one side, level and
// coincident, and the others are around.
ContactSet vessel_contact_set(std::uint64_t seed);
// 0.1 to 20 N in any direction through a place in the vessel.
core_f64::Wrench random_load(Random& random);
// Against a force in the cone of each contact, with normal forces up to 10 N.
core_f64::Wrench balanced_load(const ContactSet& set, Random& random);
// A contact on a wall of its own, of any digit.
core_f64::ContactPoint random_contact(Random& random);

// The size of a wrench about a place in N, moments divided by `arm` m.
double wrench_size(const core_f64::Wrench& wrench, const core_f64::Vec3& about, double arm);

}  // namespace wholehand
