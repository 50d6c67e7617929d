// SPDX-License-Identifier: MIT
#include "sweeps/cost_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "core/planes.h"
#include "shaders/layout.h"
#include "sweeps/variables.h"

namespace wholehand {
namespace {

constexpr std::size_t MOST_RUNS = 400;  // in all, so that the file stays small
constexpr std::uint64_t FEW_GRIPS = 8;  // a run of fewer than the sweep's by this factor is short

// Measured with 155 states and two spheres on each bone on the machine of docs/results (two cores at 2.6 GHz): what does not grow, what a CPU
// driver's first run compiles, both in seconds, and a grip, in seconds of one thread.
struct Guess {
  double fixed, compiling, grip;
};
constexpr Guess CORE{0.1, 0, 15e-6}, CORE_WITH_EFFORTS{0.2, 0, 61e-6};
constexpr Guess CPU_DRIVER{0.3, 5.4, 4e-6}, CPU_DRIVER_WITH_EFFORTS{0.7, 7.5, 33e-6};
constexpr Guess GPU{0.7, 0, 0.3e-6}, GPU_WITH_EFFORTS{0.7, 0, 1.2e-6};  // not measured: a fiftieth of one thread

CostEstimate guessed(const Guess& guess, int threads, bool compiles) {
  CostEstimate made;
  made.fixed = guess.fixed + (compiles ? guess.compiling : 0);
  made.per_grip = guess.grip / std::max(1, threads);
  return made;
}

bool is_of(const RunTime& run, const std::string& machine, const std::string& kind) {
  return run.machine == machine && run.kind == kind;
}

bool is_on_core(const RunTime& run) { return run.device == "core"; }

bool is_same_place(const RunTime& a, const RunTime& b) { return is_of(a, b.machine, b.kind) && is_on_core(a) == is_on_core(b); }

// A device's first run compiles what later ones find in the driver's cache, so one run of it says little.
bool is_sure(const CostEstimate& cost, bool is_device) { return cost.runs >= (is_device ? 2 : 1); }

// While a device's estimate is not sure, its fixed part is no reason against a try: it may be compilation.
bool is_due(const CostEstimate& cost, double other_seconds, const SweepTask& task, bool is_device) {
  if (cost.age < RUNS_TO_OLD) return false;
  if (is_sure(cost, is_device)) return cost.seconds(task.grips) <= WORTH_A_TRY * other_seconds;
  const double fixed = is_device ? 0 : cost.fixed;
  return fixed + cost.per_grip * static_cast<double>(task.grips) <= 2 * WORTH_A_TRY * other_seconds;
}

bool is_short(const RunTime& run, const SweepTask& task) { return run.grips < task.grips / FEW_GRIPS; }

// A short run's time per grip is largely latency, and compilation on a device. It may lower the guess; any excess counts as fixed.
CostEstimate cost_of(const RunTime& run, const SweepTask& task, double guess_per_grip) {
  const auto grips = static_cast<double>(run.grips);
  CostEstimate cost;
  cost.per_grip = run.growing / grips;
  if (is_short(run, task)) cost.per_grip = std::min(cost.per_grip, guess_per_grip);
  cost.fixed = run.fixed + std::max(0.0, run.growing - cost.per_grip * grips);
  cost.device = run.device;
  return cost;
}

std::string time_text(const CostEstimate& cost, const SweepTask& task) {
  const double seconds = cost.seconds(task.grips);
  return fmt::format("{:.{}f} s", seconds, seconds < 10 ? 1 : 0);
}

std::string name_of(const CostEstimate& device) { return device.device.empty() ? "a device" : device.device; }

}  // namespace

SweepTask sweep_task(const Scene& scene, std::uint64_t grips, int threads, const std::string& precision) {
  SweepTask task;
  task.grips = grips;
  task.has_efforts = has_effort(scene);
  for (const Variable* variable : choose_variables(scene))
    task.has_reserves |=
        variable->field == FIELD_TIPS_WORST_EFFORT || variable->field == FIELD_PUSH || variable->field == FIELD_FRICTION_NEEDED;
  task.has_mesh = std::any_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& v) { return v.mesh.has_value(); });
  task.is_robust = scene.robust.has_value();
  task.between = scene.hand.between;
  task.states = scene_fills(scene) * scene.tilts.size();
  task.threads = threads;
  task.precision = precision;
  return task;
}

std::string kind_of(const SweepTask& task) {
  return fmt::format("{}, {}, {}{} between, 2^{} states, {} threads, {}",
                     task.has_reserves  ? "all efforts"
                     : task.has_efforts ? "efforts"
                                        : "no efforts",
                     task.has_mesh ? "mesh" : "outlines", task.is_robust ? "robust, " : "", task.between,
                     std::bit_width(task.states), task.threads, task.precision.empty() ? "usual precision" : task.precision);
}

CostEstimate estimate(std::span<const RunTime> history, const std::string& machine, const SweepTask& task, bool on_core,
                      const CostEstimate& guess) {
  CostEstimate best = guess;
  const std::string kind = kind_of(task);
  std::uint64_t last = 0, last_here = 0;
  bool best_is_short = false;
  for (auto run = history.rbegin(); run != history.rend(); ++run) {
    if (!is_of(*run, machine, kind)) continue;
    last = std::max(last, run->number);
    if (is_on_core(*run) != on_core || best.runs >= COUNTED_RUNS) continue;
    last_here = std::max(last_here, run->number);
    const CostEstimate one = cost_of(*run, task, guess.per_grip);
    const int runs = best.runs + 1;
    const bool as_short = is_short(*run, task) == best_is_short, is_less = one.seconds(task.grips) < best.seconds(task.grips);
    if (best.runs == 0 || (as_short ? is_less : best_is_short)) {
      best = one;
      best_is_short = is_short(*run, task);
    }
    best.runs = runs;
  }
  best.age = last - last_here;
  return best;
}

CostEstimate guess_core(const SweepTask& task) { return guessed(task.has_efforts ? CORE_WITH_EFFORTS : CORE, task.threads, false); }

CostEstimate guess_device(const SweepTask& task, bool is_cpu) {
  if (is_cpu) return guessed(task.has_efforts ? CPU_DRIVER_WITH_EFFORTS : CPU_DRIVER, task.threads, true);
  return guessed(task.has_efforts ? GPU_WITH_EFFORTS : GPU, 1, false);
}

void scale_guess(const SweepTask& task, CostEstimate& core, CostEstimate& device) {
  if ((core.runs == 0) == (device.runs == 0)) return;
  CostEstimate& guess = core.runs == 0 ? core : device;
  const CostEstimate& known = core.runs == 0 ? device : core;
  // the best of a device's runs has not compiled
  const CostEstimate usual = guessed(task.has_efforts ? CPU_DRIVER_WITH_EFFORTS : CPU_DRIVER, task.threads, false);
  const double expected = (core.runs == 0 ? usual : guess_core(task)).seconds(task.grips);
  const double factor = std::max(1.0, known.seconds(task.grips) / expected);
  guess.fixed *= factor;
  guess.per_grip *= factor;
}

BackendChoice choose_backend(const SweepTask& task, const CostEstimate& core, const CostEstimate& device) {
  const double on_core = core.seconds(task.grips), on_device = device.seconds(task.grips);
  const bool device_is_sooner = on_device < on_core;
  if (device_is_sooner && is_due(core, on_device, task, false)) return {false, true};
  if (!device_is_sooner && on_core > QUICK_CORE && is_due(device, on_core, task, true)) return {true, true};
  return {device_is_sooner, false};
}

std::string choice_line(const SweepTask& task, const BackendChoice& choice, const CostEstimate& core, const CostEstimate& device) {
  const CostEstimate& taken = choice.on_device ? device : core;
  const CostEstimate& other = choice.on_device ? core : device;
  const std::string here = choice.on_device ? name_of(device) : "core", there = choice.on_device ? "core" : name_of(device);
  const auto guess = [](const CostEstimate& cost) { return cost.runs == 0 ? " (first guess)" : ""; };
  return fmt::format("chosen: {}, {} expected{}, and {}{} on {}{}", here, time_text(taken, task), guess(taken),
                     time_text(other, task), guess(other), there, choice.is_trial ? "; taken to learn what it takes now" : "");
}

void add_run(std::vector<RunTime>& history, RunTime run) {
  std::uint64_t last = 0;
  for (const RunTime& one : history)
    if (is_of(one, run.machine, run.kind)) last = std::max(last, one.number);
  run.number = last + 1;
  std::erase_if(history, [&](const RunTime& one) { return is_same_place(one, run) && one.device != run.device; });
  const auto here = std::count_if(history.begin(), history.end(), [&](const RunTime& one) { return is_same_place(one, run); });
  if (here >= COUNTED_RUNS)
    history.erase(std::find_if(history.begin(), history.end(), [&](const RunTime& one) { return is_same_place(one, run); }));
  history.push_back(std::move(run));
  if (history.size() > MOST_RUNS) history.erase(history.begin());
}

}  // namespace wholehand
