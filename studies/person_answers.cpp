// SPDX-License-Identifier: MIT
#include "studies/person_answers.h"

#include <algorithm>
#include <limits>
#include <string>

#include "people/person.h"
#include "statistics/given_data_indices.h"
#include "studies/sensitivity.h"

namespace wholehand {
namespace {

const std::vector<std::string> SESSION_ANSWERS{"response_time",   "grip_stopped", "grip_before",  "grip_after",
                                               "normal_increase", "grip_change",  "rising_share", "lost_share"};
const std::vector<std::string> FORCE_ANSWERS{"losses", "largest_opening"};

std::vector<double> session_answers(const SessionSubject& person, const SessionVessels& vessels) {
  MeanSum response, stopped, before, after, increase, change, rising, lost;
  for (const GraspReport& grasp : person.grasps) {
    const bool counts = std::any_of(vessels.begin(), vessels.end(), [&grasp](const SessionVessel& vessel) {
      return static_cast<int>(vessel.place) == grasp.vessel;
    });
    if (!counts) continue;
    response.add(grasp.response_time);
    stopped.add(grasp.tightened);
    if (grasp.largest_tilt >= LEAST_ANALYSED) {
      before.add(grasp.before.mean);
      after.add(grasp.after.mean);
    }
    lost.add(grasp.outcome == GraspOutcome::lost ? 1 : 0);
    if (grasp.course == GripCourse::not_analysed) continue;
    increase.add(grasp.normal_increase);
    change.add(grasp.grip_change);
    rising.add(grasp.grip_change > 0 ? 1 : 0);
  }
  std::vector<double> answers;
  for (const MeanSum* sum : {&response, &stopped, &before, &after, &increase, &change, &rising, &lost})
    answers.push_back(sum->result().mean);
  return answers;
}

std::vector<double> force_answers(const ForcesOfPerson& person) {
  MeanSum losses, opening;
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
  return rows_of("sessions", people, seed, SESSION_ANSWERS,
                 [&vessels](const SessionSubject& person) { return session_answers(person, vessels); });
}

std::vector<StudyRow> force_sensitivity(std::span<const ForcesOfPerson> people, std::uint64_t seed) {
  return rows_of("forces", people, seed, FORCE_ANSWERS, force_answers);
}

}  // namespace wholehand
