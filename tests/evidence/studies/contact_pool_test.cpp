// SPDX-License-Identifier: MIT
// Samples from given grasps, and the weights of vessels.
#include "evidence/studies/contact_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/statistics/moments.h"
#include "base/statistics/resample.h"
#include "core/people/draws.h"

namespace wholehand {
namespace {

// Three vessels of the paper's with two, one and three grasps of a person, and a fourth with one.
std::vector<StudyVessel> pool_vessels() {
  return {{0, "one", 22, true, 0, 2}, {1, "two", 32, true, 2, 3}, {2, "three", 18, true, 3, 6}, {3, "cup", 24, false, 6, 7}};
}
constexpr std::size_t POOL_SLOTS = 7;

// Every grasp has a height of its own: the person, the pose and the slot.
double height_of(std::uint64_t person, std::size_t pose, std::size_t slot) {
  return static_cast<double>(person * 100 + pose * 10 + slot);
}

ContactGrasp pool_grasp(std::uint64_t person, std::size_t pose, std::size_t slot, bool is_held = true) {
  ContactGrasp grasp;
  grasp.height = height_of(person, pose, slot);
  grasp.distance = drawn({3, person, pose}, slot);
  grasp.used_mask = (1u << (person % 5 + 1)) - 1;
  grasp.touch_mask = (1u << (slot + 1)) - 1;
  grasp.is_held = is_held;
  return grasp;
}

std::vector<ContactGrasp> person_grasps(std::uint64_t person, const std::set<std::size_t>& lost = {}) {
  std::vector<ContactGrasp> grasps;
  for (std::size_t pose = 0; pose < STUDY_POSES.size(); ++pose)
    for (std::size_t slot = 0; slot < POOL_SLOTS; ++slot) grasps.push_back(pool_grasp(person, pose, slot, !lost.contains(slot)));
  return grasps;
}

TEST(ContactPool, ASampleHasThePapersGrasps) {
  const std::vector<StudyVessel> vessels = pool_vessels();
  for (const std::uint64_t count : {17u, 18u, 40u}) {
    ContactPool pool(vessels, count);
    for (std::uint64_t person = 0; person < count; ++person) pool.add(person_grasps(person));
    ASSERT_EQ(pool.people(), count);
    std::set<std::uint64_t> seen;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const std::size_t pose = seed % 2;
      const auto drawn = pool.draw(pose, seed);
      ASSERT_EQ(drawn.size(), 4u);
      EXPECT_EQ(drawn[0].size(), 22u);
      EXPECT_EQ(drawn[1].size(), 17u) << "17 people make no more";
      EXPECT_EQ(drawn[2].size(), 18u);
      EXPECT_EQ(drawn[3].size(), 17u);
      std::set<std::uint64_t> people;
      for (std::size_t v = 0; v < drawn.size(); ++v)
        for (const ContactGrasp* grasp : drawn[v]) {
          const auto name = static_cast<std::uint64_t>(grasp->height);
          EXPECT_EQ(name / 10 % 10, pose);
          EXPECT_GE(name % 10, vessels[v].first);
          EXPECT_LT(name % 10, vessels[v].last);
          people.insert(name / 100);
        }
      EXPECT_LE(people.size(), PAPER_PEOPLE);
      seen.insert(people.begin(), people.end());
    }
    EXPECT_EQ(seen.size(), count) << "all have their turn";
  }
}

// Every second person loses all grasps on the third vessel; everybody loses those on the second.
TEST(ContactPool, StopsWhereEnoughGraspsHold) {
  const std::vector<StudyVessel> vessels = pool_vessels();
  ContactPool pool(vessels, 60);
  for (std::uint64_t person = 0; person < 60; ++person)
    pool.add(person_grasps(person, person % 2 == 0 ? std::set<std::size_t>{2, 3, 4, 5} : std::set<std::size_t>{2}));
  std::size_t most = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto drawn = pool.draw(0, seed);
    EXPECT_EQ(drawn[1].size(), 17u);
    const auto held = [](const std::vector<const ContactGrasp*>& grasps) {
      std::size_t count = 0;
      for (const ContactGrasp* grasp : grasps) count += grasp->is_held ? 1 : 0;
      return count;
    };
    // fewer than 6 of 17 with three good grasps each cannot give 18
    if (drawn[2].size() < 51) {
      EXPECT_EQ(held(drawn[2]), 18u);
      EXPECT_TRUE(drawn[2].back()->is_held) << "the last one that was needed";
    } else {
      EXPECT_LE(held(drawn[2]), 18u);
    }
    EXPECT_GE(drawn[2].size(), 18u);
    most = std::max(most, drawn[2].size());
  }
  EXPECT_GT(most, 18u) << "lost ones are made and counted";
}

// Every second of 10 people loses the third vessel's three grasps, nobody holds the second vessel, and person 4 has all projected points.
TEST(ContactPool, CountsPeopleAndGrasps) {
  const std::vector<StudyVessel> vessels = pool_vessels();
  VesselTallies tallies(vessels);
  for (std::uint64_t person = 0; person < 10; ++person) {
    std::vector<ContactGrasp> grasps =
        person_grasps(person, person % 2 == 0 ? std::set<std::size_t>{2, 3, 4, 5} : std::set<std::size_t>{2});
    for (ContactGrasp& grasp : grasps) grasp.inner_mask = person == 4 ? 1 : 0;
    tallies.add(Grasps(grasps).first(POOL_SLOTS));
  }
  const std::vector<StudyCount> counts = tallies.counts();
  ASSERT_EQ(counts.size(), 5 * contact_statistics().size());
  const auto has_count = [&](std::size_t vessel, const std::string& statistic, std::uint64_t people, std::uint64_t grasps) {
    const auto found = std::find_if(contact_statistics().begin(), contact_statistics().end(),
                                    [&](const ContactStatistic& one) { return one.name == statistic; });
    const StudyCount& count =
        counts[vessel * contact_statistics().size() + static_cast<std::size_t>(found - contact_statistics().begin())];
    EXPECT_EQ(count.people, std::optional(people)) << vessel << ' ' << statistic;
    EXPECT_EQ(count.grasps, std::optional(grasps)) << vessel << ' ' << statistic;
  };
  has_count(0, "held_share", 10, 20);
  has_count(1, "held_share", 10, 10);
  has_count(1, "mean_fingers", 0, 0);
  has_count(2, "held_share", 10, 30);
  has_count(2, "point_biserial_height", 5, 15);
  has_count(2, "projected_inner_share", 0, 0);
  has_count(0, "projected_inner_share", 1, 2);
  has_count(0, "projected_share", 10, 20);
  has_count(3, "touch_share", 10, 10);
  has_count(4, "held_share", 10, 60);
  has_count(4, "touch_share", 10, 35);
}

TEST(ContactPool, SamplesAreTheSeeds) {
  const std::vector<StudyVessel> vessels = pool_vessels();
  ContactPool pool(vessels, 40);
  for (std::uint64_t person = 0; person < 40; ++person) pool.add(person_grasps(person));
  EXPECT_EQ(pool.draw(0, 7), pool.draw(0, 7));
  EXPECT_NE(pool.draw(0, 7), pool.draw(0, 8));
}

std::size_t place_of_statistic(std::size_t vessel, const std::string& name) {
  for (std::size_t k = 0; k < contact_statistics().size(); ++k)
    if (contact_statistics()[k].name == name) return vessel * contact_statistics().size() + k;
  return 0;
}

// Each person grasps the second vessel once, with 1 to 5 fingers. The mean of 17 has the variance that draw_people promises.
TEST(ContactPool, IntervalsAreThoseOfSmallSamples) {
  const std::vector<StudyVessel> vessels = pool_vessels();
  for (const std::uint64_t count : {17u, 1700u}) {
    ContactPool pool(vessels, count);
    std::vector<double> fingers;
    for (std::uint64_t person = 0; person < count; ++person) {
      pool.add(person_grasps(person));
      fingers.push_back(static_cast<double>(person % 5 + 1));
    }
    std::vector<std::vector<double>> samples;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) samples.push_back(pool.sample(1, seed));
    const Interval interval = sample_intervals(samples)[place_of_statistic(1, "mean_fingers")];
    const auto known = static_cast<double>(count);
    const double deviation = deviation_of(fingers) * std::sqrt((1.0 / 17 + 1 / known) * (known - 1) / (known + 1));
    // 1 / 17 is what the mean goes in, and an end of 2,000 samples is off by 0.06 deviations
    const double tolerance = 1.0 / 17 + 3 * 0.06 * deviation;
    EXPECT_NEAR(interval.low, mean_of(fingers) - NORMAL_95 * deviation, tolerance) << count;
    EXPECT_NEAR(interval.high, mean_of(fingers) + NORMAL_95 * deviation, tolerance) << count;
  }
}

TEST(ContactPool, OfTooFewPeopleHasNoSample) {
  const std::vector<StudyVessel> vessels = pool_vessels();
  ContactPool pool(vessels, 16);
  for (std::uint64_t person = 0; person < 16; ++person) pool.add(person_grasps(person));
  const std::vector<double> sample = pool.sample(0, 1);
  EXPECT_EQ(sample.size(), 5 * contact_statistics().size());
  for (const double value : sample) EXPECT_TRUE(std::isnan(value));
}

TEST(ContactPool, KeepsTheFirstPeople) {
  const std::vector<StudyVessel> vessels = pool_vessels();
  ContactPool pool(vessels, 17);
  for (std::uint64_t person = 0; person < 30; ++person) pool.add(person_grasps(person));
  EXPECT_EQ(pool.people(), 17u);
  const auto drawn = pool.draw(0, 1);
  for (const ContactGrasp* grasp : drawn[1]) EXPECT_LT(grasp->height, 1700);
}

TEST(ContactPool, SaysWhereItIsSmall) {
  EXPECT_EQ(pooled_people(500, 16), 500u);
  EXPECT_EQ(pooled_people(1'000'000, 16), MOST_POOLED);
  EXPECT_EQ(pool_note(1'000'000, 104), "");
  EXPECT_EQ(pooled_people(1'000'000, 2000), 1048u);
  EXPECT_EQ(
      pool_note(1'000'000, 2000),
      "the samples for the intervals are drawn from the first 1,048 people: each makes 2,000 grasps, and no more fit in memory");
  EXPECT_EQ(pool_note(1048, 2000), "");
  EXPECT_EQ(pooled_people(1'000'000, 1 << 21), PAPER_PEOPLE);
}

// A population has as many grasps of each vessel, and a sample has not. All together are those of a sample in which the grasps have
// the numbers of the paper: 22, 32 and 18 that hold, of each of 5. Every second grasp of the first vessel is lost: 44 are made.
TEST(VesselTallies, AllHaveTheProportionsOfASample) {
  const std::vector<StudyVessel> vessels{{0, "one", 22, true, 0, 4}, {1, "two", 32, true, 4, 8}, {2, "three", 18, true, 8, 12}};
  VesselTallies tallies(vessels);
  ContactTally together, as_made;
  const std::size_t copies[] = {22, 32, 18};
  for (std::size_t v = 0; v < 3; ++v)
    for (std::uint64_t k = 0; k < (v == 0 ? 10u : 5u); ++k) {
      ContactGrasp grasp = pool_grasp(k + 7 * v, 0, v + k % 3, v > 0 || k % 2 == 0);
      grasp.distance = drawn({4, v}, k);
      grasp.tip_mask = k % 4 == v ? 1u << v : 0;
      grasp.is_plausible = grasp.is_held && k < 3;
      tallies.add(v, grasp);
      as_made.add(grasp);
      for (std::size_t copy = 0; copy < copies[v]; ++copy) together.add(grasp);
    }
  const std::vector<double> values = tallies.values(), expected = together.values(), plain = as_made.values();
  ASSERT_EQ(values.size(), 4 * contact_statistics().size());
  double most = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const double value = values[3 * expected.size() + k];
    EXPECT_EQ(std::isnan(value), std::isnan(expected[k])) << contact_statistics()[k].name << contact_statistics()[k].subject;
    if (std::isnan(value)) continue;
    // rounding of sums of some hundred numbers
    EXPECT_NEAR(value, expected[k], 1e-12) << contact_statistics()[k].name << contact_statistics()[k].subject;
    most = std::max(most, std::abs(value - plain[k]));
  }
  EXPECT_GT(most, 0.01) << "the proportions must show";
}

// The weights of a sample's own grasps are 1: it is what it is, also where a vessel has fewer grasps than it should.
TEST(VesselTallies, AllOfASampleAreItsGrasps) {
  const std::vector<StudyVessel> vessels = pool_vessels();
  ContactPool pool(vessels, 30);
  for (std::uint64_t person = 0; person < 30; ++person)
    pool.add(person_grasps(person, person % 3 == 0 ? std::set<std::size_t>{0, 2, 4} : std::set<std::size_t>{5}));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    ContactTally together;
    const auto drawn = pool.draw(1, seed);
    for (std::size_t v = 0; v < 3; ++v)
      for (const ContactGrasp* grasp : drawn[v]) together.add(*grasp);
    const std::vector<double> sample = pool.sample(1, seed), expected = together.values();
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const double value = sample[4 * expected.size() + k];
      EXPECT_EQ(std::isnan(value), std::isnan(expected[k])) << contact_statistics()[k].name;
      if (std::isnan(value)) continue;
      EXPECT_NEAR(value, expected[k], 1e-12) << contact_statistics()[k].name;
    }
  }
}

}  // namespace
}  // namespace wholehand
