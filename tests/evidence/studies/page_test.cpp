// SPDX-License-Identifier: MIT
// The page of a study and its tables, on rows that are made up.
// sanitizers: address
#include "evidence/studies/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "evidence/studies/answer.h"
#include "evidence/studies/session_page.h"
#include "evidence/studies/statistic_words.h"
#include "evidence/studies/summary.h"
#include "tests/support/files.h"
#include "tests/support/xml.h"

namespace wholehand {
namespace {

std::vector<StudyRow> made_up_rows() {
  return {
      {"forces", "", "all", "lost_share", "0.8-3.8", 0.125, {0, 0.25}, 0.1},
      {"forces", "", "all", "lost_share", "1.2-4.2", 0.5, {0.25, 0.75}, 0.1},
      {"forces", "", "all", "coefficient_base", "", -2.5, {-3, 1e-5}, std::nullopt},
      {"forces", "", "a<b", "held_share", "", std::nan(""), {}, std::nullopt},
      {"forces", "", "all", "inside_share", "", 0.5, {}, std::nullopt},
  };
}

StudyPage page_with(const StudySection& section) {
  StudyPage page;
  page.title = "How do people grasp <this>?";
  page.lead = "5 people.";
  page.sections = {section};
  page.seed = 7;
  return page;
}

TEST(StudyPage, ShowsTheRowsOfAnyExperiment) {
  StudySection section{"forces", "Forces", {"First words."}, made_up_rows()};
  section.charts = {"<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>"};
  const std::string page = study_page(page_with(section)), start = "<!DOCTYPE html>\n";
  ASSERT_TRUE(page.starts_with(start));
  expect_well_formed(page.substr(start.size()));
  EXPECT_TRUE(has(page, "content=\"seed 7\""));
  EXPECT_TRUE(has(page, "1 of 2 statistics of the paper are inside their intervals."));
  EXPECT_TRUE(has(page, "12.5 %")) << "a share";
  EXPECT_TRUE(has(page, "0.8-3.8"));
  EXPECT_TRUE(has(page, "\u22123.000 to 1.0e\u221205")) << "minus signs are as wide as plus signs";
  EXPECT_TRUE(has(page, "The vessel a&lt;b"));
  EXPECT_TRUE(has(page, "<figure><svg")) << "a chart";
  EXPECT_FALSE(has(page, "inside share")) << "the line says it";
  EXPECT_TRUE(has(page, "<a href=\"#forces\">Forces</a>"));
  EXPECT_LT(page.find("First words."), page.find("<table"));
  EXPECT_LT(page.find("</table>"), page.find("<figure>"));
}

TEST(StudyPage, WithoutSubjectsThereIsNoColumnForThem) {
  std::vector<StudyRow> rows = made_up_rows();
  EXPECT_EQ(count_of(study_page(page_with({"a", "A", {}, rows})), "<th scope=\"col\""), 2 * 6);
  for (StudyRow& row : rows) row.subject.clear();
  EXPECT_EQ(count_of(study_page(page_with({"a", "A", {}, rows})), "<th scope=\"col\""), 2 * 5);
}

TEST(StudyPage, SaysWhoThePeopleAre) {
  const SessionVessels vessels{{1, "glass"}, {2, "jug"}};
  const StudySection recorded = session_section(vessels, made_up_rows(), false),
                     simulated = session_section(vessels, made_up_rows(), true);
  EXPECT_TRUE(has(recorded.words.front(), "glass stands for the paper's vessel 1: 22, jug stands for the paper's vessel 2: 32"));
  EXPECT_TRUE(has(recorded.words.back(), "those of the recordings"));
  EXPECT_TRUE(has(simulated.words.back(), "virtual"));
}

// Rows on every side of their intervals, one of them without width.
std::vector<StudyRow> compared_rows() {
  return {
      {"contacts", "paper", "all", "held_share", "", 1, {1, 1}, std::nullopt},
      {"forces", "", "beaker", "lost_share", "0.8-3.8", 0, {0, 0}, 0.0},
      {"forces", "", "beaker", "lost_share", "1.2", 0, {0, 0}, 0.5},
      {"sessions", "", "all", "grip_after_mean", "", 4, {3, 5}, 4.5},
      {"sessions", "", "all", "grip_stopped_mean", "", 4, {3, 5}, 6.0},
      {"sessions", "", "all", "normal_increase_mean", "", 4, {3, 5}, -8.0},
      {"sessions", "", "jug", "correlation_increase_change", "", 0.5, {0.25, 0.75}, 0.0},
      {"sessions", "", "jug", "g1_share", "", 0.5, {}, 0.25},
  };
}

TEST(StudyAnswer, CountsEachExperiment) {
  EXPECT_EQ(
      answer_sentence(compared_rows()),
      "2 of 6 of the paper\u2019s numbers lie inside our 95 % intervals: 1 of 2 for forces, 1 of 4 for sessions. The paper\u2019s "
      "numbers for contacts are not known here, so ours are predictions.");
  EXPECT_EQ(answer_sentence({}), "None of the paper\u2019s numbers can be compared here.");
}

TEST(StudyAnswer, APictureAndTheMisses) {
  const StudySection section = answer_section(compared_rows());
  ASSERT_EQ(section.rows.size(), 6u) << "without those that nothing is compared with";
  const std::string page = study_page(page_with(section)), start = "<!DOCTYPE html>\n";
  expect_well_formed(page.substr(start.size()));
  const std::string picture = page.substr(page.find("<svg"), page.find("</svg>") - page.find("<svg"));
  // each kind once more in the key
  EXPECT_EQ(count_of(picture, "<rect class=\"box\""), 4 + 1);
  EXPECT_EQ(count_of(picture, "<circle class=\"inside\""), 2 + 1);
  EXPECT_EQ(count_of(picture, "<path class=\"outside\""), 4 + 2);
  EXPECT_EQ(count_of(picture, "head\">"), 3) << "experiments and vessels";
  EXPECT_LT(picture.find("Forces, beaker<"), picture.find("Sessions, all vessels<"));
  EXPECT_LT(picture.find("Sessions, all vessels<"), picture.find("Sessions, jug<"));
  EXPECT_TRUE(has(picture, "grip after, mean (N): 4.000 (3.000 to 5.000), the paper 4.500, inside.")) << "for screen readers";
  // from 6 N to the nearer end, 5 N: 17 % less
  EXPECT_TRUE(has(page, "<td>6.000</td>\n<td>5.000</td>\n<td>\u22121.000</td>\n<td>\u221217 %</td>"))
      << page.substr(page.find("<table"));
  EXPECT_TRUE(has(page, "<td>\u22128.000</td>\n<td>3.000</td>\n<td>+11.000</td>\n<td>+138 %</td>"));
  EXPECT_TRUE(has(page, "<td>0.000</td>\n<td>0.250</td>\n<td>+0.250</td>\n<td>\u2013</td>")) << "no share of 0";
  EXPECT_FALSE(has(page, "<td>4.500</td>")) << "it is inside";
  EXPECT_EQ(count_of(study_page(page_with(answer_section({}))), "<svg"), 0);
}

TEST(StudySummary, ATableForEachExperiment) {
  std::vector<StudyRow> rows = made_up_rows();
  StudyRow other{"sessions", "", "all", "response_time_mean", "", 0.125, {0.1, 0.15}, 0.106};
  rows.push_back(other);
  const std::string text = study_summary(rows);
  EXPECT_EQ(count_of(text, "95 % interval"), 1) << "forces have a line for each choice";
  EXPECT_TRUE(has(text, "\n1.2-4.2")) << text;
  EXPECT_TRUE(has(text, "open 0.5 mm")) << text;
  EXPECT_TRUE(has(text, "response time, mean (s)")) << text;
  EXPECT_TRUE(has(text, "0.100 to 0.150")) << text;
  EXPECT_TRUE(has(text, "1 of 1 statistics of the paper")) << text;
  EXPECT_EQ(study_summary({}), "");
}

TEST(StatisticWords, NamesAndValues) {
  EXPECT_EQ(statistic_words("grip_before_deviation"), "grip before, deviation (N)");
  EXPECT_EQ(statistic_words("tilt_time_mean"), "tilt time, mean (s)");
  EXPECT_EQ(statistic_words("g4_share"), "type G4");
  EXPECT_EQ(statistic_words("something_else"), "something else");
  EXPECT_EQ(statistic_value("lost_share", 0.0333), "3.3 %");
  EXPECT_EQ(statistic_value("anova_p", 2.5e-7), "2.5e-07");
  EXPECT_EQ(statistic_value("anova_f", 0), "0.000");
  EXPECT_EQ(statistic_value("anova_f", 49930541.899), "5.0e+07");
  EXPECT_EQ(statistic_value("anova_f", std::nan("")), "-");
  EXPECT_EQ(inside_sentence({}), "No statistic has both an interval and a value of the paper.");
}

}  // namespace
}  // namespace wholehand
