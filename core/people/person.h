// SPDX-License-Identifier: MIT
// Virtual people: each person is drawn once, and their grasps scatter about the person's own traits. docs/people.md has the model.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/hand_size.h"
#include "core/people_data.h"
#include "core/scene.h"

namespace wholehand {

constexpr std::size_t SEGMENT_COUNT = 19;  // thumb three, then four each, from the base to the tip

// A person's quantiles: for each trait, the share of the population with a lower value. 0.5 is the middle.
struct Shares {
  double sex = 0.5;  // below the share of women: a woman
  double length = 0.5;
  double breadth = 0.5;  // among hands of this length
  std::array<double, SEGMENT_COUNT> segments;
  std::array<double, TRAIT_COUNT> traits;

  Shares() {
    segments.fill(0.5);
    traits.fill(0.5);
  }
};

struct Person {
  Sex sex = Sex::male;  // unused if the scatter is 0
  HandSize hand;
  std::array<double, SEGMENT_COUNT> segments{};  // ratios of lengths to the default hand's shares, before the hand has its length
  Traits traits{};
};

// The quantiles of person `number` of every population, independent of each other and uniform in (0, 1).
Shares draw_shares(std::uint64_t seed, std::uint64_t number);

// All quantiles in one order, as a model's inputs, and their names: `sex`, `hand_length`, `hand_breadth`, the segments from `thumb_metacarpal` to
// `little_distal`, and the keys of trait_facts().
std::vector<double> person_inputs(const Shares& shares);
const std::vector<std::string>& person_input_names();

// Person `number` of a population: the same on any thread and in every experiment.
Person draw_person(const PeopleData& people, std::uint64_t seed, std::uint64_t number);

// The person with these quantiles. All 0.5 and a scatter of 0: the mean person.
Person make_person(const PeopleData& people, const Shares& shares);

// A person in one grasp: the person's own traits plus this grasp's deviations. `experiment` and `grasp` name it.
Traits draw_grasp(const PeopleData& people, const Person& person, std::uint64_t seed, std::uint64_t number,
                  std::uint64_t experiment, std::uint64_t grasp);

// The person's own hand: `plain` with the person's size and segment shares, whatever the size of `plain`. Angles, limits and tolerances are those of
// `plain`; but if the gap of thumb and index finger stops falling before closure 1, the trajectories end there.
HandData hand_of(const HandData& plain, const Person& person);

// Relative standard deviation of a segment's length among hands of one length: the published deviation minus the survey's own deviation of the
// length.
double segment_deviation(std::size_t segment);

// The grip force at which a person first settles on a thing of `weight` N: what two fingers need by the expected friction and weight, plus the
// margin. N.
double first_force(const Traits& traits, double weight);

// The largest force that a person pinches with, N: 16 % of the mean largest grip of 109 lb (Crosby, Wehbe & Mawr 1994), times the person's strength.
// The other force functions here do not apply this limit.
double largest_force(const Traits& traits);

// The grip force that a person goes to after the load has risen since the first force. `rise`, N: the increase of the force that holds without a
// margin.
double loaded_force(const Traits& traits, double first, double rise);

}  // namespace wholehand
