// SPDX-License-Identifier: MIT
// Parameters of a population of people, which a scene's [people] may change; core/people/ draws persons from them. docs/people.md has each one's
// meaning and source.
#pragma once

#include <array>
#include <cstddef>

namespace wholehand {

// Traits that differ between persons, and between grasps of a person. SI.
enum class Trait {
  height,            // of the thumb-index line over the guidance point, m
  azimuth,           // of the line, off the guidance point's, rad
  obliquity,         // of the line, rad
  roll,              // of the hand about the line, off what was planned, rad
  reaction,          // from feeling a load to the first change of the grip force, s
  response,          // how long that change takes, s
  gain,              // the share that is done of the grip force's rise that would keep the margin
  margin,            // share of the grip force beyond what prevents slipping
  friction,          // that the person expects
  weight_guess,      // expected weight over the true one
  grip_tremor,       // standard deviation of the grip force about the tremor's frequency, over the force
  tremor_rate,       // Hz
  arm_tremor,        // standard deviation of the hand's place, m
  finger_mass,       // kg
  finger_damping,    // N s/m
  finger_stiffness,  // N/m
  arm_mass,          // kg
  arm_damping,       // N s/m
  arm_stiffness,     // N/m
  patience,          // how long an attempt lasts before the person gives up, s
  strength,          // over the mean adult's
  grip_error         // standard deviation of the grip force below the tremor, over the force
};
constexpr std::size_t TRAIT_COUNT = 22;

// The population's mean, and the standard deviations of persons about it and of grasps about their person.
struct Spread {
  double mean = 0, person = 0, grasp = 0;
};

struct Traits : std::array<double, TRAIT_COUNT> {
  using std::array<double, TRAIT_COUNT>::operator[];
  constexpr double operator[](Trait trait) const { return (*this)[static_cast<std::size_t>(trait)]; }
};

// Where the numbers of a trait come from. None is fitted.
enum class Origin { published, mean_published, ours };

// Facts about a trait.
struct TraitFacts {
  const char* key;   // in [people] and in tables; its end is the unit there: `_mm`, `_deg`, else SI
  bool is_positive;  // log-normal, so always above 0; else normal
  Spread spread;     // SI
  double low, high;  // allowed for the mean
  double widest;     // allowed for the deviations, from 0 on
  Origin origin;
};
const std::array<TraitFacts, TRAIT_COUNT>& trait_facts();

struct PeopleData {
  double women = 0.5;      // share of the persons
  double scatter = 1;      // multiplies every deviation, and the difference of the sexes; 0: everybody is the mean person
  double size = 1;         // multiplies the survey's deviations of the hands' length and breadth about the mean of their sex
  double proportions = 1;  // multiplies the published deviations of single segments
  std::array<Spread, TRAIT_COUNT> traits;

  PeopleData();  // with the spreads of trait_facts
};

}  // namespace wholehand
