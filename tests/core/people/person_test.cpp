// SPDX-License-Identifier: MIT
// A population: the moments that were asked for, one person for each name, and no scatter.
#include "core/people/person.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

#include "core/people/draws.h"

namespace wholehand {
namespace {

constexpr int PEOPLE = 20000;
constexpr std::uint64_t SEED = 11;

// Running mean and variance of a population (Welford).
struct Moments {
  double middle = 0, squares = 0;
  int count = 0;

  void add(double x) {
    ++count;
    const double before = x - middle;
    middle += before / count;
    squares += before * (x - middle);
  }
  double mean() const { return middle; }
  double deviation() const { return std::sqrt(squares / count); }
};

// Within five standard errors, of a mean and of a deviation. `kurtosis`: 3 of a normal variable.
void expect_moments(const Moments& is, double mean, double deviation, double kurtosis, const std::string& what) {
  const double rounding = 1e-12 * std::abs(mean);
  EXPECT_NEAR(is.mean(), mean, 5 * deviation / std::sqrt(is.count) + rounding) << what;
  EXPECT_NEAR(is.deviation(), deviation, 5 * deviation * std::sqrt((kurtosis - 1) / (4.0 * is.count)) + rounding) << what;
}

double log_normal_kurtosis(double mean, double deviation) {
  const double w = 1 + deviation * deviation / (mean * mean);
  return w * w * w * w + 2 * w * w * w + 3 * w * w - 3;
}

double kurtosis_of(std::size_t k, double mean, double deviation) {
  return trait_facts()[k].is_positive ? log_normal_kurtosis(mean, deviation) : 3;
}

bool same(const Person& a, const Person& b) {
  return a.sex == b.sex && a.hand.length == b.hand.length && a.hand.breadth == b.hand.breadth && a.segments == b.segments &&
         a.traits == b.traits;
}

TEST(Person, TraitsHaveTheMomentsAskedFor) {
  const PeopleData people;
  std::vector<Moments> moments(TRAIT_COUNT);
  for (std::uint64_t n = 0; n < PEOPLE; ++n) {
    const Person person = draw_person(people, SEED, n);
    for (std::size_t k = 0; k < TRAIT_COUNT; ++k) moments[k].add(person.traits[k]);
  }
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) {
    if (k == static_cast<std::size_t>(Trait::strength)) continue;  // differs by sex
    const Spread& spread = people.traits[k];
    expect_moments(moments[k], spread.mean, spread.person, kurtosis_of(k, spread.mean, spread.person), trait_facts()[k].key);
  }
}

TEST(Person, HandsHaveTheMomentsOfTheSurvey) {
  Moments length[2], breadth[2], strength[2];
  double products[2] = {};
  const PeopleData people;
  for (std::uint64_t n = 0; n < PEOPLE; ++n) {
    const Person person = draw_person(people, SEED, n);
    const int s = person.sex == Sex::female ? 0 : 1;
    length[s].add(person.hand.length);
    breadth[s].add(person.hand.breadth);
    strength[s].add(person.traits[Trait::strength]);
    products[s] += person.hand.length * person.hand.breadth;
  }
  EXPECT_NEAR(length[0].count, PEOPLE / 2, 5 * std::sqrt(PEOPLE / 4.0));
  for (int s = 0; s < 2; ++s) {
    const HandSurvey& survey = hand_survey(s == 0 ? Sex::female : Sex::male);
    expect_moments(length[s], survey.length.mean, survey.length.deviation, 3, "length");
    expect_moments(breadth[s], survey.breadth.mean, survey.breadth.deviation, 3, "breadth");
    const double r =
        (products[s] / length[s].count - length[s].mean() * breadth[s].mean()) / length[s].deviation() / breadth[s].deviation();
    EXPECT_NEAR(r, survey.correlation, 5 * (1 - r * r) / std::sqrt(length[s].count));
  }
  // 81 and 137 lb in the source
  EXPECT_NEAR(strength[1].mean() / strength[0].mean(), 137.0 / 81, 0.03);
  Moments women;
  PeopleData few;
  few.women = 0.2;
  for (std::uint64_t n = 0; n < PEOPLE; ++n) women.add(draw_person(few, SEED, n).sex == Sex::female);
  EXPECT_NEAR(women.mean(), 0.2, 5 * std::sqrt(0.2 * 0.8 / PEOPLE));
}

TEST(Person, SegmentsScatterAsPublishedLessTheScatterOfLengths) {
  // by hand from the table of Buryanov & Kotiuk, and 6.26 % of the length over both sexes
  EXPECT_NEAR(segment_deviation(0), 0.05786, 1e-4);  // the thumb's metacarpal
  EXPECT_NEAR(segment_deviation(2), 0.0019, 1e-4);   // its last segment with the pulp varies no more than lengths do
  EXPECT_NEAR(segment_deviation(4), 0.10725, 1e-4);  // the index finger's proximal one
  EXPECT_NEAR(segment_deviation(6), 0.10097, 1e-4);  // its last one with the pulp
  std::vector<Moments> moments(SEGMENT_COUNT);
  for (std::uint64_t n = 0; n < PEOPLE; ++n) {
    const Person person = draw_person({}, SEED, n);
    for (std::size_t k = 0; k < SEGMENT_COUNT; ++k) moments[k].add(person.segments[k]);
  }
  for (std::size_t k = 0; k < SEGMENT_COUNT; ++k)
    expect_moments(moments[k], 1, segment_deviation(k), log_normal_kurtosis(1, segment_deviation(k)), std::to_string(k));
}

TEST(Person, GraspsScatterAboutTheirPerson) {
  const PeopleData people;
  const Person person = draw_person(people, SEED, 3);
  std::vector<Moments> moments(TRAIT_COUNT);
  for (std::uint64_t g = 0; g < PEOPLE; ++g) {
    const Traits traits = draw_grasp(people, person, SEED, 3, 1, g);
    for (std::size_t k = 0; k < TRAIT_COUNT; ++k) moments[k].add(traits[k]);
  }
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) {
    const Spread& spread = people.traits[k];
    const double own = person.traits[k], deviation = trait_facts()[k].is_positive ? spread.grasp * own / spread.mean : spread.grasp;
    expect_moments(moments[k], own, deviation, kurtosis_of(k, own, deviation), trait_facts()[k].key);
  }
}

// By scipy.stats.lognorm and scipy.stats.norm, of the shares.
TEST(Person, SharesAreThoseOfTheDistributions) {
  Shares shares;
  shares.sex = 0.49;
  shares.length = 0.3;
  shares.breadth = 0.6;
  shares.traits[static_cast<std::size_t>(Trait::height)] = 0.2;
  shares.traits[static_cast<std::size_t>(Trait::reaction)] = 0.1;
  shares.traits[static_cast<std::size_t>(Trait::finger_stiffness)] = 0.9;
  shares.traits[static_cast<std::size_t>(Trait::finger_mass)] = 0.999;
  const Person person = make_person({}, shares);
  EXPECT_EQ(person.sex, Sex::female);
  EXPECT_NEAR(person.hand.length, 175.80453084215713e-3, 1e-12);
  EXPECT_NEAR(person.hand.breadth, 77.80153155954513e-3, 1e-12);
  EXPECT_NEAR(person.traits[Trait::height], -0.0058913486350103995, 1e-12);
  EXPECT_NEAR(person.traits[Trait::reaction], 0.06748718022052226, 1e-12);
  EXPECT_NEAR(person.traits[Trait::finger_stiffness], 697.660094733661, 1e-8);
  EXPECT_NEAR(person.traits[Trait::finger_mass], 0.03104052754869622, 1e-12);
}

TEST(Person, IsTheSameForAnyOrderAndAnyNumberOfThreads) {
  const PeopleData people;
  std::vector<Person> forward(200), parallel(200);
  for (std::uint64_t n = 0; n < 200; ++n) forward[n] = draw_person(people, SEED, n);
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::uint64_t n = 200; n-- > 0;)
        if (n % 4 == t) parallel[n] = draw_person(people, SEED, n);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t n = 0; n < 200; ++n) EXPECT_TRUE(same(forward[n], parallel[n])) << n;
  EXPECT_FALSE(same(forward[0], forward[1]));
  EXPECT_FALSE(same(forward[0], draw_person(people, SEED + 1, 0)));
}

// The order of the draws determines every person, so it must never change.
TEST(Person, SharesAreDrawnInTheOrderOfTheInputs) {
  const std::vector<double> inputs = person_inputs(draw_shares(SEED, 5));
  ASSERT_EQ(inputs.size(), 3 + SEGMENT_COUNT + TRAIT_COUNT);
  for (std::size_t k = 0; k < inputs.size(); ++k) EXPECT_EQ(inputs[k], drawn({SEED, 5}, k)) << k;
  EXPECT_TRUE(same(draw_person({}, SEED, 5), make_person({}, draw_shares(SEED, 5))));
  // kept from before the shares could be had alone
  EXPECT_DOUBLE_EQ(draw_person({}, SEED, 5).hand.length, 0.20675875409081088);
  EXPECT_DOUBLE_EQ(draw_person({}, SEED, 5).traits[Trait::strength], 1.0372744470971962);
}

// 16 % of 109 lb are 77.6 N. Women and men differ by the ratio of their grips.
TEST(Person, ThePinchHasThePublishedForce) {
  Traits traits{};
  traits[static_cast<std::size_t>(Trait::strength)] = 1;
  EXPECT_NEAR(largest_force(traits), 77.6, 0.05);
  traits[static_cast<std::size_t>(Trait::strength)] = 0.5;
  EXPECT_NEAR(largest_force(traits), 38.8, 0.05);
}

TEST(Person, EveryInputHasItsName) {
  const std::vector<std::string>& names = person_input_names();
  ASSERT_EQ(names.size(), 3 + SEGMENT_COUNT + TRAIT_COUNT);
  const std::vector<std::string> first{"sex",          "hand_length",      "hand_breadth",   "thumb_metacarpal", "thumb_proximal",
                                       "thumb_distal", "index_metacarpal", "index_proximal", "index_middle",     "index_distal"};
  for (std::size_t k = 0; k < first.size(); ++k) EXPECT_EQ(names[k], first[k]);
  EXPECT_EQ(names[3 + SEGMENT_COUNT - 1], "little_distal");
  EXPECT_EQ(names[3 + SEGMENT_COUNT], "height_mm");
  EXPECT_EQ(names.back(), "grip_error");
}

TEST(Person, GraspsOfEveryExperimentAreTheirOwn) {
  const PeopleData people;
  const Person person = draw_person(people, SEED, 0);
  const Traits first = draw_grasp(people, person, SEED, 0, 0, 0);
  EXPECT_EQ(first, draw_grasp(people, person, SEED, 0, 0, 0));
  EXPECT_NE(first, draw_grasp(people, person, SEED, 0, 0, 1));
  EXPECT_NE(first, draw_grasp(people, person, SEED, 0, 1, 0));
  EXPECT_NE(first, draw_grasp(people, person, SEED, 1, 0, 0));
}

TEST(Person, WithoutScatterEverybodyIsTheMeanPerson) {
  PeopleData people;
  people.scatter = 0;
  const Person mean = make_person(people, {});
  for (std::uint64_t n = 0; n < 100; ++n) {
    const Person person = draw_person(people, SEED, n);
    ASSERT_TRUE(same(person, mean)) << n;
    ASSERT_EQ(draw_grasp(people, person, SEED, n, 1, n), mean.traits);
  }
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) EXPECT_DOUBLE_EQ(mean.traits[k], people.traits[k].mean) << trait_facts()[k].key;
  EXPECT_NEAR(mean.hand.length, 187.18e-3, 1e-12);
  EXPECT_NEAR(mean.hand.breadth, 83.205e-3, 1e-12);
  for (const double segment : mean.segments) EXPECT_EQ(segment, 1);
}

// As wide as a scene may ask for: what is above 0 stays above 0.
TEST(Person, OfTheWidestScatterHasNoNumberBelowNothing) {
  PeopleData people;
  people.scatter = 10;
  people.size = 10;
  people.proportions = 10;
  int smallest = 0;
  for (std::uint64_t n = 0; n < 2000; ++n) {
    const Person person = draw_person(people, SEED, n);
    EXPECT_GE(person.hand.length, 0.5 * 187.18e-3 - 1e-12);
    EXPECT_GE(person.hand.breadth, 0.5 * 83.205e-3 - 1e-12);
    smallest += person.hand.length < 0.5 * 187.18e-3 + 1e-12;
    for (const double segment : person.segments) EXPECT_GT(segment, 0);
    const Traits grasp = draw_grasp(people, person, SEED, n, 0, 0);
    for (std::size_t k = 0; k < TRAIT_COUNT; ++k) {
      if (trait_facts()[k].is_positive) {
        EXPECT_GT(person.traits[k], 0) << trait_facts()[k].key;
        EXPECT_GT(grasp[k], 0) << trait_facts()[k].key;
      }
      EXPECT_TRUE(std::isfinite(person.traits[k]) && std::isfinite(grasp[k])) << trait_facts()[k].key;
    }
  }
  EXPECT_GT(smallest, 0);
}

TEST(Person, EachSpreadIsItsOwn) {
  PeopleData people;
  const Person before = draw_person(people, SEED, 7);
  people.traits[static_cast<std::size_t>(Trait::roll)] = {0.2, 0, 0};
  const Person after = draw_person(people, SEED, 7);
  EXPECT_EQ(after.traits[Trait::roll], 0.2);
  EXPECT_EQ(draw_grasp(people, after, SEED, 7, 0, 0)[Trait::roll], 0.2);
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) {
    if (k != static_cast<std::size_t>(Trait::roll)) {
      EXPECT_EQ(after.traits[k], before.traits[k]);
    }
  }
  people.size = 0;
  people.proportions = 0;
  const Person plain = draw_person(people, SEED, 7);
  EXPECT_EQ(plain.hand.length, hand_survey(plain.sex).length.mean);
  EXPECT_EQ(plain.segments[5], 1);
}

// 300 g at a friction of 0.6 with a quarter of the force to spare: 0.3 g / 1.2 / 0.75; one newton more of load asks for 1 / 0.75 N.
TEST(Person, ForcesFollowLoadFrictionAndMargin) {
  PeopleData people;
  people.scatter = 0;
  const Traits traits = make_person(people, {}).traits;
  const double first = first_force(traits, 0.3 * 9.80665);
  EXPECT_NEAR(first, 3.26888, 1e-5);
  EXPECT_NEAR(loaded_force(traits, first, 1) - first, 4.0 / 3, 1e-12);
  EXPECT_EQ(loaded_force(traits, first, 0), first);
}

}  // namespace
}  // namespace wholehand
