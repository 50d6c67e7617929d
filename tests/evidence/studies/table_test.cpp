// SPDX-License-Identifier: MIT
// The rows of study.csv, cell by cell.
#include "evidence/studies/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/files/csv.h"
#include "evidence/studies/output.h"
#include "evidence/studies/statistic_words.h"

namespace wholehand {
namespace {

TEST(StudyTable, HasTheColumnsOfTheIssue) {
  EXPECT_EQ(study_csv({}), "experiment,pose,vessel,statistic,subject,value,low,high,paper,inside,unit,people,grasps,off\n");
  EXPECT_TRUE(study_csv({}).starts_with(STUDY_CSV_START)) << "by which a folder knows its table";
}

TEST(StudyTable, LeavesEmptyWhatIsAbsent) {
  const std::vector<StudyRow> rows{
      {"contacts", "paper", "beaker1", "point_biserial_height", "thumb_mcp", 0.25, {0.125, 0.5}, std::nullopt},
      {"contacts", "paper", "a, b", "held_share", "", 1, {}, std::nullopt},
      {"sessions", "", "all", "response_time_mean", "", 0.25, {0.125, 0.5}, 0.5, {3, 7}},
      {"sessions", "", "all", "grip_before_mean", "", 0.25, {0.125, 0.5}, 0.0625, {0, 0}},
      {"sessions", "", "all", "correlation_before_change", "", 0.25, {-0.25, 0.5}, 0.75, {3}},
      {"sessions", "", "all", "g4_share", "", 0.25, {}, 0.0625},
      {"contacts", "paper", "beaker1", "pearson_fingers_height", "", std::nan(""), {}, std::nullopt},
  };
  EXPECT_EQ(study_csv(rows), study_csv({}) +
                                 "contacts,paper,beaker1,point_biserial_height,thumb_mcp,0.25,0.125,0.5,,,1,,,\n"
                                 "contacts,paper,\"a, b\",held_share,,1,,,,,1,,,\n"
                                 "sessions,,all,response_time_mean,,0.25,0.125,0.5,0.5,1,s,3,7,0\n"
                                 "sessions,,all,grip_before_mean,,0.25,0.125,0.5,0.0625,0,N,0,0,0.0625\n"
                                 "sessions,,all,correlation_before_change,,0.25,-0.25,0.5,0.75,0,1,3,,-0.25\n"
                                 "sessions,,all,g4_share,,0.25,,,0.0625,,1,,,\n"
                                 "contacts,paper,beaker1,pearson_fingers_height,,,,,,,1,,,\n");
  for (const CsvRow& row : parse_csv(study_csv(rows))) EXPECT_EQ(row.cells.size(), 14u);
}

TEST(StudyTable, HasTheUnitsOfAllStatistics) {
  const std::pair<const char*, const char*> units[] = {{"response_time_mean", "s"},
                                                       {"tilt_time_deviation", "s"},
                                                       {"maintained_time_mean", "s"},
                                                       {"time_mean", "s"},
                                                       {"grip_stopped_deviation", "N"},
                                                       {"normal_increase_mean", "N"},
                                                       {"largest_opening_mean", "m"},
                                                       {"coefficient_range", "N-1"},
                                                       {"effort_mean", "1"},
                                                       {"mean_points", "1"},
                                                       {"opening_over_1mm_share", "1"},
                                                       {"anova_f", "1"},
                                                       {"first_order_of_grip_stopped", "1"},
                                                       {"first_order_of_paper_mean_distance", "1"}};
  for (const auto& [statistic, unit] : units) EXPECT_EQ(statistic_unit(statistic), unit) << statistic;
}

}  // namespace
}  // namespace wholehand
