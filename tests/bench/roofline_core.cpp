// SPDX-License-Identifier: MIT
// What the kernels cost on the core.
#include <algorithm>
#include <memory>

#include "core/core_backend.h"
#include "core/evaluator.h"
#include "tests/bench/roofline.h"

namespace wholehand::bench {
namespace {

constexpr int ROUNDS = 3;
constexpr int SHORT_TRIES = 4;  // in a round, of what takes a twentieth of a second

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// A workload's sample, ready to be run.
struct CoreRun {
  CoreRun(const Workload& workload, const CoreWay& way)
      : backend(core_of(workload.scene, way.precision), workload.scene, workload.fields, way.precision, way.all_threads ? 0 : 1) {
    for (std::size_t v = 0; v < workload.scene.vessels.size(); ++v) samples.push_back(sample_of(workload, v));
  }

  void run() {
    for (std::size_t v = 0; v < samples.size(); ++v) {
      RunRequest request;
      request.vessel = v;
      request.last = samples[v].size();
      request.grips = [&](std::size_t w, std::uint64_t first, std::size_t count, GripInput* out) {
        std::copy_n(samples[w].begin() + static_cast<std::ptrdiff_t>(first), count, out);
      };
      benchmark::DoNotOptimize(backend.run(request));
    }
  }

  CoreBackend backend;
  std::vector<std::vector<GripInput>> samples;
};

// Cost of each step, without those before it.
std::vector<Cost> step_costs(const std::vector<Workload>& workloads, const CoreWay& way) {
  std::vector<std::unique_ptr<CoreRun>> runs;
  for (const Workload& workload : workloads) runs.push_back(std::make_unique<CoreRun>(workload, way));
  std::vector<double> wall[STEPS], processor[STEPS];
  for (int round = 0; round < ROUNDS; ++round) {
    Cost before;
    for (int step = 0; step < STEPS; ++step) {
      const Cost cost = best_cost(step <= FORCES ? SHORT_TRIES : 1, [&] { runs[static_cast<std::size_t>(step)]->run(); });
      wall[step].push_back(replaces(step) ? cost.wall : cost.wall - before.wall);
      processor[step].push_back(replaces(step) ? cost.processor : cost.processor - before.processor);
      before = cost;
    }
  }
  std::vector<Cost> costs;
  for (int step = 0; step < STEPS; ++step) costs.push_back({median(wall[step]), median(processor[step])});
  return costs;
}

}  // namespace

std::vector<RooflineRow> core_rows(const Peaks& peaks, const std::vector<Workload>& workloads, const std::vector<Demand>& demands) {
  const std::vector<double> bytes =
      bytes_of(workloads, sizeof(double), false);  // the core's planes are doubles in either precision
  const double grips = static_cast<double>(SAMPLE * workloads[0].scene.vessels.size());
  std::vector<RooflineRow> rows;
  for (const CoreWay& way : CORE_WAYS) {
    const Roof roof = processor_roof(peaks, way.precision, way.all_threads);
    const std::vector<Cost> costs = step_costs(workloads, way);
    for (std::size_t step = 0; step < STEPS; ++step)
      rows.push_back(
          {step_name(static_cast<int>(step)), way.backend, "grip", demands[step], bytes[step], grips, costs[step], roof, {}});
  }
  return rows;
}

}  // namespace wholehand::bench
