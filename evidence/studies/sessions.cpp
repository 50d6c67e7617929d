// SPDX-License-Identifier: MIT
#include "evidence/studies/sessions.h"

#include <array>
#include <cstddef>

#include "core/people/participant.h"
#include "device/recordings/grasp_collector.h"
#include "evidence/studies/simulated_session.h"

namespace wholehand {
namespace {

constexpr std::uint64_t GRASPS_OF_SESSION = 1000;  // numbers of a session's grasps, so that the next one has others

constexpr std::array<double device::GraspReport::*, 16> GRASP_REALS{
    &device::GraspReport::after_at_first, &device::GraspReport::spilled,
    &device::GraspReport::start,          &device::GraspReport::end,
    &device::GraspReport::response_time,  &device::GraspReport::tightened,
    &device::GraspReport::largest_tilt,   &device::GraspReport::tilt_start,
    &device::GraspReport::tilt_time,      &device::GraspReport::normal_increase,
    &device::GraspReport::grip_change,    &device::GraspReport::turning_back,
    &device::GraspReport::saturated,      &device::GraspReport::guidance_distance,
    &device::GraspReport::poured,         &device::GraspReport::arrived};
constexpr std::array<device::MeanDeviation device::GraspReport::*, 3> GRASP_MEANS{
    &device::GraspReport::before, &device::GraspReport::during, &device::GraspReport::after};
constexpr std::array<double device::SlipReport::*, 5> SLIP_REALS{&device::SlipReport::slips, &device::SlipReport::distance,
                                                                 &device::SlipReport::turned, &device::SlipReport::below_hold,
                                                                 &device::SlipReport::least_margin};

}  // namespace

PersonSessions sessions_of_person(const Scene& scene, std::uint64_t seed, std::uint64_t person, const std::atomic<bool>& stop) {
  Scene own = scene;
  own.hand = Participant(scene.people, seed, person, Experiment::sessions).hand(scene.hand);
  PersonSessions all;
  const std::vector<device::SimJob> jobs = jobs_of(own);
  if (jobs.empty()) return all;
  for (std::uint64_t session = 0; session < SESSIONS_PER_PERSON && !stop; ++session) {
    const Participant participant(scene.people, seed, person, Experiment::sessions, session * GRASPS_OF_SESSION);
    device::GraspCollector collector(own.live.rate, own.force.max);
    const bool is_whole = run_simulated(
        {own, participant, tremor_seed(scene, seed, person, session), jobs},
        [&collector](const device::Tick& tick, const device::Session&) {
          collector.add(tick);
          return true;
        },
        stop);
    const std::vector<device::GraspReport> found = collector.finish();
    all.grasps.insert(all.grasps.end(), found.begin(), found.end());
    all.broken += is_whole ? 0 : 1;
  }
  return all;
}

std::vector<double> to_numbers(const PersonSessions& sessions) {
  std::vector<double> numbers{static_cast<double>(sessions.broken)};
  for (const device::GraspReport& grasp : sessions.grasps) {
    for (const auto member : GRASP_REALS) numbers.push_back(grasp.*member);
    for (const auto member : SLIP_REALS) numbers.push_back(grasp.slip.*member);
    numbers.insert(numbers.end(), grasp.duration.begin(), grasp.duration.end());
    for (const auto member : GRASP_MEANS) {
      const device::MeanDeviation& one = grasp.*member;
      numbers.insert(numbers.end(), {one.mean, one.deviation, static_cast<double>(one.count)});
    }
    numbers.insert(numbers.end(),
                   {static_cast<double>(grasp.vessel), static_cast<double>(grasp.course), static_cast<double>(grasp.outcome)});
  }
  return numbers;
}

PersonSessions sessions_from_numbers(const std::vector<double>& numbers) {
  PersonSessions sessions;
  if (numbers.empty()) return sessions;
  constexpr std::size_t EACH = GRASP_REALS.size() + SLIP_REALS.size() + 3 + 3 * GRASP_MEANS.size() + 3;
  sessions.broken = static_cast<int>(numbers[0]);
  sessions.grasps.resize((numbers.size() - 1) / EACH);
  std::size_t at = 1;
  for (device::GraspReport& grasp : sessions.grasps) {
    for (const auto member : GRASP_REALS) grasp.*member = numbers[at++];
    for (const auto member : SLIP_REALS) grasp.slip.*member = numbers[at++];
    for (double& duration : grasp.duration) duration = numbers[at++];
    for (const auto member : GRASP_MEANS) {
      device::MeanDeviation& one = grasp.*member;
      one.mean = numbers[at++];
      one.deviation = numbers[at++];
      one.count = static_cast<std::size_t>(numbers[at++]);
    }
    grasp.vessel = static_cast<int>(numbers[at++]);
    grasp.course = static_cast<device::GripCourse>(static_cast<int>(numbers[at++]));
    grasp.outcome = static_cast<device::GraspOutcome>(static_cast<int>(numbers[at++]));
  }
  return sessions;
}

}  // namespace wholehand
