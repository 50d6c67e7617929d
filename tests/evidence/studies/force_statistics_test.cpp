// SPDX-License-Identifier: MIT
// Table 2 from made outcomes, whose answers are known.
#include "evidence/studies/force_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace wholehand {
namespace {

// The first `lost` of `people` lose the grip often, at each choice.
std::vector<ForcesOfPerson> made(std::size_t people, const std::array<std::size_t, FORCE_CHOICES>& lost) {
  std::vector<ForcesOfPerson> all(people);
  for (std::size_t person = 0; person < people; ++person)
    for (std::size_t k = 0; k < FORCE_CHOICES; ++k)
      all[person][k] = {true, false, person < lost[k] ? OFTEN : 0, person < lost[k] ? 3e-3 : 0.2e-3, person >= lost[k]};
  return all;
}

const StudyRow& row(const std::vector<StudyRow>& rows, const std::string& statistic, const std::string& subject) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const StudyRow& one) { return one.statistic == statistic && one.subject == subject; });
  EXPECT_NE(found, rows.end()) << statistic << ' ' << subject;
  return found == rows.end() ? rows.front() : *found;
}

std::array<std::size_t, FORCE_CHOICES> losses_of_paper() {
  std::array<std::size_t, FORCE_CHOICES> lost{};
  for (std::size_t k = 0; k < FORCE_CHOICES; ++k) lost[k] = static_cast<std::size_t>(PAPER_CHOICES[k].paper_lost);
  return lost;
}

// Ten people who do as the paper's: every sample of ten is all of them.
TEST(ForceStatistics, ThePapersPeopleAreInside) {
  const std::vector<StudyRow> rows = force_rows(made(10, losses_of_paper()), "beaker1", 1, 50, 1);
  std::size_t compared = 0;
  for (const StudyRow& one : rows) {
    EXPECT_EQ(one.experiment, "forces");
    EXPECT_EQ(one.vessel, "beaker1");
    if (!one.paper) continue;
    ++compared;
    EXPECT_EQ(one.value, *one.paper) << one.statistic << ' ' << one.subject;
    EXPECT_EQ(one.inside(), std::optional(true)) << one.statistic << ' ' << one.subject;
  }
  EXPECT_EQ(compared, FORCE_CHOICES + 1);
  EXPECT_EQ(row(rows, "lost_share", "1.6").value, 0.3);
  EXPECT_EQ(row(rows, "held_share", "1.6").value, 0.7);
  EXPECT_EQ(row(rows, "opening_over_1mm_share", "1.6").value, 0.3);
  EXPECT_NEAR(row(rows, "largest_opening_mean", "1.6").value, 0.3 * 3e-3 + 0.7 * 0.2e-3, 1e-12);
  EXPECT_EQ(row(rows, "base_ahead_of_range", "lost").value, 1);
}

// Three choices of forces and a share of losses in each fix both coefficients: log odds of 1/4, 1/2 and 1/2.
TEST(ForceStatistics, CoefficientsAreThoseOfTheOdds) {
  std::vector<ForcesOfPerson> people(40);
  for (std::size_t person = 0; person < people.size(); ++person) {
    people[person][0] = {true, false, person < 10 ? OFTEN : 0, 0};  // 0, 0
    people[person][4] = {true, false, person < 20 ? OFTEN : 0, 0};  // 1.6, 0
    people[person][6] = {true, false, person < 20 ? OFTEN : 0, 0};  // 0, 2
  }
  const std::vector<StudyRow> rows = force_rows(people, "v", 1, 10, 1);
  EXPECT_NEAR(row(rows, "coefficient_base", "lost").value, std::log(3.0) / 1.6, 1e-6);
  EXPECT_NEAR(row(rows, "coefficient_range", "lost").value, std::log(3.0) / 2, 1e-6);
  EXPECT_EQ(row(rows, "base_ahead_of_range", "lost").value, 1);
  EXPECT_TRUE(std::isnan(row(rows, "lost_share", "0.4").value)) << "nobody gripped";
  const auto has_count = [&](const std::string& statistic, const std::string& subject, std::uint64_t of_people,
                             std::uint64_t trials) {
    const StudyCount& count = row(rows, statistic, subject).count;
    EXPECT_EQ(count.people, std::optional(of_people)) << statistic << ' ' << subject;
    EXPECT_EQ(count.grasps, std::optional(trials)) << statistic << ' ' << subject;
  };
  has_count("lost_share", "0.4", 0, 0);
  has_count("lost_share", "1.6", 40, 40);
  has_count("gripped_share", "0.4", 40, 40);
  has_count("coefficient_base", "lost", 40, 120);
}

TEST(ForceStatistics, NobodyLosesSoNothingSaysWhatMattersMore) {
  const std::vector<StudyRow> rows = force_rows(made(12, {}), "v", 1, 20, 1);
  EXPECT_TRUE(std::isnan(row(rows, "coefficient_base", "lost").value));
  EXPECT_TRUE(std::isnan(row(rows, "base_ahead_of_range", "lost").value));
  EXPECT_FALSE(row(rows, "base_ahead_of_range", "lost").inside());
  EXPECT_EQ(row(rows, "lost_share", "2.2").value, 0);
  EXPECT_EQ(row(rows, "lost_share", "2.2").inside(), std::optional(false));
}

// Whole counts of ten people hold 95 % or more. Each end is the tightest that leaves no more than 2.5 % beyond it, by the binomial distribution where
// many people are known. Shares for which a tail is within three errors of 2.5 %, by 4,000 samples, are left out.
TEST(ForceStatistics, IntervalsAreTheTightestWholeCountsOfTenPeople) {
  const std::map<std::size_t, double> shares{{0, 0.1}, {1, 0.2}, {2, 0.4},  {3, 0.5}, {4, 0.6},
                                             {5, 0.8}, {6, 0.9}, {7, 0.01}, {8, 1}};
  std::array<std::size_t, FORCE_CHOICES> losing{};
  for (const auto& [choice, share] : shares) losing[choice] = static_cast<std::size_t>(std::lround(share * 4000));
  const std::vector<StudyRow> rows = force_rows(made(4000, losing), "v", 3, 4000, 2);
  for (const auto& [choice, share] : shares) {
    double below = 0, chance = std::pow(1 - share, 10);  // of fewer than `count`, and of `count`
    int low = -1, high = -1;
    for (int count = 0; count <= 10; ++count) {
      if (low < 0 && below + chance > 0.025) low = count;
      if (high < 0 && below + chance >= 0.975) high = count;
      below += chance;
      chance = share < 1 ? chance * (10 - count) / (count + 1) * share / (1 - share) : count == 9 ? 1 : 0;
    }
    const Interval found = row(rows, "lost_share", choice_name(PAPER_CHOICES[choice])).interval;
    EXPECT_EQ(found.low, low / 10.0) << share;
    EXPECT_EQ(found.high, high / 10.0) << share;
  }
}

TEST(ForceStatistics, FewerThanTenPeopleHaveNoIntervalsAndThreadsChangeNothing) {
  const auto few = force_rows(made(9, losses_of_paper()), "v", 1, 20, 1);
  EXPECT_TRUE(std::isnan(row(few, "lost_share", "1.2").interval.low));
  const auto people = made(30, losses_of_paper());
  const auto one = force_rows(people, "v", 1, 40, 1), three = force_rows(people, "v", 1, 40, 3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    EXPECT_TRUE(same(one[k].value, three[k].value)) << k;
    EXPECT_TRUE(same(one[k].interval.low, three[k].interval.low)) << k;
    EXPECT_TRUE(same(one[k].interval.high, three[k].interval.high)) << k;
  }
}

}  // namespace
}  // namespace wholehand
