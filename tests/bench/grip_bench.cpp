// How fast grips are scored, on the core and on Vulkan. Every figure is a ratio within one run; the absolute ones belong to the machine.
//   wholehand_bench [--csv FILE] [--on DEVICE] [Google Benchmark's own options]
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <numeric>
#include <thread>

#include "app/paths.h"
#include "app/scene_reader.h"
#include "core/evaluator.h"
#include "host/grip_backend.h"
#include "sweeps/core_backend.h"
#include "sweeps/plan.h"

namespace wholehand {
namespace {

std::string device_name = "vulkan";

// The default scene, fills and tilts included, at ten times its heights, so that what is measured is the work and not the dozen waits of
// a run that lasts 15 ms.
Scene whole_scene() {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  std::vector<double>& heights = scene.grips.height.values;
  const double low = heights.front(), high = heights.back();
  heights.clear();
  for (int k = 0; k < 640; ++k) heights.push_back(low + (high - low) * k / 639);
  return scene;
}

// Its grips alone: closure, projection and contact.
Scene grips_scene() {
  Scene scene = whole_scene();
  scene.liquid.reset();
  scene.tilts.clear();
  return scene;
}

// A vessel of twelve elements, for what the outline's place costs where it is longer than a beaker's three.
Scene twelve_elements_scene() {
  Scene scene = grips_scene();
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

std::uint64_t run_all(Backend& backend, const Scene& scene, const Plan& plan) {
  std::uint64_t grips = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    RunRequest request;
    request.vessel = v;
    request.last = plan.grips();
    request.best = 20;
    request.grips = [&plan](std::size_t w, std::uint64_t first, std::size_t count, GripInput* out) {
      plan.fill(w, first, count, out);
    };
    benchmark::DoNotOptimize(backend.run(request));
    grips += plan.grips();
  }
  return grips;
}

// Over the masks of a full run, whatever its chunks: two lines with one hash found the same contacts.
std::uint64_t hash_all(Backend& backend, const Scene& scene, const Plan& plan) {
  std::uint64_t hash = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    RunRequest request;
    request.vessel = v;
    request.last = plan.grips();
    request.grips = [&plan](std::size_t w, std::uint64_t first, std::size_t count, GripInput* out) {
      plan.fill(w, first, count, out);
    };
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
  return hash;
}

const std::vector<int> KEPT{FIELD_SCORE,         FIELD_TERMS,       FIELD_GAP,        FIELD_CLOSURE,
                            FIELD_PHALANX_DEPTH, FIELD_PALM_DEPTH,  FIELD_STATUS,     FIELD_TOUCH_MASK,
                            FIELD_TIP_MASK,      FIELD_FINGER_MASK, FIELD_INNER_MASK, FIELD_USED_MASK};

void bench_backend(benchmark::State& state, Backend& backend, const Scene& scene) {
  const Plan plan(scene, false);
  state.counters["hash"] =
      static_cast<double>(hash_all(backend, scene, plan) >> 12);  // warms the device's compiler as well; 52 bits
  std::uint64_t grips = 0;
  for (auto _ : state) grips += run_all(backend, scene, plan);
  state.SetItemsProcessed(static_cast<std::int64_t>(grips));
}

void core_grips(benchmark::State& state, const Scene& scene, Precision precision, int threads) {
  auto core = precision == Precision::full ? make_core_evaluator(scene) : make_core_float_evaluator(scene);
  CoreBackend backend(std::move(core), scene, make_field_set(KEPT, scene), precision, threads);
  bench_backend(state, backend, scene);
}

void vulkan_grips(benchmark::State& state, const Scene& scene, Precision precision, OutlineSource outline) {
  host::GripBackendOptions options;
  options.precision = precision;
  options.outline = outline;
  host::GripBackend backend(scene, make_core_evaluator(scene), make_field_set(KEPT, scene), device_name, options);
  bench_backend(state, backend, scene);
}

// One step of a live loop: all kernels, one grip, one state.
void core_step(benchmark::State& state, bool liquid) {
  const Scene scene = read_scene_file(find_scene("three_beakers"));
  const auto core = make_core_evaluator(scene);
  const Plan plan(scene, false);
  GripResult result;
  std::uint64_t step = 0;
  for (auto _ : state) {
    const std::size_t vessel = step % scene.vessels.size();
    const GripInput grip = plan.grip(vessel, step * 7919 % plan.grips());
    core->grip(vessel, grip, result);
    const double tilt = radians(static_cast<double>(step % 60));
    const LiquidResult held = liquid ? core->liquid(vessel, 0.5, tilt) : LiquidResult{};
    if (result.reason == Reason::none) benchmark::DoNotOptimize(core->state(vessel, grip, result, held, tilt));
    ++step;
  }
}

struct Figure {
  double microseconds = 0;  // a grip or step, the median where there are repetitions
  double hash = 0;          // of the results, 52 bits; 0: none
};

// Keeps every figure for the ratios after the table.
class Ratios : public benchmark::ConsoleReporter {
 public:
  Ratios() : ConsoleReporter(isatty(STDOUT_FILENO) ? OO_ColorTabular : OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.error_occurred) continue;
      const bool median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
      if (!median && run.run_type == Run::RT_Aggregate) continue;
      const double items = run.counters.count("items_per_second") ? static_cast<double>(run.counters.at("items_per_second")) : 0;
      const double microseconds = run.real_accumulated_time / static_cast<double>(std::max<std::int64_t>(1, run.iterations)) * 1e6;
      const double hash = run.counters.count("hash") ? static_cast<double>(run.counters.at("hash")) : 0;
      figures[run.run_name.function_name] = {items > 0 ? 1e6 / items : microseconds, hash};
    }
  }
  std::map<std::string, Figure> figures;
};

void print_ratio(const Ratios& ratios, const char* fast, const char* slow, double wanted) {
  const auto a = ratios.figures.find(fast), b = ratios.figures.find(slow);
  if (a == ratios.figures.end() || b == ratios.figures.end()) return;
  fmt::print("{:<28} over {:<22} {:6.2f} x{}\n", fast, slow, b->second.microseconds / a->second.microseconds,
             wanted > 0 ? fmt::format("  (wanted: {:g})", wanted) : "");
}

}  // namespace
}  // namespace wholehand

int main(int argc, char** argv) {
  using namespace wholehand;
  std::string csv;
  std::vector<char*> rest;
  for (int i = 0; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--csv" && i + 1 < argc) {
      csv = argv[++i];
    } else if (argument == "--on" && i + 1 < argc) {
      device_name = argv[++i];
    } else {
      rest.push_back(argv[i]);
    }
  }
  int count = static_cast<int>(rest.size());
  benchmark::Initialize(&count, rest.data());
  if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 2;
  const auto add = [](const char* name, auto&& function) {
    benchmark::RegisterBenchmark(name, function)->UseRealTime()->Unit(benchmark::kMillisecond);
  };
  const auto add_step = [](const char* name, bool liquid) {
    benchmark::RegisterBenchmark(name, [liquid](benchmark::State& state) {
      core_step(state, liquid);
    })->Unit(benchmark::kMicrosecond);
  };
  const Scene whole = whole_scene(), beakers = grips_scene(), ribbed = twelve_elements_scene();
  add("core_double_1", [&](benchmark::State& s) { core_grips(s, beakers, Precision::full, 1); });
  add("vulkan_float", [&](benchmark::State& s) { vulkan_grips(s, beakers, Precision::single, OUTLINE_SPECIALIZED); });
  add("vulkan_double", [&](benchmark::State& s) { vulkan_grips(s, beakers, Precision::full, OUTLINE_SPECIALIZED); });
  add("core_double_all", [&](benchmark::State& s) { core_grips(s, beakers, Precision::full, 0); });
  add("core_float_1", [&](benchmark::State& s) { core_grips(s, beakers, Precision::single, 1); });
  add("vulkan_float_hoisted", [&](benchmark::State& s) { vulkan_grips(s, beakers, Precision::single, OUTLINE_HOISTED); });
  add("vulkan_float_buffer", [&](benchmark::State& s) { vulkan_grips(s, beakers, Precision::single, OUTLINE_BUFFER); });
  add("ribbed_float", [&](benchmark::State& s) { vulkan_grips(s, ribbed, Precision::single, OUTLINE_SPECIALIZED); });
  add("ribbed_float_hoisted", [&](benchmark::State& s) { vulkan_grips(s, ribbed, Precision::single, OUTLINE_HOISTED); });
  add("ribbed_float_buffer", [&](benchmark::State& s) { vulkan_grips(s, ribbed, Precision::single, OUTLINE_BUFFER); });
  add("whole_core_all", [&](benchmark::State& s) { core_grips(s, whole, Precision::full, 0); });
  add("whole_vulkan_float", [&](benchmark::State& s) { vulkan_grips(s, whole, Precision::single, OUTLINE_SPECIALIZED); });
  add_step("step_dry", false);
  add_step("step_liquid", true);

  Ratios ratios;
  benchmark::RunSpecifiedBenchmarks(&ratios);
  fmt::print("\n");
  print_ratio(ratios, "vulkan_float", "core_double_1", 10);
  print_ratio(ratios, "vulkan_float", "core_double_all", 4);
  print_ratio(ratios, "vulkan_double", "core_double_1", 5);
  print_ratio(ratios, "vulkan_float", "vulkan_float_buffer", 4);
  print_ratio(ratios, "vulkan_float_hoisted", "vulkan_float_buffer", 0);
  print_ratio(ratios, "ribbed_float", "ribbed_float_buffer", 4);
  print_ratio(ratios, "ribbed_float_hoisted", "ribbed_float_buffer", 0);
  print_ratio(ratios, "whole_vulkan_float", "whole_core_all", 0);
  for (const char* step : {"step_dry", "step_liquid"})
    if (ratios.figures.count(step)) fmt::print("{:<28} {:.2f} us\n", step, ratios.figures[step].microseconds);
  if (!csv.empty()) {
    const auto devices = host::list_devices();
    const auto& device = host::choose_device(devices, device_name);
    std::ofstream out(csv);
    out << "benchmark,microseconds,hash,device,driver,threads\n";
    for (const auto& [name, figure] : ratios.figures)
      out << fmt::format("{},{:.4f},{:013x},\"{}\",\"{}\",{}\n", name, figure.microseconds, static_cast<std::uint64_t>(figure.hash),
                         device.name, device.driver, std::thread::hardware_concurrency());
    out.flush();
    if (!out) {
      fmt::print(stderr, "wholehand_bench: {}: could not be written\n", csv);
      return 3;
    }
  }
  benchmark::Shutdown();
  return 0;
}
