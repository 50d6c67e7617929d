// SPDX-License-Identifier: MIT
#include "evidence/studies/forces.h"

#include "core/people/participant.h"
#include "evidence/studies/simulated_session.h"

namespace wholehand {
namespace {

constexpr std::uint64_t GRASPS_OF_TRIAL = 1000;  // numbers of a trial's grasps, so that the next one has others

}  // namespace

ForcesOfPerson forces_of_person(const Scene& scene, std::size_t vessel, std::uint64_t seed, std::uint64_t person,
                                const std::atomic<bool>& stop) {
  Scene own = force_scene(scene, vessel);
  own.hand = Participant(scene.people, seed, person, Experiment::forces).hand(scene.hand);
  const std::vector<device::SimJob> jobs = jobs_of(own);
  ForcesOfPerson forces{};
  for (std::size_t k = 0; k < FORCE_CHOICES && !stop; ++k) {
    const Participant participant(scene.people, seed, person, Experiment::forces, k * GRASPS_OF_TRIAL);
    forces[k] = try_forces(own, jobs, participant, PAPER_CHOICES[k], tremor_seed(scene, seed, person, k), stop);
  }
  return forces;
}

std::vector<double> to_numbers(const ForcesOfPerson& forces) {
  std::vector<double> numbers;
  for (const ForceOutcome& one : forces)
    numbers.insert(numbers.end(), {one.has_gripped ? 1.0 : 0.0, one.has_succeeded ? 1.0 : 0.0, one.oscillates ? 1.0 : 0.0,
                                   static_cast<double>(one.losses), one.opening});
  return numbers;
}

ForcesOfPerson forces_from_numbers(const std::vector<double>& numbers) {
  ForcesOfPerson forces{};
  if (numbers.size() != 5 * forces.size()) return forces;
  std::size_t at = 0;
  for (ForceOutcome& one : forces) {
    one.has_gripped = numbers[at++] != 0;
    one.has_succeeded = numbers[at++] != 0;
    one.oscillates = numbers[at++] != 0;
    one.losses = static_cast<int>(numbers[at++]);
    one.opening = numbers[at++];
  }
  return forces;
}

}  // namespace wholehand
