// SPDX-License-Identifier: MIT
#include "evidence/studies/grasp_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>

#include "base/files/csv.h"
#include "core/joints.h"
#include "core/people/person.h"
#include "device/recordings/session_report.h"
#include "evidence/studies/output.h"

namespace wholehand {
namespace {

constexpr double MM = 1e-3;
constexpr const char* FORCE_COLUMNS = ",gripped,succeeded,oscillated,losses,opening_mm";

std::string contact_columns() {
  std::string columns = "height_mm,distance_mm,held,plausible,fingers,points,tip_points,finger_points,inner_points";
  for (int joint = 0; joint < JOINT_COUNT; ++joint) columns += "," + joint_key(joint);
  return columns;
}

std::string session_columns() { return fmt::format(",{},grip_at_first_N", device::GRASP_COLUMNS); }

// As many commas as `columns` has: the cells of another experiment, all empty.
std::string empty_cells(std::string_view columns) {
  return std::string(static_cast<std::size_t>(std::count(columns.begin(), columns.end(), ',')), ',');
}

std::string row_start(const char* experiment, const char* pose, const std::string& vessel, const std::string& subject,
                      const TablePerson& person, std::size_t grasp) {
  return fmt::format("{},{},{},{},{},{},{},", experiment, pose, csv_text(vessel), subject, person.number, person.cells, grasp + 1);
}

std::string contact_cells(const ContactGrasp& grasp) {
  std::string cells = csv_number(grasp.height, MM);
  if (!grasp.is_held) return cells + ",,0" + std::string(6 + JOINT_COUNT, ',');
  cells += fmt::format(",{},1,{},{},{},{},{},{}", csv_number(grasp.distance, MM), grasp.is_plausible ? 1 : 0,
                       std::popcount(grasp.used_mask), std::popcount(grasp.touch_mask), std::popcount(grasp.tip_mask),
                       std::popcount(grasp.finger_mask), std::popcount(grasp.inner_mask));
  for (int joint = 0; joint < JOINT_COUNT; ++joint) cells += (grasp.touch_mask >> joint & 1) != 0 ? ",1" : ",0";
  return cells;
}

std::string force_cells(const ForceOutcome& one) {
  if (!one.has_gripped) return ",0,,,,";
  return fmt::format(",1,{},{},{},{}", one.has_succeeded ? 1 : 0, one.oscillates ? 1 : 0, one.losses, csv_number(one.opening, MM));
}

std::string sex_and_size(const PeopleData& people, const Person& person) {
  const char* sex = people.scatter == 0 ? "" : person.sex == Sex::female ? "female" : "male";
  return fmt::format("{},{},{}", sex, csv_number(person.hand.length, MM), csv_number(person.hand.breadth, MM));
}

// The unit that the end of a trait's key names, in SI.
double unit_of_trait(std::string_view key) { return key.ends_with("_mm") ? MM : key.ends_with("_deg") ? radians(1) : 1; }

}  // namespace

std::string grasps_csv_head() {
  return fmt::format("{}{}{}{}\n", GRASPS_CSV_START, contact_columns(), FORCE_COLUMNS, session_columns());
}

std::string people_csv_head() {
  std::string head{PEOPLE_CSV_START};
  for (const std::string& name : std::span(person_input_names()).subspan(3)) head += name + ",";
  head.back() = '\n';
  return head;
}

TablePerson table_person(const PeopleData& people, std::uint64_t seed, std::uint64_t number) {
  return {number, sex_and_size(people, draw_person(people, seed, number))};
}

std::string person_row(const PeopleData& people, std::uint64_t seed, std::uint64_t number) {
  const Person person = draw_person(people, seed, number);
  std::string row = fmt::format("{},{}", number, sex_and_size(people, person));
  for (const double ratio : person.segments) row += "," + csv_number(ratio);
  for (std::size_t k = 0; k < TRAIT_COUNT; ++k) row += "," + csv_number(person.traits[k], unit_of_trait(trait_facts()[k].key));
  return row + "\n";
}

std::string contact_grasp_rows(const ContactPlan& plan, const TablePerson& person, std::span<const ContactGrasp> grasps) {
  static const std::string others = empty_cells(FORCE_COLUMNS) + empty_cells(session_columns()) + "\n";
  const std::vector<PlannedGrasp>& planned = plan.grasps();
  std::string rows;
  for (std::size_t k = 0; k < grasps.size(); ++k) {
    const std::size_t at = k % planned.size();
    rows += row_start("contacts", STUDY_POSE_NAMES[k / planned.size()], plan.vessels()[planned[at].vessel].name, "", person, at) +
            contact_cells(grasps[k]) + others;
  }
  return rows;
}

std::string force_grasp_rows(const std::string& vessel, const TablePerson& person, const ForcesOfPerson& forces) {
  static const std::string before = empty_cells(contact_columns()), after = empty_cells(session_columns()) + "\n";
  std::string rows;
  for (std::size_t k = 0; k < forces.size(); ++k)
    rows += row_start("forces", "", vessel, choice_name(PAPER_CHOICES[k]), person, k) + before + force_cells(forces[k]) + after;
  return rows;
}

std::string session_grasp_rows(const Scene& scene, const TablePerson& person, std::span<const device::GraspReport> grasps) {
  static const std::string before = empty_cells(contact_columns()) + empty_cells(FORCE_COLUMNS) + ",";
  std::string rows;
  for (std::size_t k = 0; k < grasps.size(); ++k)
    rows += row_start("sessions", "", scene.vessels[static_cast<std::size_t>(grasps[k].vessel)].name, "", person, k) + before +
            device::grasp_cells(grasps[k]) + "," + csv_number(grasps[k].after_at_first) + "\n";
  return rows;
}

}  // namespace wholehand
