// SPDX-License-Identifier: MIT
// Rows of grasps.csv and people.csv, cell by cell.
#include "evidence/studies/grasp_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/files/csv.h"
#include "core/people/person.h"
#include "evidence/studies/output.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using Cells = std::map<std::string, std::string>;

// The rows by column. All rows have all columns.
std::vector<Cells> cells_of(const std::string& head, const std::string& rows) {
  const std::vector<CsvRow> all = parse_csv(head + rows);
  std::vector<Cells> cells;
  for (std::size_t k = 1; k < all.size(); ++k) {
    EXPECT_EQ(all[k].cells.size(), all[0].cells.size()) << rows;
    for (std::size_t c = 0; c < all[0].cells.size(); ++c) cells.resize(k), cells[k - 1][all[0].cells[c]] = all[k].cells.at(c);
  }
  return cells;
}

// What the row has, without its empty cells.
Cells filled(Cells cells) {
  std::erase_if(cells, [](const auto& cell) { return cell.second.empty(); });
  return cells;
}

const TablePerson ANN{7, "female,172.5,78"};

TEST(GraspTable, ContactsHaveARowForEachGraspAndPose) {
  Scene scene = scene_of({cylinder("a, b", 70, 95, 2)});
  scene.vessels[0].guidance = {{50e-3, 0}};
  const ContactPlan plan(scene);
  const std::size_t planned = plan.grasps().size();
  std::vector<ContactGrasp> grasps(2 * planned);
  // thumb tip, index tip and middle pip touch
  grasps[planned] = {0.0625, 0.0125, 1u << 3 | 1u << 8 | 1u << 11, 1, 6, 0, 7, true, true};
  grasps[0].height = 0.05;
  const std::vector<Cells> rows = cells_of(grasps_csv_head(), contact_grasp_rows(plan, ANN, grasps));
  ASSERT_EQ(rows.size(), 2 * planned);
  EXPECT_EQ(filled(rows[0]), (Cells{{"experiment", "contacts"},
                                    {"pose", "paper"},
                                    {"vessel", "a, b"},
                                    {"person", "7"},
                                    {"sex", "female"},
                                    {"hand_length_mm", "172.5"},
                                    {"hand_breadth_mm", "78"},
                                    {"grasp", "1"},
                                    {"height_mm", "50"},
                                    {"held", "0"}}))
      << "what is not held has nothing else";
  Cells held = rows[planned];
  EXPECT_EQ(held["pose"], "articulated");
  EXPECT_EQ(held["grasp"], "1");
  const Cells expected{{"height_mm", "62.5"}, {"distance_mm", "12.5"}, {"held", "1"},       {"plausible", "1"},
                       {"fingers", "3"},      {"points", "3"},         {"tip_points", "1"}, {"finger_points", "2"},
                       {"inner_points", "0"}, {"thumb_tip", "1"},      {"index_tip", "1"},  {"middle_pip", "1"},
                       {"middle_mcp", "0"},   {"little_tip", "0"},     {"gripped", ""},     {"outcome", ""}};
  for (const auto& [column, cell] : expected) EXPECT_EQ(held[column], cell) << column;
}

TEST(GraspTable, ForcesHaveARowForEachTrial) {
  ForcesOfPerson forces{};
  forces[8] = {true, false, 1, 0.5e-3, true};
  const std::vector<Cells> rows = cells_of(grasps_csv_head(), force_grasp_rows("v", {0}, forces));
  ASSERT_EQ(rows.size(), FORCE_CHOICES);
  EXPECT_EQ(
      filled(rows[7]),
      (Cells{
          {"experiment", "forces"}, {"vessel", "v"}, {"subject", "0.4-2.4"}, {"person", "0"}, {"grasp", "8"}, {"gripped", "0"}}));
  EXPECT_EQ(filled(rows[8]), (Cells{{"experiment", "forces"},
                                    {"vessel", "v"},
                                    {"subject", "0.8-3.8"},
                                    {"person", "0"},
                                    {"grasp", "9"},
                                    {"gripped", "1"},
                                    {"succeeded", "1"},
                                    {"oscillated", "0"},
                                    {"losses", "1"},
                                    {"opening_mm", "0.5"}}));
}

TEST(GraspTable, SessionsHaveTheMeasuresOfAReport) {
  const Scene scene = scene_of({beaker1(), beaker3()});
  device::GraspReport grasp;
  grasp.vessel = 1;
  grasp.start = 2;
  grasp.response_time = 0.125;
  grasp.largest_tilt = radians(60);
  grasp.after_at_first = 4.5;
  grasp.course = device::GripCourse::complex;
  grasp.outcome = device::GraspOutcome::lost;
  const std::vector<Cells> rows = cells_of(grasps_csv_head(), session_grasp_rows(scene, ANN, std::vector{grasp, grasp}));
  ASSERT_EQ(rows.size(), 2u);
  Cells second = rows[1];
  const Cells expected{{"experiment", "sessions"},
                       {"vessel", scene.vessels[1].name},
                       {"grasp", "2"},
                       {"start_s", "2"},
                       {"response_time_s", "0.125"},
                       {"grip_stopped_N", ""},
                       {"type", "G4"},
                       {"outcome", "lost"},
                       {"grip_at_first_N", "4.5"},
                       {"height_mm", ""},
                       {"gripped", ""},
                       {"person", "7"}};
  for (const auto& [column, cell] : expected) EXPECT_EQ(second[column], cell) << column;
  EXPECT_NEAR(std::stod(second["largest_tilt_deg"]), 60, 1e-7);
}

TEST(GraspTable, PeopleAreThoseOfThePopulation) {
  PeopleData people;
  const Person person = draw_person(people, 5, 3);
  Cells cells = cells_of(people_csv_head(), person_row(people, 5, 3)).at(0);
  const auto near = [&](const char* column, double value) {
    EXPECT_NEAR(std::stod(cells[column]), value, 1e-8 * std::abs(value)) << column;
  };
  EXPECT_EQ(cells.size(), 1 + person_input_names().size());
  EXPECT_TRUE(people_csv_head().starts_with(PEOPLE_CSV_START));
  EXPECT_EQ(cells["person"], "3");
  EXPECT_EQ(cells["sex"], person.sex == Sex::female ? "female" : "male");
  near("hand_length_mm", person.hand.length * 1e3);
  near("thumb_metacarpal", person.segments.front());
  near("little_distal", person.segments.back());
  near("height_mm", person.traits[Trait::height] * 1e3);
  near("azimuth_deg", degrees(person.traits[Trait::azimuth]));
  near("tremor_Hz", person.traits[Trait::tremor_rate]);
  near("grip_error", person.traits[Trait::grip_error]);
  EXPECT_EQ(table_person(people, 5, 3).cells, cells["sex"] + "," + cells["hand_length_mm"] + "," + cells["hand_breadth_mm"]);
  people.scatter = 0;
  EXPECT_TRUE(table_person(people, 5, 3).cells.starts_with(",")) << "the mean person has no sex";
}

}  // namespace
}  // namespace wholehand
