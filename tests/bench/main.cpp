// SPDX-License-Identifier: MIT
// What is measured, and how fast. Every figure is a ratio within one run; the absolute ones belong to the machine.
//   wholehand_bench [--csv FILE] [--roofline FILE] [--on DEVICE] [Google Benchmark's own options]
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "app/program/vulkan_environment.h"
#include "base/text/error.h"
#include "host/device.h"
#include "tests/bench/bench.h"

namespace wholehand::bench {

void Figures::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    if (run.error_occurred || run.run_name.function_name == ROOFLINE) continue;
    const bool median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
    if (!median && run.run_type == Run::RT_Aggregate) continue;
    const auto counter = [&run](const char* name) {
      const auto found = run.counters.find(name);
      return found == run.counters.end() ? 0.0 : static_cast<double>(found->second);
    };
    const double items = counter("items_per_second");
    const double microseconds = run.real_accumulated_time / static_cast<double>(std::max<std::int64_t>(1, run.iterations)) * 1e6;
    figures[run.run_name.function_name] = {items > 0 ? 1e6 / items : microseconds, counter("ratio"), counter("hash")};
  }
}

namespace {

void write_csv(const std::string& path, const Figures& figures, const Options& options) {
  const auto devices = host::list_devices();
  const auto& device = host::choose_device(devices, options.device);
  std::ofstream out(path);
  out << "benchmark,microseconds,ratio,hash,device,driver,threads\n";
  for (const auto& [name, figure] : figures.figures)
    out << fmt::format("{},{:.4f},{},{:013x},\"{}\",\"{}\",{}\n", name, figure.microseconds,
                       figure.ratio > 0 ? fmt::format("{:.2f}", figure.ratio) : "", static_cast<std::uint64_t>(figure.hash),
                       device.name, device.driver, std::thread::hardware_concurrency());
  out.flush();
  if (!out) throw failure_error(path + ": could not be written");
}

int run(int argc, char** argv) {
  Options options;
  std::string csv;
  std::vector<char*> rest;
  for (int i = 0; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--csv" && i + 1 < argc) {
      csv = argv[++i];
    } else if (argument == "--roofline" && i + 1 < argc) {
      options.roofline = argv[++i];
    } else if (argument == "--on" && i + 1 < argc) {
      options.device = argv[++i];
    } else {
      rest.push_back(argv[i]);
    }
  }
  int count = static_cast<int>(rest.size());
  benchmark::Initialize(&count, rest.data());
  if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 2;
  add_grip_benchmarks(options);
  add_effort_benchmarks(options);
  add_lattice_benchmarks(options);
  add_mesh_benchmarks();
  add_image_benchmarks(options);
  add_library_benchmarks();
  add_roofline(options);

  Figures figures;
  benchmark::RunSpecifiedBenchmarks(&figures);
  fmt::print("\n");
  print_grip_ratios(figures);
  finish_roofline(options);
  if (!csv.empty()) write_csv(csv, figures, options);
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace wholehand::bench

int main(int argc, char** argv) {
  wholehand::prepare_vulkan_environment();
  try {
    return wholehand::bench::run(argc, argv);
  } catch (const wholehand::Error& error) {
    fmt::print(stderr, "wholehand_bench: {}\n", error.what());
    return static_cast<int>(error.code);
  }
}
