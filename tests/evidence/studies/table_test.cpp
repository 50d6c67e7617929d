// SPDX-License-Identifier: MIT
// The rows of study.csv, cell by cell.
#include "evidence/studies/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/files/csv.h"
#include "evidence/studies/output.h"

namespace wholehand {
namespace {

TEST(StudyTable, HasTheColumnsOfTheIssue) {
  EXPECT_EQ(STUDY_CSV_START, "experiment,pose,vessel,statistic,subject,value,low,high,paper,inside\n");
  EXPECT_EQ(study_csv({}), STUDY_CSV_START);
}

TEST(StudyTable, LeavesEmptyWhatIsAbsent) {
  const std::vector<StudyRow> rows{
      {"contacts", "paper", "beaker1", "point_biserial_height", "thumb_mcp", 0.25, {0.125, 0.5}, std::nullopt},
      {"contacts", "paper", "a, b", "held_share", "", 1, {}, std::nullopt},
      {"sessions", "", "all", "response_s", "", 0.25, {0.125, 0.5}, 0.5},
      {"sessions", "", "all", "response_s", "", 0.25, {0.125, 0.5}, 0.0625},
      {"sessions", "", "all", "response_s", "", 0.25, {}, 0.0625},
      {"contacts", "paper", "beaker1", "pearson_fingers_height", "", std::nan(""), {}, std::nullopt},
  };
  EXPECT_EQ(study_csv(rows), std::string(STUDY_CSV_START) +
                                 "contacts,paper,beaker1,point_biserial_height,thumb_mcp,0.25,0.125,0.5,,\n"
                                 "contacts,paper,\"a, b\",held_share,,1,,,,\n"
                                 "sessions,,all,response_s,,0.25,0.125,0.5,0.5,1\n"
                                 "sessions,,all,response_s,,0.25,0.125,0.5,0.0625,0\n"
                                 "sessions,,all,response_s,,0.25,,,0.0625,\n"
                                 "contacts,paper,beaker1,pearson_fingers_height,,,,,,\n");
  for (const CsvRow& row : parse_csv(study_csv(rows))) EXPECT_EQ(row.cells.size(), 10u);
}

}  // namespace
}  // namespace wholehand
