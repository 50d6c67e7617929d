// SPDX-License-Identifier: MIT
#include "studies/sessions.h"

#include <array>
#include <cstddef>

#include "people/participant.h"
#include "recordings/grasp_collector.h"
#include "studies/simulated_session.h"

namespace wholehand {
namespace {

constexpr std::uint64_t GRASPS_OF_SESSION = 1000;  // numbers of a session's grasps, so that the next one has others

constexpr std::array<double GraspReport::*, 16> GRASP_REALS{&GraspReport::after_at_first, &GraspReport::spilt,
                                                            &GraspReport::start,          &GraspReport::end,
                                                            &GraspReport::response_time,  &GraspReport::tightened,
                                                            &GraspReport::largest_tilt,   &GraspReport::tilt_start,
                                                            &GraspReport::tilt_time,      &GraspReport::normal_increase,
                                                            &GraspReport::grip_change,    &GraspReport::turning_back,
                                                            &GraspReport::saturated,      &GraspReport::guidance_distance,
                                                            &GraspReport::poured,         &GraspReport::arrived};
constexpr std::array<MeanDeviation GraspReport::*, 3> GRASP_MEANS{&GraspReport::before, &GraspReport::during, &GraspReport::after};

}  // namespace

std::vector<GraspReport> sessions_of_person(const Scene& scene, std::uint64_t seed, std::uint64_t person,
                                            const std::atomic<bool>& stop) {
  Scene own = scene;
  own.hand = Participant(scene.people, seed, person, Experiment::sessions).hand(scene.hand);
  std::vector<GraspReport> grasps;
  const std::vector<SimJob> jobs = jobs_of(own);
  if (jobs.empty()) return grasps;
  for (std::uint64_t session = 0; session < SESSIONS_PER_PERSON && !stop; ++session) {
    const Participant participant(scene.people, seed, person, Experiment::sessions, session * GRASPS_OF_SESSION);
    GraspCollector collector(own.live.rate, own.force.max);
    run_simulated(
        {own, participant, tremor_seed(scene, seed, person, session), jobs},
        [&collector](const Tick& tick) {
          collector.add(tick);
          return true;
        },
        stop);
    const std::vector<GraspReport> found = collector.finish();
    grasps.insert(grasps.end(), found.begin(), found.end());
  }
  return grasps;
}

std::vector<double> numbers_of(const std::vector<GraspReport>& grasps) {
  std::vector<double> numbers;
  for (const GraspReport& grasp : grasps) {
    for (const auto member : GRASP_REALS) numbers.push_back(grasp.*member);
    numbers.insert(numbers.end(), grasp.duration.begin(), grasp.duration.end());
    for (const auto member : GRASP_MEANS) {
      const MeanDeviation& one = grasp.*member;
      numbers.insert(numbers.end(), {one.mean, one.deviation, static_cast<double>(one.count)});
    }
    numbers.insert(numbers.end(),
                   {static_cast<double>(grasp.vessel), static_cast<double>(grasp.course), static_cast<double>(grasp.outcome)});
  }
  return numbers;
}

std::vector<GraspReport> grasps_of(const std::vector<double>& numbers) {
  constexpr std::size_t EACH = GRASP_REALS.size() + 3 + 3 * GRASP_MEANS.size() + 3;
  std::vector<GraspReport> grasps(numbers.size() / EACH);
  std::size_t at = 0;
  for (GraspReport& grasp : grasps) {
    for (const auto member : GRASP_REALS) grasp.*member = numbers[at++];
    for (double& duration : grasp.duration) duration = numbers[at++];
    for (const auto member : GRASP_MEANS) {
      MeanDeviation& one = grasp.*member;
      one.mean = numbers[at++];
      one.deviation = numbers[at++];
      one.count = static_cast<std::size_t>(numbers[at++]);
    }
    grasp.vessel = static_cast<int>(numbers[at++]);
    grasp.course = static_cast<GripCourse>(static_cast<int>(numbers[at++]));
    grasp.outcome = static_cast<GraspOutcome>(static_cast<int>(numbers[at++]));
  }
  return grasps;
}

}  // namespace wholehand
