// SPDX-License-Identifier: MIT
// The roofline of the kernels: what they do, what that costs, and what the machine can do at most.
//
// Work is added step by step, so that what a kernel does is what its step adds: to the operations that the core counts, and to the core's
// time. A device times each kernel by itself.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/planes.h"
#include "core/scene.h"
#include "tests/bench/bench.h"
#include "tests/bench/cost.h"
#include "tests/bench/device_peak.h"
#include "tests/bench/processor_peak.h"
#include "tests/support/counted.h"

namespace wholehand::bench {

// Steps of work on a grip, in order.
enum Step { GRIPS, BODIES, FORCES, EFFORTS, RESERVES, STEPS };
// "grips": closure, projection and contact of bare joints, and the score. "bodies": the same with spheres between the joints and the table.
// What comes to it: "forces" over all states, "efforts" over them (worst, of the tips, safe tilts), "reserves" (push and friction).
const char* step_name(int step);
// Whether a step's work contains that of the one before it; otherwise it is added to it.
constexpr bool replaces(int step) { return step <= BODIES; }

struct Workload {
  Scene scene;
  FieldSet fields;  // what a sweep of this scene keeps
};
// The default scene's, up to each step. Throws Error where the default scene lacks what a step needs.
std::vector<Workload> roofline_workloads();

// Grips of each vessel that everything is measured on: groups of neighbors, as a device takes them, spread over the plan.
constexpr std::size_t SAMPLE = 24 * GROUP_SIZE;
std::vector<GripInput> sample_of(const Workload& workload, std::size_t vessel);

// What a kernel has to do and has read and written, an item (a grip, state or sample), by design: tables that all grips share stay in
// caches, and do not count.
struct Demand {
  double additions = 0, multiplications = 0, divisions = 0, roots = 0, transcendentals = 0, comparisons = 0;
  double operations() const { return additions + multiplications + divisions + roots + transcendentals; }
};
Demand operator+(const Demand& a, const Demand& b);
Demand demand_of(const OperationCounts& counts, double items);
// Demand of each step on the sample, by the counting core.
std::vector<Demand> demands(const std::vector<Workload>& workloads);
// Bytes of a number.
constexpr std::size_t real_bytes(Precision precision) { return precision == Precision::single ? sizeof(float) : sizeof(double); }
// Bytes a grip of each step; `real`: bytes of a number; on a device kernels also hand over contacts and masks.
std::vector<double> bytes_of(const std::vector<Workload>& workloads, std::size_t real, bool on_device);

// What the machine can do at most.
struct ProcessorPeaks {
  ProcessorPeak in_float, in_double;
  ProcessorPeak scalar;  // in double, one number at a time
  double copy_rate = 0;
};
struct Peaks {
  ProcessorPeaks one_thread, all_threads;
  host::DeviceInfo device;
  DevicePeak device_float, device_double;  // the latter 0 where the device has no double
  double device_copy_rate = 0;
  bool counts_lanes = false;  // the device counts its useful lanes right
};
Peaks measured_peaks(const Options& options);

// What bounds a kernel: operations and bytes a second, and operations a second of a processor; 0 where none computes.
struct Roof {
  double peak = 0, copy_rate = 0, processor_peak = 0;
};
Roof processor_roof(const Peaks& peaks, Precision precision, bool all_threads);
// The device's own; of one that runs on the processor the processor's, of which it may reach a part.
Roof device_roof(const Peaks& peaks, Precision precision);

// Where a kernel counts its lanes (COUNT_LANES), over all times that a vector came by.
struct Lanes {
  double useful = 0, all = 0;  // none: not counted
  double share() const { return useful / all; }
};

// One line of the table.
struct RooflineRow {
  std::string kernel, backend, item;
  Demand demand;  // an item
  double bytes = 0;
  double items = 0;  // that the cost is of
  Cost cost;
  Roof roof;
  Lanes lanes;
};

// Ways that the core is asked, as backends of the table.
struct CoreWay {
  const char* backend;
  Precision precision;
  bool all_threads;
};
inline constexpr CoreWay CORE_WAYS[] = {{"core double, one thread", Precision::full, false},
                                        {"core double, all threads", Precision::full, true},
                                        {"core float, one thread", Precision::single, false}};
const char* device_backend(Precision precision);

// Costs of the steps on the core, of the sample, each the median of rounds in which all take turns.
std::vector<RooflineRow> core_rows(const Peaks& peaks, const std::vector<Workload>& workloads, const std::vector<Demand>& demands);
// On a device, kernel by kernel, each the best of some rounds; with the useful lanes.
std::vector<RooflineRow> device_rows(const Options& options, const Peaks& peaks, const std::vector<Workload>& workloads,
                                     const std::vector<Demand>& demands, Precision precision);
// The whole of a grip on each backend of such rows: what follows the grips without bodies, together.
std::vector<RooflineRow> whole_rows(const std::vector<RooflineRow>& rows);

void print_roofline(const Peaks& peaks, const std::vector<RooflineRow>& rows);
// Throws Error where it cannot be written.
void write_roofline(const std::string& path, const Peaks& peaks, const std::vector<RooflineRow>& rows);

}  // namespace wholehand::bench
