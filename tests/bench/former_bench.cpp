// SPDX-License-Identifier: MIT
// The kernels of grips and forces against those of commit 289a04a, which tests/bench/former keeps: the same grips, without efforts, table and
// spheres between the joints, in turns. `ratio` is of processor seconds, as other work on the machine changes the wall's; that of others is
// the program's own work on both sides.
#include <cmath>
#include <memory>

#include "core/evaluator.h"
#include "host/grip_backend.h"
#include "tests/bench/bench.h"
#include "tests/bench/cost.h"
#include "tests/bench/shaders.h"

namespace wholehand::bench {
namespace {

constexpr int HEIGHTS = 640;  // as in grip_bench.cpp

Scene as_it_was(Scene scene) {
  scene.strength.reset();
  scene.table.reset();
  scene.hand.between = 0;
  return scene;
}

std::unique_ptr<Backend> backend_of(const Scene& scene, const Options& options, std::span<const EmbeddedShader> shaders) {
  host::GripBackendOptions on_device;
  on_device.precision = Precision::single;
  on_device.shaders = shaders;
  return std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), make_field_set(KEPT, scene), options.device,
                                             on_device);
}

void over_former(benchmark::State& state, const Options& options, const Scene& scene) {
  const Plan plan(scene, false);
  const auto now = backend_of(scene, options, {}), former = backend_of(scene, options, former_shaders());
  const double hash = hash_all(*now, scene, plan);  // warms the device's compiler as well
  if (hash_all(*former, scene, plan) != hash) {
    state.SkipWithError("the former shaders find other contacts");
    return;
  }
  double now_seconds = 0, former_seconds = 0, grips = 0;
  for (auto _ : state) {
    const double seconds = cost_of([&] { grips += static_cast<double>(run_all(*now, scene, plan)); }).processor;
    now_seconds += seconds;
    state.SetIterationTime(seconds);
    former_seconds += cost_of([&] { run_all(*former, scene, plan); }).processor;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(grips));
  state.counters["hash"] = hash;
  state.counters["ratio"] = former_seconds / now_seconds;
  state.SetLabel("processor seconds of the former shaders over it");
}

}  // namespace

void add_former_benchmarks(const Options& options) {
  const auto add = [&options](const char* name, Scene (*make)(int)) {
    benchmark::RegisterBenchmark(
        name, [&options, make](benchmark::State& state) { over_former(state, options, as_it_was(make(HEIGHTS))); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("former_vulkan_float", grips_scene);
  add("former_whole_vulkan_float", whole_scene);
}

}  // namespace wholehand::bench
