// SPDX-License-Identifier: MIT
// One session of a virtual person, as in `wholehand live`, without a clock and without a recording.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/people/participant.h"
#include "core/scene.h"
#include "device/session/session.h"
#include "device/simulated/sim_user.h"

namespace wholehand {

constexpr double LONGEST_SESSION = 600;  // s of simulated time

// The request for a session.
struct SimulatedSession {
  const Scene& scene;  // with the person's own hand
  const Participant& person;
  std::uint64_t seed = 1;            // of the tremor
  std::vector<device::SimJob> jobs;  // of the person, in their order
  double seconds = LONGEST_SESSION;
  device::ShownGripSource* shown = nullptr;  // grips that the person is shown and takes; null: none
};

// Takes each tick, just made by the session; false ends it.
using TickTaker = std::function<bool(const device::Tick&, const device::Session&)>;

// Runs it with the gripper, limits, loop and session of `wholehand live`, until `take` or `stop` ends it. Returns
// false if the session did not end by itself, but by a fault, such as a jump of the hand, or because it took too long. Rethrows what `take` throws.
bool run_simulated(const SimulatedSession& asked, const TickTaker& take, const std::atomic<bool>& stop);

// The seed of the tremor in session `k` of a person. Without scatter everybody is one person, with the same tremor.
std::uint64_t tremor_seed(const Scene& scene, std::uint64_t seed, std::uint64_t person, std::uint64_t k);

// The jobs of the scene's person; none if the scene has nothing for that person to do.
std::vector<device::SimJob> jobs_of(const Scene& scene);

}  // namespace wholehand
