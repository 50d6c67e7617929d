// SPDX-License-Identifier: MIT
// Kernels that are no work of a grip: the liquid of each fill and tilt, which is computed once for a vessel, and rendered walls.
#include <algorithm>
#include <memory>
#include <vector>

#include "base/numbers/parallel.h"
#include "core/evaluator.h"
#include "core/wall_run.h"
#include "host/grip_program.h"
#include "host/run_once.h"
#include "host/wall_map.h"
#include "tests/bench/roofline.h"
#include "tests/bench/shaders.h"
#include "tests/support/counted_core.h"

namespace core_f32 {
double late_energy(const wholehand::WallCase& wall_case, int samples, int late);
}

namespace wholehand::bench {
namespace {

constexpr int ROUNDS = 5;
constexpr std::size_t WALLS = 4096;
constexpr int SAMPLES = 400, LATE = 100;

// The liquid of state i of all that the scene has, vessel by vessel.
void ask_liquid(const Evaluator& core, const Scene& scene, std::size_t i) {
  const std::size_t tilts = scene.tilts.size(), states = scene_fills(scene) * tilts, v = i / states;
  const std::vector<double>& fills = vessel_fills(scene, scene.vessels[v]);
  benchmark::DoNotOptimize(core.liquid(v, fills[i % states / tilts], scene.tilts[i % tilts]));
}

// The device's kernel of liquid, of all vessels.
class LiquidRun {
 public:
  LiquidRun(const Options& options, const Scene& scene, Precision precision) : precision_(precision) {
    host::GripBackendOptions on_device;
    on_device.precision = precision;
    const auto core = make_core_evaluator(scene);
    const host::SceneArrays arrays = host::make_scene_arrays(scene, *core, {});
    program_ = std::make_unique<host::GripProgram>(scene, arrays, *core, make_field_set({FIELD_PEAK_FORCE}, scene), options.device,
                                                   on_device);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      work_.push_back(program_->liquid_work(v, arrays));
      host::run_once(program_->on, work_.back()->commands);  // the capacities of the lip, which the liquid reads
    }
  }

  Cost cost() {
    Cost sum;
    for (const auto& work : work_) {
      double wall = 1e300;
      const Cost best =
          best_cost(ROUNDS, [&] { wall = std::min(wall, host::run_once(program_->on, work->commands.only(LIQUID))); });
      sum = {sum.wall + wall, sum.processor + best.processor};
    }
    return sum;
  }

  Lanes lanes() {
    const host::Device& on = program_->on;
    const std::vector<host::Constant> constants{{CONST_GROUP_SIZE, std::uint32_t(GROUP_SIZE)}};
    const host::Kernel counting(on, host::find_shader("liquid", precision_, BUILD_WIDE, OUTLINE_NONE, lane_shaders()), constants,
                                "liquid");
    host::Buffer lanes(on, 2 * sizeof(std::uint32_t));
    lanes.write(std::vector<std::uint32_t>{0, 0});
    const std::uint32_t states = program_->fill_count * program_->tilt_count;
    for (const auto& work : work_) {
      host::Commands commands = work->commands;
      commands.bind(BINDING_LANES, lanes);
      commands.dispatch(counting, host::groups_for(on, counting, states), Push{states, 0, 0, 0});
      host::run_once(on, commands.only(commands.steps().size() - 1));
    }
    const auto counted = lanes.read_as<std::uint32_t>(2);
    return {static_cast<double>(counted[0]), static_cast<double>(counted[1])};
  }

 private:
  static constexpr std::size_t LIQUID = 1;  // among the steps of the work
  Precision precision_;
  std::unique_ptr<host::GripProgram> program_;
  std::vector<std::unique_ptr<host::LiquidWork>> work_;
};

// Walls of many stiffnesses and dampings, with an encoder and a delay, as wholehand evaluates them.
std::vector<WallCase> walls() {
  std::vector<WallCase> cases(WALLS);
  for (std::size_t i = 0; i < WALLS; ++i) {
    cases[i].wall_stiffness = 10.0 * static_cast<double>(i % 64);
    cases[i].wall_damping = 0.1 * static_cast<double>(i / 64);
    cases[i].encoder_step = 1e-5;
    cases[i].delay = 1;
    cases[i].press = 1;
    cases[i].place = 1e-3;
  }
  return cases;
}

Cost wall_cost(const std::vector<WallCase>& cases, const CoreWay& way) {
  const auto energy = way.precision == Precision::full ? core_f64::late_energy : core_f32::late_energy;
  return best_cost(ROUNDS, [&] {
    in_parallel(cases.size(), way.all_threads ? 0 : 1,
                [&](std::size_t i) { benchmark::DoNotOptimize(energy(cases[i], SAMPLES, LATE)); });
  });
}

Cost wall_cost(const Options& options, const std::vector<WallCase>& cases, Precision precision) {
  host::WallMap map(options.device, precision);
  const auto run = [&] { benchmark::DoNotOptimize(map.late_energies(cases, SAMPLES, LATE)); };
  run();  // with the driver's compilation
  Cost best{1e300, 1e300};
  for (int round = 0; round < ROUNDS; ++round) {
    const double before = map.kernel_seconds();
    const Cost cost = cost_of(run);
    best = least_of(best, {map.kernel_seconds() - before, cost.processor});
  }
  return best;
}

}  // namespace

std::vector<RooflineRow> liquid_rows(const Options& options, const Peaks& peaks, const Scene& scene) {
  const std::size_t states = scene.vessels.size() * scene_fills(scene) * scene.tilts.size();
  const auto counting = core_counted::make_evaluator(scene, {});
  const OperationCounts before = operations_so_far;
  for (std::size_t i = 0; i < states; ++i) ask_liquid(*counting, scene, i);
  const Demand demand = demand_of(operations_so_far - before, static_cast<double>(states));
  std::vector<RooflineRow> rows;
  for (const CoreWay& way : CORE_WAYS) {
    const auto core = core_of(scene, way.precision);
    const Cost cost = best_cost(
        ROUNDS, [&] { in_parallel(states, way.all_threads ? 0 : 1, [&](std::size_t i) { ask_liquid(*core, scene, i); }); });
    // fill and tilt come in; volume, mass, lean, height and what poured go out
    rows.push_back({"liquid",
                    way.backend,
                    "state",
                    demand,
                    (2 + LIQUID_STRIDE) * sizeof(double),
                    static_cast<double>(states),
                    cost,
                    processor_roof(peaks, way.precision, way.all_threads),
                    {}});
  }
  for (const Precision precision : {Precision::single, Precision::full}) {
    if (precision == Precision::full && !peaks.device.float64) continue;
    LiquidRun run(options, scene, precision);
    // on a device the load goes out as well
    rows.push_back({"liquid", device_backend(precision), "state", demand,
                    static_cast<double>((2 + LIQUID_STRIDE + LOAD_STRIDE) * real_bytes(precision)), static_cast<double>(states),
                    run.cost(), device_roof(peaks, precision), peaks.counts_lanes ? run.lanes() : Lanes{}});
  }
  return rows;
}

std::vector<RooflineRow> wall_rows(const Options& options, const Peaks& peaks) {
  const std::vector<WallCase> cases = walls();
  const OperationCounts before = operations_so_far;
  for (const WallCase& wall : cases) core_counted::late_energy(wall, SAMPLES, LATE);
  const double samples = static_cast<double>(WALLS) * SAMPLES;
  const Demand demand = demand_of(operations_so_far - before, samples);
  // a case comes in and an energy goes out, after so many samples
  const auto bytes = [](std::size_t real) { return static_cast<double>((CASE_PLANES + 1) * real) / SAMPLES; };
  std::vector<RooflineRow> rows;
  for (const CoreWay& way : CORE_WAYS)
    rows.push_back({"walls",
                    way.backend,
                    "sample",
                    demand,
                    bytes(sizeof(double)),
                    samples,
                    wall_cost(cases, way),
                    processor_roof(peaks, way.precision, way.all_threads),
                    {}});
  for (const Precision precision : {Precision::single, Precision::full}) {
    if (precision == Precision::full && !peaks.device.float64) continue;
    rows.push_back({"walls",
                    device_backend(precision),
                    "sample",
                    demand,
                    bytes(real_bytes(precision)),
                    samples,
                    wall_cost(options, cases, precision),
                    device_roof(peaks, precision),
                    {}});
  }
  return rows;
}

}  // namespace wholehand::bench
