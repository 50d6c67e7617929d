// SPDX-License-Identifier: MIT
// The experiment of advice: sessions that repeat, differences person by person, and words that say where it does not help.
// sanitizers: address
#include "evidence/studies/advice_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/advised_session.h"

namespace wholehand {
namespace {

constexpr double NO_NUMBER = std::numeric_limits<double>::quiet_NaN();

AdvisedPerson person(double effort_without, double effort_with, double lost_with = 0) {
  return {{4, 0, effort_without, 50, 1}, {4, lost_with, effort_with, 53, 1}};
}

const StudyRow& row_of(const std::vector<StudyRow>& rows, const std::string& statistic, const std::string& subject) {
  for (const StudyRow& row : rows)
    if (row.statistic == statistic && row.subject == subject) return row;
  throw std::runtime_error("no such row");
}

// People differ much, and advice takes the same from each: only a paired interval sees that.
TEST(AdviceStatistics, AreOfDifferencesPersonByPerson) {
  std::vector<AdvisedPerson> people;
  for (int k = 0; k < 20; ++k) people.push_back(person(0.2 + 0.05 * k, 0.1 + 0.05 * k + (k % 2 == 0 ? 0.01 : -0.01)));
  const std::vector<StudyRow> rows = advice_rows(people, 1, 500, 2);
  ASSERT_EQ(rows.size(), 9u);
  const StudyRow& without = row_of(rows, "effort_mean", "without");
  const StudyRow& difference = row_of(rows, "effort_mean", "difference");
  EXPECT_NEAR(without.value, 0.675, 1e-12);
  EXPECT_NEAR(difference.value, -0.1, 1e-12);
  // the standard error of the difference is 0.01 / sqrt(20), that of the mean a hundred times as much
  EXPECT_GT(difference.interval.low, -0.11);
  EXPECT_LT(difference.interval.high, -0.09);
  EXPECT_GT(without.interval.high - without.interval.low, 0.1);
  EXPECT_EQ(row_of(rows, "time_mean", "difference").value, 3);
  EXPECT_EQ(without.count.people, std::optional<std::uint64_t>(20));
  EXPECT_EQ(row_of(rows, "lost_share", "difference").value, 0);
  const std::vector<StudyRow> again = advice_rows(people, 1, 500, 1);
  for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_EQ(rows[k].interval.low, again[k].interval.low);
}

TEST(AdviceStatistics, SayWhereItDoesNotHelp) {
  std::vector<AdvisedPerson> people;
  for (int k = 0; k < 12; ++k) people.push_back(person(0.3, 0.2, k % 2));
  const std::vector<std::string> words = advice_sentences(advice_rows(people, 1, 200, 1));
  ASSERT_EQ(words.size(), 3u);
  EXPECT_TRUE(words[0].starts_with("Lost grips: 0.125 more with advice, (0.")) << words[0];
  EXPECT_TRUE(words[0].ends_with("Here advice costs.")) << words[0];
  EXPECT_EQ(words[1], "Effort: 0.100 lower with advice, (-0.100 to -0.100). Here advice helps.");
  people.assign(5, person(0.3, 0.3));
  EXPECT_EQ(advice_sentences(advice_rows(people, 1, 200, 1))[1],
            "Effort: no difference is seen, 0.000 (0.000 to 0.000). Here advice does not help.");
  EXPECT_EQ(advice_sentences(advice_rows(std::vector{person(0.3, 0.2)}, 1, 200, 1))[1], "Effort: there are too few people to say.");
}

// A person without a grasp in one of the sessions has no share and no effort; a session that did not end has no time.
TEST(AdviceStatistics, LeaveOutWhatIsNotThere) {
  std::vector<AdvisedPerson> people(3, person(0.3, 0.2));
  people.push_back({{0, 0, NO_NUMBER, 600, 0}, {4, 4, 0.9, 50, 1}});
  const std::vector<StudyRow> rows = advice_rows(people, 1, 200, 1);
  EXPECT_NEAR(row_of(rows, "effort_mean", "with").value, 0.2, 1e-12);
  EXPECT_EQ(row_of(rows, "lost_share", "with").value, 0);
  EXPECT_EQ(row_of(rows, "time_mean", "without").value, 50);
}

// One beaker that is poured from.
Scene poured_from() {
  Scene scene = advised_session_scene();
  scene.vessels[0].liquid_name = "water";
  scene.vessels[0].liquid_fill = 0.5;
  scene.task->amounts = {{"water", 20e-6}};
  scene.task->tolerance = 5e-6;
  return scene;
}

// The person takes the advised grip, which is better, and a second time the same.
TEST(AdvisedPerson, TakesABetterGripAndRepeats) {
  const Scene scene = poured_from();
  const std::atomic<bool> stop{false};
  const AdvisedPerson one = advised_person(scene, 1, 3, stop);
  ASSERT_GT(one.without.grasps, 0);
  ASSERT_GT(one.with.grasps, 0);
  EXPECT_EQ(one.without.is_whole + one.with.is_whole, 2);
  EXPECT_LT(one.with.effort, one.without.effort);
  EXPECT_GT(one.with.effort, 0);
  EXPECT_GT(one.with.seconds, one.without.seconds) << "looking takes time";
  const std::vector<double> numbers = to_numbers(one), again = to_numbers(advised_person(scene, 1, 3, stop));
  EXPECT_EQ(numbers, again);
  EXPECT_EQ(to_numbers(person_from_numbers(numbers)), numbers);
}

// A session whose advice has ended is none with advice.
TEST(AdvisedPerson, IsNoOutcomeWhereTheAdviceFails) {
  const std::atomic<bool> stop{false};
  const Scene scene = poured_from();
  try {
    advised_person(scene, 1, 3, stop, dying_adviser(2));
    FAIL() << "it is an outcome";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_STREQ(error.what(),
                 "person 3 has no session with advice: advice: the device is gone; the session goes on without advice");
  }
}

}  // namespace
}  // namespace wholehand
