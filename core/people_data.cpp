// SPDX-License-Identifier: MIT
#include "core/people_data.h"

namespace wholehand {
namespace {

constexpr bool YES = true, NO = false;
constexpr double DEGREE = 3.14159265358979323846 / 180;  // rad

// In the order of Trait.
constexpr std::array<TraitFacts, TRAIT_COUNT> FACTS{{
    {"height_mm", NO, {0, 7e-3, 7e-3}, -1, 1, 0.1, Origin::ours},
    {"azimuth_deg", NO, {0, 15 * DEGREE, 7.5 * DEGREE}, -180 * DEGREE, 180 * DEGREE, 90 * DEGREE, Origin::ours},
    {"obliquity_deg", NO, {0, 5 * DEGREE, 5 * DEGREE}, -90 * DEGREE, 90 * DEGREE, 90 * DEGREE, Origin::ours},
    {"roll_deg", NO, {0, 10 * DEGREE, 5 * DEGREE}, -180 * DEGREE, 180 * DEGREE, 90 * DEGREE, Origin::ours},
    {"reaction_s", YES, {0.075, 0.006, 0.0045}, 1e-3, 0.5, 0.5, Origin::published},
    {"response_s", YES, {0.15, 0.02, 0.015}, 1e-3, 10, 10, Origin::published},
    {"gain", YES, {1, 0.25, 0.125}, 1e-3, 100, 100, Origin::ours},
    {"margin", YES, {0.25, 0.06, 0.045}, 1e-3, 0.9, 1, Origin::published},
    {"friction", YES, {0.6, 0.15, 0.075}, 1e-2, 10, 10, Origin::mean_published},
    {"weight_guess", YES, {1, 0.25, 0.125}, 1e-2, 100, 100, Origin::ours},
    {"grip_tremor", YES, {0.002, 0.0005, 0.00025}, 1e-6, 1, 1, Origin::ours},
    {"tremor_Hz", YES, {9, 0.5, 0}, 0.1, 100, 100, Origin::published},
    {"arm_tremor_mm", YES, {0.15e-3, 0.0375e-3, 0.01875e-3}, 1e-6, 0.1, 0.1, Origin::ours},
    {"finger_mass_kg", YES, {0.012, 0.004, 0}, 1e-4, 1, 1, Origin::published},
    {"finger_damping_Ns_m", YES, {4.5, 1.75, 0}, 1e-2, 1000, 1000, Origin::published},
    {"finger_stiffness_N_m", YES, {500, 150, 0}, 1, 1e5, 1e5, Origin::published},
    {"arm_mass_kg", YES, {0.6, 0.15, 0}, 1e-2, 100, 100, Origin::ours},
    {"arm_damping_Ns_m", YES, {25, 6.25, 0}, 0.1, 1e4, 1e4, Origin::ours},
    {"arm_stiffness_N_m", YES, {300, 75, 0}, 1, 1e5, 1e5, Origin::ours},
    {"patience_s", YES, {10, 2.5, 1.25}, 0.1, 1e4, 1e4, Origin::ours},
    {"strength", YES, {1, 0.25, 0}, 1e-2, 100, 100, Origin::ours},
    {"grip_error", YES, {0.02, 0.005, 0.0025}, 1e-6, 1, 1, Origin::ours},
}};

}  // namespace

const std::array<TraitFacts, TRAIT_COUNT>& trait_facts() { return FACTS; }

PeopleData::PeopleData() {
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) traits[k] = FACTS[k].spread;
}

}  // namespace wholehand
