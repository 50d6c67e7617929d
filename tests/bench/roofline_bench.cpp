// SPDX-License-Identifier: MIT
// The whole roofline as one benchmark with one iteration: one run measures peaks and kernels, and its table follows Google Benchmark's.
#include <optional>

#include "base/text/error.h"
#include "tests/bench/roofline.h"

namespace wholehand::bench {
namespace {

struct Roofline {
  Peaks peaks;
  std::vector<RooflineRow> rows;
};
std::optional<Roofline> measured;

Roofline measure(const Options& options) {
  Roofline roofline;
  roofline.peaks = measured_peaks(options);
  const Peaks& peaks = roofline.peaks;
  const auto workloads = roofline_workloads();
  const std::vector<Demand> demand = demands(workloads);
  const auto add = [&](std::vector<RooflineRow> rows) { roofline.rows.insert(roofline.rows.end(), rows.begin(), rows.end()); };
  add(core_rows(peaks, workloads, demand));
  add(device_rows(options, peaks, workloads, demand, Precision::single));
  if (peaks.device.float64) add(device_rows(options, peaks, workloads, demand, Precision::full));
  add(whole_rows(roofline.rows));
  return roofline;
}

}  // namespace

void add_roofline(const Options& options) {
  benchmark::RegisterBenchmark(ROOFLINE,
                               [&options](benchmark::State& state) {
                                 for (auto _ : state) measured = measure(options);
                               })
      ->Iterations(1)
      ->UseRealTime()
      ->Unit(benchmark::kSecond);
}

void finish_roofline(const Options& options) {
  if (!measured) {
    if (!options.roofline.empty())
      throw usage_error("--roofline: --benchmark_filter leaves the roofline out; a filter must match roofline");
    return;
  }
  print_roofline(measured->peaks, measured->rows);
  if (!options.roofline.empty()) write_roofline(options.roofline, measured->peaks, measured->rows);
}

}  // namespace wholehand::bench
