// SPDX-License-Identifier: MIT
// The kernels of grips and forces against those of commit 289a04a, which tests/bench/former keeps: the same grips, without efforts, table and
// spheres between the joints, in turns. `ratio` is of processor seconds, as other work on the machine changes the wall's; that of others is
// the program's own work on both sides. `differ`: grips whose status or masks differ.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "host/grip_backend.h"
#include "scene/reader.h"
#include "scene/shipped.h"
#include "tests/bench/bench.h"
#include "tests/bench/cost.h"
#include "tests/bench/shaders.h"

namespace wholehand::bench {
namespace {

constexpr int HEIGHTS = 640;             // as in grip_bench.cpp
constexpr double MOST_DIFFERING = 1e-3;  // share of grips whose outcomes may change within rounding: that of `check`

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
  if (!shaders.empty()) on_device.forces_together = 1;  // the former shaders know no other
  return std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), make_field_set(KEPT, scene), options.device,
                                             on_device);
}

// Status and masks of all grips of a plan, in one list.
std::vector<std::uint32_t> outcomes_of(Backend& backend, const Scene& scene, const Plan& plan) {
  const auto words = static_cast<std::size_t>(backend.fields().uint_kept);
  std::vector<std::uint32_t> outcomes(scene.vessels.size() * plan.grips() * words);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    RunRequest request = request_of(plan, v);
    request.sink = [&](const PlaneChunk& chunk) {
      for (std::size_t i = 0; i < chunk.count; ++i)
        for (std::size_t p = 0; p < words; ++p)
          outcomes[(v * plan.grips() + chunk.first + i) * words + p] = chunk.uint(static_cast<int>(p), i);
    };
    backend.run(request);
  }
  return outcomes;
}

// How many grips have another status or other masks in one than in the other.
double differing(Backend& one, Backend& other, const Scene& scene, const Plan& plan) {
  const std::vector<std::uint32_t> first = outcomes_of(one, scene, plan), second = outcomes_of(other, scene, plan);
  const auto words = static_cast<std::ptrdiff_t>(one.fields().uint_kept);
  double count = 0;
  for (auto a = first.begin(), b = second.begin(); a != first.end(); a += words, b += words)
    if (!std::equal(a, a + words, b)) ++count;
  return count;
}

void over_former(benchmark::State& state, const Options& options, const Scene& scene) {
  const Plan plan(scene, false);
  const auto now = backend_of(scene, options, {}), former = backend_of(scene, options, former_shaders());
  const double differ = differing(*now, *former, scene, plan);  // warms the device's compiler as well
  if (differ > MOST_DIFFERING * static_cast<double>(plan.grips() * scene.vessels.size())) {
    state.SkipWithError("more than one grip in a thousand has another status or other masks");
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
  state.counters["differ"] = differ;
  state.counters["hash"] = hash_all(*now, scene, plan);
  state.counters["ratio"] = former_seconds / now_seconds;
  state.SetLabel("processor seconds of the former shaders over it");
}

// All shipped scenes and the extreme ones, each with its own grips and as many more heights as a million grips in all take. Outcomes may differ
// where they change within rounding, which `check` allows for one grip in a thousand.
void same_outcomes(benchmark::State& state, const Options& options) {
  std::vector<std::string> files = extreme_scene_files();
  for (const std::string& name : shipped_scenes()) files.push_back(find_scene(name));
  const double each = 1e6 / static_cast<double>(files.size());
  for (auto _ : state) {
    double grips = 0, differ = 0;
    for (const std::string& file : files) {
      Scene scene = as_it_was(read_scene_file(file));
      const double own = static_cast<double>(Plan(scene, false).grips() * scene.vessels.size());
      std::vector<double>& heights = scene.grips.height.values;
      const auto more = static_cast<std::size_t>(std::ceil(each / own * static_cast<double>(heights.size())));
      if (heights.size() > 1 && more > heights.size()) {
        const double low = heights.front(), high = heights.back();
        heights.clear();
        for (std::size_t k = 0; k < more; ++k)
          heights.push_back(low + (high - low) * static_cast<double>(k) / static_cast<double>(more - 1));
      }
      const Plan plan(scene, false);
      const auto now = backend_of(scene, options, {}), former = backend_of(scene, options, former_shaders());
      grips += static_cast<double>(plan.grips() * scene.vessels.size());
      const double here = differing(*now, *former, scene, plan);
      if (here > 0) std::fprintf(stderr, "%s: %.0f of %zu\n", file.c_str(), here, plan.grips() * scene.vessels.size());
      differ += here;
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(grips));
    state.counters["grips"] = grips;
    state.counters["differ"] = differ;
    if (differ > MOST_DIFFERING * grips) state.SkipWithError("more than one grip in a thousand has another status or other masks");
  }
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
  benchmark::RegisterBenchmark("outcomes_of_former", [&options](benchmark::State& state) { same_outcomes(state, options); })
      ->Iterations(1)
      ->Unit(benchmark::kSecond);
}

}  // namespace wholehand::bench
