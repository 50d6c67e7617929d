// SPDX-License-Identifier: MIT
// How fast grips are scored, on the core and on Vulkan.
#include <fmt/format.h>

#include <memory>

#include "core/core_backend.h"
#include "core/evaluator.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "host/grip_backend.h"
#include "sweeps/grips/holding.h"
#include "sweeps/grips/methods.h"
#include "sweeps/grips/report.h"
#include "tests/bench/bench.h"
#include "tests/support/scenes.h"

namespace wholehand::bench {

const std::vector<int> KEPT{FIELD_SCORE,         FIELD_TERMS,       FIELD_GAP,        FIELD_CLOSURE,
                            FIELD_PHALANX_DEPTH, FIELD_PALM_DEPTH,  FIELD_STATUS,     FIELD_TOUCH_MASK,
                            FIELD_TIP_MASK,      FIELD_FINGER_MASK, FIELD_INNER_MASK, FIELD_USED_MASK};

Scene whole_scene(int heights) {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  std::vector<double>& values = scene.grips.height.values;
  const double low = values.front(), high = values.back();
  values.clear();
  for (int k = 0; k < heights; ++k) values.push_back(low + (high - low) * k / (heights - 1));
  scene.grips.obliquity = three_beakers().grips.obliquity;
  scene.grips.roll = three_beakers().grips.roll;
  return scene;
}

Scene grips_scene(int heights) {
  Scene scene = whole_scene(heights);
  scene.liquid.reset();
  scene.tilts.clear();
  return scene;
}

std::unique_ptr<Evaluator> core_of(const Scene& scene, Precision precision) {
  return precision == Precision::full ? make_core_evaluator(scene) : make_core_float_evaluator(scene);
}

RunRequest request_of(const sweeps::Plan& plan, std::size_t vessel) {
  RunRequest request;
  request.vessel = vessel;
  request.last = plan.grips();
  request.grips = [&plan](std::size_t v, std::uint64_t first, std::size_t count, GripInput* out) {
    plan.fill(v, first, count, out);
  };
  return request;
}

std::uint64_t run_all(Backend& backend, const Scene& scene, const sweeps::Plan& plan) {
  std::uint64_t grips = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    RunRequest request = request_of(plan, v);
    request.best = 20;
    benchmark::DoNotOptimize(backend.run(request));
    grips += plan.grips();
  }
  return grips;
}

double hash_all(Backend& backend, const Scene& scene, const sweeps::Plan& plan) {
  std::uint64_t hash = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    RunRequest request = request_of(plan, v);
    request.sink = [&](const PlaneChunk& chunk) {
      for (int p = 0; p < backend.fields().uint_kept; ++p)
        for (std::size_t i = 0; i < chunk.count; ++i) {
          std::uint64_t mixed = ((v * 64 + p) << 40) ^ (chunk.first + i) ^ (std::uint64_t{chunk.uint(p, i)} << 17);
          mixed = (mixed ^ (mixed >> 31)) * 0x9e3779b97f4a7c15u;
          hash += mixed ^ (mixed >> 29);
        }
    };
    backend.run(request);
  }
  return static_cast<double>(hash >> 12);  // as many bits as a double holds
}

namespace {

// Ten times the default's heights, so that what is measured is the work and not the dozen waits of a run that lasts 15 ms.
constexpr int HEIGHTS = 640;
constexpr std::size_t PLAUSIBLE_STEPS = 300;

// A vessel of twelve elements, for what the outline's place costs where it is longer than a beaker's three.
Scene twelve_elements_scene() {
  Scene scene = grips_scene(HEIGHTS);
  VesselData vessel;
  vessel.name = "ribbed";
  vessel.wall = 1e-3;
  const double steps[][2] = {{30, 0},  {36, 8},  {40, 20}, {38, 34},  {39, 48},  {36, 60},
                             {33, 72}, {30, 84}, {26, 94}, {24, 104}, {24, 120}, {0, 120}};
  for (const auto& step : steps) vessel.outline.push_back({false, {step[0] * 1e-3, step[1] * 1e-3}, {}, 0, 0});
  vessel.height = 0.12;
  scene.vessels = {vessel};
  return scene;
}

void bench_backend(benchmark::State& state, Backend& backend, const Scene& scene) {
  const sweeps::Plan plan(scene, false);
  state.counters["hash"] = hash_all(backend, scene, plan);  // warms the device's compiler as well
  std::uint64_t grips = 0;
  for (auto _ : state) grips += run_all(backend, scene, plan);
  state.SetItemsProcessed(static_cast<std::int64_t>(grips));
}

void core_grips(benchmark::State& state, const Scene& scene, Precision precision, int threads) {
  CoreBackend backend(core_of(scene, precision), scene, make_field_set(KEPT, scene), precision, threads);
  bench_backend(state, backend, scene);
}

void vulkan_grips(benchmark::State& state, const Options& options, const Scene& scene, Precision precision, OutlineSource outline) {
  host::GripBackendOptions on_device;
  on_device.precision = precision;
  on_device.outline = outline;
  host::GripBackend backend(scene, make_core_evaluator(scene), make_field_set(KEPT, scene), options.device, on_device);
  bench_backend(state, backend, scene);
}

// One step of a live loop: all kernels, one grip, one state. The forces are those of the tips, as in a scene without [strength]; with
// efforts, the least effort of the whole hand and of the tips are found from nothing, of grips that are plausible.
void core_step(benchmark::State& state, bool liquid, bool efforts) {
  const Scene strong = read_scene_file(find_scene("three_beakers"));
  if (efforts && !strong.strength) {
    state.SkipWithError("the default scene has no [strength]");
    return;
  }
  Scene scene = strong;
  scene.strength.reset();
  const auto core = make_core_evaluator(scene);
  const sweeps::Plan plan(scene, false);
  GripResult result;
  std::uint64_t step = 0, number = 0;
  // beforehand, so that every step that is timed has an effort to find: most grips of the scene are implausible
  std::vector<std::uint64_t> steps;
  for (; efforts && steps.size() < PLAUSIBLE_STEPS; ++number) {
    const std::size_t vessel = number % scene.vessels.size();
    core->grip(vessel, plan.grip(vessel, number * 7919 % plan.grips()), result);
    if (result.reason == Reason::none && result.plausible) steps.push_back(number);
  }
  for (auto _ : state) {
    number = efforts ? steps[step % steps.size()] : step;
    ++step;
    const std::size_t vessel = number % scene.vessels.size();
    const GripInput grip = plan.grip(vessel, number * 7919 % plan.grips());
    core->grip(vessel, grip, result);
    sweeps::GripState at{0.5, radians(static_cast<double>(number % 60)), {}, {}};
    if (liquid) at.liquid = core->liquid(vessel, at.fill, at.tilt);
    if (result.reason != Reason::none) continue;
    at.state = core->state(vessel, grip, result, at.liquid, at.tilt);
    benchmark::DoNotOptimize(at.state);
    if (!efforts) continue;
    const sweeps::Holding holding(strong, *core, vessel, result, sweeps::pour_direction(strong, grip));
    benchmark::DoNotOptimize(holding.state(at).effort);
  }
}

void print_ratio(const Figures& figures, const char* fast, const char* slow, double wanted) {
  const auto a = figures.figures.find(fast), b = figures.figures.find(slow);
  if (a == figures.figures.end() || b == figures.figures.end()) return;
  fmt::print("{:<28} over {:<22} {:6.2f} x{}\n", fast, slow, b->second.microseconds / a->second.microseconds,
             wanted > 0 ? fmt::format("  (wanted: {:g})", wanted) : "");
}

}  // namespace

void add_grip_benchmarks(const Options& options) {
  const auto add = [](const char* name, auto&& function) {
    benchmark::RegisterBenchmark(name, function)->UseRealTime()->Unit(benchmark::kMillisecond);
  };
  const auto whole = std::make_shared<const Scene>(whole_scene(HEIGHTS)),
             beakers = std::make_shared<const Scene>(grips_scene(HEIGHTS)),
             ribbed = std::make_shared<const Scene>(twelve_elements_scene());
  const auto add_core = [&](const char* name, const std::shared_ptr<const Scene>& scene, Precision precision, int threads) {
    add(name, [=](benchmark::State& s) { core_grips(s, *scene, precision, threads); });
  };
  const auto add_vulkan = [&](const char* name, const std::shared_ptr<const Scene>& scene, Precision precision,
                              OutlineSource outline) {
    add(name, [=, &options](benchmark::State& s) { vulkan_grips(s, options, *scene, precision, outline); });
  };
  const auto add_step = [](const char* name, bool liquid, bool efforts) {
    benchmark::RegisterBenchmark(name, [=](benchmark::State& state) {
      core_step(state, liquid, efforts);
    })->Unit(benchmark::kMicrosecond);
  };
  add_core("core_double_1", beakers, Precision::full, 1);
  add_vulkan("vulkan_float", beakers, Precision::single, OUTLINE_COPIED);
  add_vulkan("vulkan_double", beakers, Precision::full, OUTLINE_COPIED);
  add_core("core_double_all", beakers, Precision::full, 0);
  add_core("core_float_1", beakers, Precision::single, 1);
  add_vulkan("vulkan_float_buffer", beakers, Precision::single, OUTLINE_BUFFER);
  add_vulkan("ribbed_float", ribbed, Precision::single, OUTLINE_COPIED);
  add_vulkan("ribbed_float_buffer", ribbed, Precision::single, OUTLINE_BUFFER);
  add_core("whole_core_all", whole, Precision::full, 0);
  add_vulkan("whole_vulkan_float", whole, Precision::single, OUTLINE_COPIED);
  add_step("step_dry", false, false);
  add_step("step_liquid", true, false);
  add_step("step_efforts", true, true);
}

void print_grip_ratios(const Figures& figures) {
  print_ratio(figures, "vulkan_float", "core_double_1", 10);
  print_ratio(figures, "vulkan_float", "core_double_all", 4);
  print_ratio(figures, "vulkan_double", "core_double_1", 5);
  print_ratio(figures, "vulkan_float", "vulkan_float_buffer", 4);
  print_ratio(figures, "ribbed_float", "ribbed_float_buffer", 4);
  print_ratio(figures, "whole_vulkan_float", "whole_core_all", 0);
  for (const auto& [step, wanted] : {std::pair{"step_dry", 20}, {"step_liquid", 40}, {"step_efforts", 60}})
    if (const auto found = figures.figures.find(step); found != figures.figures.end())
      fmt::print("{:<28} {:.2f} us  (wanted: {})\n", step, found->second.microseconds, wanted);
}

}  // namespace wholehand::bench
