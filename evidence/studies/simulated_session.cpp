// SPDX-License-Identifier: MIT
#include "evidence/studies/simulated_session.h"

#include <exception>
#include <initializer_list>

#include "base/numbers/random_bits.h"
#include "base/text/error.h"
#include "device/loop/haptic_loop.h"
#include "device/simulated/sim_gripper.h"

namespace wholehand {

bool run_simulated(const SimulatedSession& asked, const TickTaker& take, const std::atomic<bool>& stop) {
  if (asked.jobs.empty()) return true;
  const auto gripper = device::open_sim(asked.scene, asked.seed, asked.person, asked.jobs, asked.shown);
  device::Session session(asked.scene, gripper->limits().gap);
  device::LoopOptions options;
  options.is_simulated = true;
  options.seconds = asked.seconds;
  std::exception_ptr error;
  bool is_enough = false;
  // the loop lets nothing through
  const auto sink = [&](const device::Tick& tick) {
    if (is_enough) return false;
    try {
      is_enough = !take(tick, session);
    } catch (...) {
      error = std::current_exception();
      is_enough = true;
    }
    return !is_enough;
  };
  device::HapticLoop loop(asked.scene.live, *gripper, session, sink, options);
  loop.run(stop);
  if (error) std::rethrow_exception(error);
  return is_enough || (loop.report().fault == device::Fault::none && gripper->is_done()) || stop;
}

std::uint64_t tremor_seed(const Scene& scene, std::uint64_t seed, std::uint64_t person, std::uint64_t k) {
  constexpr std::uint64_t TREMOR = 0x7472656d6f72;  // keeps the tremor's numbers from those of people
  std::uint64_t bits = mixed_bits(seed ^ TREMOR);
  for (const std::uint64_t part : {scene.people.scatter > 0 ? person : 0, k}) bits = mixed_bits(bits + SPLIT_MIX_STEP * (part + 1));
  return bits;
}

std::vector<device::SimJob> jobs_of(const Scene& scene) {
  try {
    return device::plan_sim_jobs(scene);
  } catch (const Error& error) {
    if (error.code != ExitCode::usage) throw;
    return {};  // too small a hand, say
  }
}

}  // namespace wholehand
