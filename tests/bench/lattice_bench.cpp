// SPDX-License-Identifier: MIT
// Grips on a lattice of distances, as a mesh becomes one: the core on all threads and a device, in turns in one run, so that what
// else the machine does is the same for both.
#include <fmt/format.h>

#include <chrono>

#include "core/core_backend.h"
#include "core/evaluator.h"
#include "host/grip_backend.h"
#include "tests/bench/bench.h"

namespace wholehand::bench {
namespace {

constexpr int HEIGHTS = 128;  // 55,296 grips of three vessels: a run of the device's is long beside its waits
// Along the longest side of each vessel. The mesh reader, asked for 0.25 mm at the surface, chooses 172, 167 and 207 for the three
// beakers tessellated (0.77, 0.98 and 0.81 mm): the finest of them.
constexpr int READER_SAMPLES = 207;

double seconds_of(Backend& backend, const Scene& scene, const sweeps::Plan& plan) {
  const auto start = std::chrono::steady_clock::now();
  run_all(backend, scene, plan);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// `samples` along the longest side of each vessel.
void lattice_grips(benchmark::State& state, const Options& options, int samples, int bits) {
  const Scene scene = grips_scene(HEIGHTS);
  const sweeps::Plan plan(scene, false);
  host::GripBackendOptions on_device;
  on_device.evaluator.lattice_samples = samples;
  on_device.evaluator.lattice_bits = bits;
  CoreBackend core(make_core_evaluator(scene, on_device.evaluator), scene, make_field_set(KEPT, scene), Precision::full, 0);
  host::GripBackend device(scene, make_core_evaluator(scene, on_device.evaluator), make_field_set(KEPT, scene), options.device,
                           on_device);
  state.counters["hash"] = hash_all(device, scene, plan);  // warms the device's compiler as well
  run_all(core, scene, plan);
  double core_seconds = 0, device_seconds = 0;
  for (auto _ : state) {
    const double seconds = seconds_of(device, scene, plan);
    core_seconds += seconds_of(core, scene, plan);
    device_seconds += seconds;
    state.SetIterationTime(seconds);
  }
  const double grips = static_cast<double>(state.iterations()) * static_cast<double>(plan.grips() * scene.vessels.size());
  state.SetItemsProcessed(static_cast<std::int64_t>(grips));
  state.counters["core_per_s"] = grips / core_seconds;
  state.counters["ratio"] = core_seconds / device_seconds;
  state.SetLabel("over the core on all threads; wanted: 3");
}

}  // namespace

void add_lattice_benchmarks(const Options& options) {
  for (const int samples : {128, READER_SAMPLES})
    for (const int bits : {32, 16})
      benchmark::RegisterBenchmark(
          fmt::format("lattice_{}_{}bit", samples, bits).c_str(),
          [&options, samples, bits](benchmark::State& state) { lattice_grips(state, options, samples, bits); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
}

}  // namespace wholehand::bench
