// SPDX-License-Identifier: MIT
#include "core/people/person.h"

#include <cmath>

#include "base/numbers/normal.h"
#include "core/people/draws.h"

namespace wholehand {
namespace {

// The normal variable with this mean and deviation at the quantile `share`, or the log-normal one, which is above 0.
double quantile(bool is_positive, double mean, double deviation, double share) {
  const double z = normal_quantile(share);
  if (!is_positive) return mean + deviation * z;
  const double variance = std::log1p(deviation * deviation / (mean * mean));
  return mean * std::exp(std::sqrt(variance) * z - variance / 2);
}

constexpr double LARGEST_MARGIN = 0.9;  // of the force: more would demand a tenfold force
constexpr double SMALLEST_HAND = 0.5;   // of the mean: a wide scatter would produce hands without a length

double trait_of(const PeopleData& people, std::size_t k, double mean, double deviation, double share) {
  const double value = quantile(trait_facts()[k].is_positive, mean, people.scatter * deviation, share);
  return k == static_cast<std::size_t>(Trait::margin) ? std::fmin(value, LARGEST_MARGIN) : value;
}

// Between the mean of both sexes and that of one, by the scatter.
double toward(double scatter, double both, double own) { return both + scatter * (own - both); }

double mixed(const PeopleData& people, double women, double men) { return people.women * women + (1 - people.women) * men; }

HandSize hand_size(const PeopleData& people, Sex sex, const Shares& shares) {
  const HandSurvey &women = hand_survey(Sex::female), &men = hand_survey(Sex::male), &own = hand_survey(sex);
  const double scatter = people.scatter * people.size, r = own.correlation;
  const double length = normal_quantile(shares.length);
  const double breadth = r * length + std::sqrt(1 - r * r) * normal_quantile(shares.breadth);
  const HandSize mean{mixed(people, women.length.mean, men.length.mean), mixed(people, women.breadth.mean, men.breadth.mean)};
  HandSize size;
  size.length = toward(people.scatter, mean.length, own.length.mean) + scatter * own.length.deviation * length;
  size.breadth = toward(people.scatter, mean.breadth, own.breadth.mean) + scatter * own.breadth.deviation * breadth;
  return {std::fmax(size.length, SMALLEST_HAND * mean.length), std::fmax(size.breadth, SMALLEST_HAND * mean.breadth)};
}

// Crosby, Wehbe & Mawr 1994: a woman's largest grip is 81 lb in the mean and a man's 137 lb. We take a pinch to have their ratio.
constexpr double STRENGTH_OF_WOMEN = 81.0 / 109, STRENGTH_OF_MEN = 137.0 / 109;

// Uses the ratio of the sexes instead of their difference, so that it stays above 0 for every scatter.
double strength_of(const PeopleData& people, Sex sex) {
  const double both = mixed(people, STRENGTH_OF_WOMEN, STRENGTH_OF_MEN);
  return both * std::pow((sex == Sex::female ? STRENGTH_OF_WOMEN : STRENGTH_OF_MEN) / both, people.scatter);
}

}  // namespace

Person make_person(const PeopleData& people, const Shares& shares) {
  Person person;
  person.sex = people.scatter > 0 && shares.sex < people.women ? Sex::female : Sex::male;
  person.hand = hand_size(people, person.sex, shares);
  for (std::size_t k = 0; k < SEGMENT_COUNT; ++k)
    person.segments[k] = quantile(true, 1, people.scatter * people.proportions * segment_deviation(k), shares.segments[k]);
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k)
    person.traits[k] = trait_of(people, k, people.traits[k].mean, people.traits[k].person, shares.traits[k]);
  person.traits[static_cast<std::size_t>(Trait::strength)] *= strength_of(people, person.sex);
  return person;
}

Shares draw_shares(std::uint64_t seed, std::uint64_t number) {
  const DrawName name{seed, number};
  std::uint64_t index = 0;
  Shares shares;
  shares.sex = drawn(name, index++);
  shares.length = drawn(name, index++);
  shares.breadth = drawn(name, index++);
  for (double& share : shares.segments) share = drawn(name, index++);
  for (double& share : shares.traits) share = drawn(name, index++);
  return shares;
}

Person draw_person(const PeopleData& people, std::uint64_t seed, std::uint64_t number) {
  return make_person(people, draw_shares(seed, number));
}

Traits draw_grasp(const PeopleData& people, const Person& person, std::uint64_t seed, std::uint64_t number,
                  std::uint64_t experiment, std::uint64_t grasp) {
  const DrawName name{seed, number, experiment + 1, grasp + 1};
  Traits traits{};
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) {
    // the deviation of a positive trait is a share of the person's own
    const double own = person.traits[k], share = trait_facts()[k].is_positive ? own / people.traits[k].mean : 1;
    traits[k] = trait_of(people, k, own, share * people.traits[k].grasp, drawn(name, k));
  }
  return traits;
}

double largest_force(const Traits& traits) {
  constexpr double POUND = 4.4482216152605;  // N
  return traits[Trait::strength] * 0.16 * 109 * POUND;
}

double first_force(const Traits& traits, double weight) {
  return traits[Trait::weight_guess] * weight / (2 * traits[Trait::friction]) / (1 - traits[Trait::margin]);
}

double loaded_force(const Traits& traits, double first, double rise) {
  return first + traits[Trait::gain] * rise / (1 - traits[Trait::margin]);
}

}  // namespace wholehand
