// SPDX-License-Identifier: MIT
// What efforts cost: on the core a state by itself and a grip over its states, and on a device a sweep with and without them. Each
// ratio is of two ways that take turns, so that what else the machine does is the same for both.
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/core_backend.h"
#include "core/evaluator.h"
#include "core/grip_effort.h"
#include "host/grip_backend.h"
#include "sweeps/plan/variables.h"
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
double kernel_seconds(Backend& backend, const Scene& scene, const sweeps::Plan& plan) {
  double seconds = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    RunRequest request = request_of(plan, v);
    request.best = 20;
    seconds += backend.run(request).kernel_seconds;
  }
  return seconds;
}

// Two ways to evaluate all grips of a plan, that of the benchmark and what it is compared with.
struct Way {
  Scene scene;
  bool on_core = false;
};

std::unique_ptr<Backend> backend_of(const Way& way, const Options& options) {
  const FieldSet fields = make_field_set(sweeps::variable_fields(sweeps::choose_variables(way.scene)), way.scene);
  if (way.on_core) return std::make_unique<CoreBackend>(make_core_evaluator(way.scene), way.scene, fields, Precision::full, 0);
  host::GripBackendOptions on_device;
  on_device.precision = Precision::single;
  return std::make_unique<host::GripBackend>(way.scene, make_core_evaluator(way.scene), fields, options.device, on_device);
}

// Seconds in kernels, or of the core's threads, with the planes that a sweep keeps.
void in_turns(benchmark::State& state, const Options& options, const Way& whole, const Way& part, const std::string& label) {
  const sweeps::Plan plan(whole.scene, false);
  const auto with = backend_of(whole, options), without = backend_of(part, options);
  state.counters["hash"] = hash_all(*with, whole.scene, plan);  // warms the device's compiler as well
  hash_all(*without, part.scene, plan);
  double whole_seconds = 0, part_seconds = 0;
  for (auto _ : state) {
    const double seconds = kernel_seconds(*with, whole.scene, plan);
    whole_seconds += seconds;
    part_seconds += kernel_seconds(*without, part.scene, plan);
    state.SetIterationTime(seconds);
  }
  const double grips = static_cast<double>(state.iterations()) * static_cast<double>(plan.grips() * whole.scene.vessels.size());
  state.SetItemsProcessed(static_cast<std::int64_t>(grips));
  state.counters["ratio"] = whole_seconds / part_seconds;
  state.SetLabel(label);
}

Scene without(Scene scene, bool strength, bool table, bool between) {
  if (!strength) scene.strength.reset();
  if (!table) scene.table.reset();
  if (!between) scene.hand.between = 0;
  return scene;
}

}  // namespace

void add_effort_benchmarks(const Options& options) {
  benchmark::RegisterBenchmark("effort_cold", effort_cold)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("effort_grip", effort_grip)->UseManualTime()->Unit(benchmark::kMicrosecond);
  const auto add = [&options](const char* name, const std::function<Way(const Scene&)>& whole,
                              const std::function<Way(const Scene&)>& part, const char* label) {
    const auto run = [&options, whole, part, label](benchmark::State& state) {
      const Scene scene = whole_scene(EFFORT_HEIGHTS);
      if (!scene.strength || !scene.table || scene.hand.between == 0) {
        state.SkipWithError("the default scene has no [strength], no [table] or no spheres between the joints");
        return;
      }
      in_turns(state, options, whole(scene), part(scene), label);
    };
    benchmark::RegisterBenchmark(name, run)->UseManualTime()->Unit(benchmark::kMillisecond);
  };
  const auto all = [](const Scene& scene) { return Way{scene}; };
  add(
      "sweep_over_no_strength", all, [](const Scene& scene) { return Way{without(scene, false, true, true)}; },
      "over the scene without [strength]");
  add(
      "sweep_over_no_table", all, [](const Scene& scene) { return Way{without(scene, true, false, true)}; },
      "over the scene without [table]");
  add(
      "sweep_over_neither", all, [](const Scene& scene) { return Way{without(scene, false, false, true)}; },
      "over the scene without [strength] and [table]");
  add(
      "sweep_over_core", all,
      [](const Scene& scene) {
        return Way{scene, true};
      },
      "over the core on all threads, in double");
  // spheres change what the hand touches and so its efforts, which are left out on both sides
  const auto grips_alone = [](const Scene& scene, bool bones) {
    Scene other = without(scene, false, true, bones);
    other.liquid.reset();
    other.tilts.clear();
    return other;
  };
  for (const bool on_core : {false, true})
    add(
        on_core ? "core_bodies" : "device_bodies",
        [=](const Scene& scene) {
          return Way{grips_alone(scene, true), on_core};
        },
        [=](const Scene& scene) {
          return Way{grips_alone(scene, false), on_core};
        },
        "2 spheres on each bone over none, of grips alone: no tilts, liquid or efforts");
}

}  // namespace wholehand::bench
