// SPDX-License-Identifier: MIT
// Rows of grasps.csv and people.csv, from which a study's statistics can be computed again. docs/study.md has each column.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/people_data.h"
#include "core/scene.h"
#include "device/recordings/grasp_measure.h"
#include "evidence/studies/contact_plan.h"
#include "evidence/studies/force_statistics.h"

namespace wholehand {

// The columns, as a line.
std::string grasps_csv_head();
std::string people_csv_head();

// Person `number` of a population, as in both tables.
struct TablePerson {
  std::uint64_t number = 0;
  std::string cells = ",,";  // sex, length and breadth of the hand; empty: not known
};
TablePerson table_person(const PeopleData& people, std::uint64_t seed, std::uint64_t number);
std::string person_row(const PeopleData& people, std::uint64_t seed, std::uint64_t number);

// Rows of one person's grasps. `grasps` of contacts: of ContactPlan::of_person.
std::string contact_grasp_rows(const ContactPlan& plan, const TablePerson& person, std::span<const ContactGrasp> grasps);
std::string force_grasp_rows(const std::string& vessel, const TablePerson& person, const ForcesOfPerson& forces);
std::string session_grasp_rows(const Scene& scene, const TablePerson& person, std::span<const device::GraspReport> grasps);

}  // namespace wholehand
