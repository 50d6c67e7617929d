// SPDX-License-Identifier: MIT
// What efforts cost: on the core a state by itself and a grip over its states, and on a device a sweep with and without them. Each
// ratio is of two ways that take turns, so that what else the machine does is the same for both.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/grip_effort.h"
#include "host/grip_backend.h"
#include "sweeps/variables.h"
#include "tests/bench/bench.h"
#include "tests/support/loaded_grip.h"

namespace wholehand::bench {
namespace {

constexpr std::size_t LOADED_GRIPS = 60;  // of three vessels, in turns
constexpr int EFFORT_HEIGHTS = 64;        // the default scene's own

double seconds_since_start(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

core_f64::Effort cold_effort(const LoadedGrip& grip, std::size_t fill, std::size_t tilt) {
  core_f64::EffortSolver solver(grip.contacts, grip.hand, core_f64::contacts_center(grip.contacts));
  return solver.solve(grip.loads().weight(fill, tilt));
}

// One solve from nothing, of a state of each grip in turn.
void effort_cold(benchmark::State& state) {
  const auto grips = random_loaded_grips(LOADED_GRIPS, Handedness::right, 1);
  std::size_t k = 0;
  double pivots = 0;
  for (auto _ : state) {
    const LoadedGrip& grip = grips[k % grips.size()];
    const std::size_t fill = k % grip.fills(), tilt = k * 7 % grip.counted[fill];
    const core_f64::Effort found = cold_effort(grip, fill, tilt);
    benchmark::DoNotOptimize(found.effort);
    pivots += found.pivots;
    ++k;
  }
  state.counters["pivots"] = pivots / static_cast<double>(state.iterations());
}

// The worst effort of a whole hand over the states of a grip; beside it, each of these states solved from nothing.
void effort_grip(benchmark::State& state) {
  const auto grips = random_loaded_grips(LOADED_GRIPS, Handedness::right, 1);
  std::size_t k = 0;
  double ours = 0, cold = 0, pivots = 0;
  std::vector<core_f64::FillEffort> fills;
  for (auto _ : state) {
    const LoadedGrip& grip = grips[k++ % grips.size()];
    fills.resize(grip.fills());
    auto start = std::chrono::steady_clock::now();
    const core_f64::GripEffort found = core_f64::grip_effort(grip.contacts, std::nullopt, grip.hand, grip.loads(), fills);
    benchmark::DoNotOptimize(found.worst);
    const double seconds = seconds_since_start(start);
    ours += seconds;
    pivots += found.pivots;
    state.SetIterationTime(seconds);
    start = std::chrono::steady_clock::now();
    for (std::size_t fill = 0; fill < grip.fills(); ++fill)
      for (std::size_t tilt = 0; tilt < grip.counted[fill]; ++tilt) benchmark::DoNotOptimize(cold_effort(grip, fill, tilt).effort);
    cold += seconds_since_start(start);
  }
  state.counters["pivots"] = pivots / static_cast<double>(state.iterations());
  state.counters["ratio"] = cold / ours;
  state.SetLabel("each state from nothing over it");
}

// Seconds in kernels of all grips of a plan.
double kernel_seconds(Backend& backend, const Scene& scene, const Plan& plan) {
  double seconds = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    RunRequest request;
    request.vessel = v;
    request.last = plan.grips();
    request.best = 20;
    request.grips = [&plan](std::size_t w, std::uint64_t first, std::size_t count, GripInput* out) {
      plan.fill(w, first, count, out);
    };
    seconds += backend.run(request).kernel_seconds;
  }
  return seconds;
}

// A device's kernels on the default scene, with the planes that a sweep keeps; beside it the same scene without a part of it.
void sweep_without(benchmark::State& state, const Options& options, bool strength, bool table) {
  const Scene whole = whole_scene(EFFORT_HEIGHTS);
  Scene part = whole;
  if (!whole.strength || !whole.table) {
    state.SkipWithError("the default scene has no [strength] or no [table]");
    return;
  }
  if (!strength) part.strength.reset();
  if (!table) part.table.reset();
  const Plan plan(whole, false);
  const auto backend_of = [&](const Scene& scene) {
    host::GripBackendOptions on_device;
    on_device.precision = Precision::single;
    const FieldSet fields = make_field_set(variable_fields(choose_variables(scene)), scene);
    return std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), fields, options.device, on_device);
  };
  const auto with = backend_of(whole), without = backend_of(part);
  state.counters["hash"] = hash_all(*with, whole, plan);  // warms the device's compiler as well
  hash_all(*without, part, plan);
  double whole_seconds = 0, part_seconds = 0;
  for (auto _ : state) {
    const double seconds = kernel_seconds(*with, whole, plan);
    whole_seconds += seconds;
    part_seconds += kernel_seconds(*without, part, plan);
    state.SetIterationTime(seconds);
  }
  const double grips = static_cast<double>(state.iterations()) * static_cast<double>(plan.grips() * whole.vessels.size());
  state.SetItemsProcessed(static_cast<std::int64_t>(grips));
  state.counters["ratio"] = whole_seconds / part_seconds;
  state.SetLabel(std::string("over the scene without ") + (strength ? "[table]" : table ? "[strength]" : "[strength] and [table]"));
}

}  // namespace

void add_effort_benchmarks(const Options& options) {
  benchmark::RegisterBenchmark("effort_cold", effort_cold)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("effort_grip", effort_grip)->UseManualTime()->Unit(benchmark::kMicrosecond);
  const auto add_sweep = [&options](const char* name, bool strength, bool table) {
    benchmark::RegisterBenchmark(
        name, [&options, strength, table](benchmark::State& state) { sweep_without(state, options, strength, table); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  add_sweep("sweep_over_no_strength", false, true);
  add_sweep("sweep_over_no_table", true, false);
  add_sweep("sweep_over_neither", false, false);
}

}  // namespace wholehand::bench
