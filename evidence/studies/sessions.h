// SPDX-License-Identifier: MIT
// The paper's mixing task (section V-B) by virtual people.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/scene.h"
#include "device/recordings/grasp_measure.h"

namespace wholehand {

// How often each person does the task, so that 17 people have more than the paper's 32 grasps of a vessel.
constexpr std::uint64_t SESSIONS_PER_PERSON = 2;

struct PersonSessions {
  std::vector<device::GraspReport> grasps;  // measured like a recording's; none if the person's hand holds no vessel
  int broken = 0;                           // sessions that did not end by themselves
};

// Ends early if `stop` is set.
PersonSessions sessions_of_person(const Scene& scene, std::uint64_t seed, std::uint64_t person, const std::atomic<bool>& stop);

// As numbers, to the bit, for a journal; without the grips, which no statistic of a study takes.
std::vector<double> to_numbers(const PersonSessions& sessions);
PersonSessions sessions_from_numbers(const std::vector<double>& numbers);

}  // namespace wholehand
