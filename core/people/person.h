// SPDX-License-Identifier: MIT
// Virtual people: a person is drawn once, and each grasp scatters about its person. docs/people.md has the model.
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

// What a person is made of: of each, the share of the population that has less. 0.5 is the middle.
struct Shares {
  double sex = 0.5;  // below the share of women: a woman
  double length = 0.5;
  double breadth = 0.5;  // of those with hands of this length
  std::array<double, SEGMENT_COUNT> segments;
  std::array<double, TRAIT_COUNT> traits;

  Shares() {
    segments.fill(0.5);
    traits.fill(0.5);
  }
};

struct Person {
  Sex sex = Sex::male;  // without a meaning where the scatter is 0
  HandSize hand;
  std::array<double, SEGMENT_COUNT> segments{};  // lengths over those of the default hand's shares, before the hand has its length
  Traits traits{};
};

// The shares of person `number` of every population: independent of each other, and uniform in (0, 1).
Shares draw_shares(std::uint64_t seed, std::uint64_t number);

// All of them in one order, as the inputs of a model, and their names: `sex`, `hand_length`, `hand_breadth`, the segments from
// `thumb_metacarpal` to `little_distal`, and the keys of trait_facts().
std::vector<double> person_inputs(const Shares& shares);
const std::vector<std::string>& person_input_names();

// Person `number` of a population: for any thread, and in every experiment, the same.
Person draw_person(const PeopleData& people, std::uint64_t seed, std::uint64_t number);

// The person with these shares. All in the middle and a scatter of 0: the mean person.
Person make_person(const PeopleData& people, const Shares& shares);

// What a person is like in one grasp: the person's own traits and what is of this grasp alone. `experiment` and `grasp` name it.
Traits draw_grasp(const PeopleData& people, const Person& person, std::uint64_t seed, std::uint64_t number,
                  std::uint64_t experiment, std::uint64_t grasp);

// The person's own hand: `plain` with the person's size and shares of segments, whatever the size of `plain`. Angles, limits and
// tolerances are those of `plain`, but where the gap of thumb and index finger stops falling before the closure 1, the trajectories
// end there.
HandData hand_of(const HandData& plain, const Person& person);

// Standard deviation of a segment's length over its mean, among hands of one length: what the published deviation leaves when the
// survey's own deviation of the length is taken from it.
double segment_deviation(std::size_t segment);

// The grip force at which a person first settles on a thing of `weight` N: what the reckoned friction of two fingers asks for the
// weight that is expected, and the margin. N.
double first_force(const Traits& traits, double weight);

// The largest force that a person pinches with, N: 16 % of the mean largest grip of 109 lb (Crosby, Wehbe & Mawr 1994), times the
// person's strength. Neither of the forces here knows of it.
double largest_force(const Traits& traits);

// The grip force that a person goes to where the load has risen since the first force: `rise`, N, is how much more it takes to
// hold without a margin.
double loaded_force(const Traits& traits, double first, double rise);

}  // namespace wholehand
