// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "base/text/error.h"
#include "tests/bench/roofline.h"

namespace wholehand::bench {
namespace {

double rate_of(const RooflineRow& row) { return row.items / row.cost.wall; }  // items a second
double reached_by(const RooflineRow& row) { return rate_of(row) * row.demand.operations(); }
double intensity_of(const RooflineRow& row) { return row.demand.operations() / row.bytes; }  // operations a byte
bool is_bound_by_memory(const RooflineRow& row) { return intensity_of(row) * row.roof.copy_rate < row.roof.peak; }
double height_of(const RooflineRow& row) { return std::min(row.roof.peak, intensity_of(row) * row.roof.copy_rate); }

// Share of the processors' peak over its processor time, whatever else runs.
std::string busy_share(const RooflineRow& row, double scale, int digits) {
  if (!(row.roof.processor_peak > 0)) return "";
  const double rate = row.items * row.demand.operations() / row.cost.processor;
  return fmt::format("{:.{}f}", scale * rate / row.roof.processor_peak, digits);
}

// Share of the useful ones, and how often an item came by.
std::string lanes_of(const RooflineRow& row) {
  return row.lanes.all > 0 ? fmt::format("{:.4f},{:.2f}", row.lanes.share(), row.lanes.useful / row.items) : ",";
}

void print_peaks(const char* name, const ProcessorPeaks& peaks) {
  fmt::print("  {:<22} {:7.1f} GFLOP/s float ({}), {:7.1f} double ({}), {:5.1f} double one by one; copies {:5.1f} GB/s\n", name,
             peaks.in_float.operations / 1e9, peaks.in_float.instructions, peaks.in_double.operations / 1e9,
             peaks.in_double.instructions, peaks.scalar.operations / 1e9, peaks.copy_rate / 1e9);
}

void print_device(const Peaks& peaks) {
  fmt::print("  {:<22} {:7.1f} GFLOP/s float by fma, {:.1f} by product and sum; double {:.1f} and {:.1f}; copies {:5.1f} GB/s\n",
             "device", peaks.device_float.fused / 1e9, peaks.device_float.apart / 1e9, peaks.device_double.fused / 1e9,
             peaks.device_double.apart / 1e9, peaks.device_copy_rate / 1e9);
}

}  // namespace

void print_roofline(const Peaks& peaks, const std::vector<RooflineRow>& rows) {
  fmt::print(
      "Roofline. Operations: sums, products, quotients, roots and transcendental functions count one each, a multiply-add two.\n");
  fmt::print("What can be done at most ({}, {}):\n", peaks.device.name, peaks.device.driver);
  print_peaks("processor, one thread", peaks.one_thread);
  print_peaks("processor, all threads", peaks.all_threads);
  print_device(peaks);
  if (!peaks.counts_lanes) fmt::print("  This device does not count its useful lanes right, so they are left out.\n");
  fmt::print("{:<9} {:<25} {:<6} {:>10} {:>11} {:>8} {:>9} {:>8} {:>8} {:>8} {:>6} {:>9} {:>9}\n", "kernel", "backend", "item",
             "operations", "items/s", "GFLOP/s", "% of peak", "by CPU", "op/byte", "bound by", "lanes", "CPU us", "wall us");
  for (const RooflineRow& row : rows)
    fmt::print("{:<9} {:<25} {:<6} {:>10.0f} {:>11.4g} {:>8.3f} {:>9.2f} {:>8} {:>8.1f} {:>8} {:>6} {:>9.3f} {:>9.3f}\n",
               row.kernel, row.backend, row.item, row.demand.operations(), rate_of(row), reached_by(row) / 1e9,
               100 * reached_by(row) / row.roof.peak, busy_share(row, 100, 2), intensity_of(row),
               is_bound_by_memory(row) ? "memory" : "compute",
               row.lanes.all > 0 ? fmt::format("{:.0f}%", 100 * row.lanes.share()) : "-", 1e6 * row.cost.processor / row.items,
               1e6 * row.cost.wall / row.items);
}

void write_roofline(const std::string& path, const Peaks& peaks, const std::vector<RooflineRow>& rows) {
  std::ofstream out(path);
  out << "kernel,backend,item,operations,additions,multiplications,divisions,roots,transcendentals,comparisons,bytes,";
  out << "items_per_second,gflops,peak_gflops,share_of_peak,share_by_processor_time,copy_gbytes,bound_by,share_of_roof,useful_"
         "lanes,useful_turns,";
  out << "processor_seconds,wall_seconds,items,device,driver,threads\n";
  for (const RooflineRow& row : rows) {
    const Demand& demand = row.demand;
    out << fmt::format("{},\"{}\",{},{:.2f},{:.2f},{:.2f},{:.3f},{:.3f},{:.3f},{:.2f},{:.3f},{:.1f},", row.kernel, row.backend,
                       row.item, demand.operations(), demand.additions, demand.multiplications, demand.divisions, demand.roots,
                       demand.transcendentals, demand.comparisons, row.bytes, rate_of(row));
    out << fmt::format("{:.4f},{:.1f},{:.5f},{},{:.1f},{},{:.5f},{},{:.5f},{:.5f},{:.0f},\"{}\",\"{}\",{}\n", reached_by(row) / 1e9,
                       row.roof.peak / 1e9, reached_by(row) / row.roof.peak, busy_share(row, 1, 5), row.roof.copy_rate / 1e9,
                       is_bound_by_memory(row) ? "memory" : "compute", reached_by(row) / height_of(row), lanes_of(row),
                       row.cost.processor, row.cost.wall, row.items, peaks.device.name, peaks.device.driver,
                       std::thread::hardware_concurrency());
  }
  out.flush();
  if (!out) throw failure_error(path + ": could not be written");
}

}  // namespace wholehand::bench
