// SPDX-License-Identifier: MIT
#include "evidence/studies/person_answers.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/statistics/given_data_indices.h"
#include "core/people/person.h"
#include "evidence/studies/grasp_numbers.h"
#include "evidence/studies/sensitivity.h"

namespace wholehand {
namespace {

// Means over a person's grasps, by name.
const std::vector<std::pair<std::string, of_grasp::Number>> SESSION_ANSWERS{
    {"response_time", of_grasp::response_time},     {"grip_stopped", of_grasp::grip_stopped},
    {"grip_before", of_grasp::grip_before},         {"grip_after", of_grasp::grip_after},
    {"normal_increase", of_grasp::normal_increase}, {"grip_change", of_grasp::grip_change},
    {"rising_share", of_grasp::is_rising},          {"lost_share", of_grasp::is_lost}};
const std::vector<std::string> FORCE_ANSWERS{"losses", "largest_opening"};

std::vector<double> session_answers(const SessionSubject& person, const SessionVessels& vessels) {
  std::vector<device::MeanSum> sums(SESSION_ANSWERS.size());
  for (const device::GraspReport& grasp : person.grasps) {
    const bool counts = std::any_of(vessels.begin(), vessels.end(), [&grasp](const SessionVessel& vessel) {
      return static_cast<int>(vessel.place) == grasp.vessel;
    });
    if (!counts) continue;
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k].add(SESSION_ANSWERS[k].second(grasp));
  }
  std::vector<double> answers;
  for (const device::MeanSum& sum : sums) answers.push_back(sum.result().mean);
  return answers;
}

std::vector<double> force_answers(const ForcesOfPerson& person) {
  device::MeanSum losses, opening;
  for (const ForceOutcome& one : person) {
    if (!one.has_gripped) continue;
    losses.add(one.losses);
    opening.add(one.opening);
  }
  return {losses.result().mean, opening.result().mean};
}

template <class People, class Answers>
std::vector<StudyRow> rows_of(const char* experiment, const People& people, std::uint64_t seed,
                              const std::vector<std::string>& names, const Answers& answers) {
  GivenDataIndices indices(person_input_names().size(), names.size());
  std::uint64_t number = 0;
  for (const auto& person : people) indices.add(person_inputs(draw_shares(seed, number++)), answers(person));
  return sensitivity_rows(experiment, names, person_input_names(), indices);
}

}  // namespace

std::vector<StudyRow> session_sensitivity(std::span<const SessionSubject> people, const SessionVessels& vessels,
                                          std::uint64_t seed) {
  std::vector<std::string> names;
  for (const auto& [name, number] : SESSION_ANSWERS) names.push_back(name);
  return rows_of("sessions", people, seed, names,
                 [&vessels](const SessionSubject& person) { return session_answers(person, vessels); });
}

std::vector<StudyRow> force_sensitivity(std::span<const ForcesOfPerson> people, std::uint64_t seed) {
  return rows_of("forces", people, seed, FORCE_ANSWERS, force_answers);
}

}  // namespace wholehand
