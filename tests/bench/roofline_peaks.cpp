// SPDX-License-Identifier: MIT
// What the machine can do at most, measured in the run that it is compared with.
#include <algorithm>

#include "base/numbers/parallel.h"
#include "tests/bench/roofline.h"
#include "tests/support/lane_probe.h"

namespace wholehand::bench {
namespace {

ProcessorPeaks peaks_of(int threads) {
  return {processor_peak(Precision::single, threads), processor_peak(Precision::full, threads),
          scalar_peak(Precision::full, threads), processor_copy_rate(threads)};
}

}  // namespace

Peaks measured_peaks(const Options& options) {
  Peaks peaks;
  peaks.one_thread = peaks_of(1);
  peaks.all_threads = peaks_of(thread_count());
  const host::Device on(options.device);
  peaks.device = on.info();
  peaks.device_float = device_peak(on, Precision::single);
  if (on.info().float64) peaks.device_double = device_peak(on, Precision::full);
  peaks.device_copy_rate = device_copy_rate(on);
  peaks.counts_lanes = counted_lanes(on) == expected_lanes(on);
  return peaks;
}

Roof processor_roof(const Peaks& peaks, Precision precision, bool all_threads) {
  const auto peak_of = [&](const ProcessorPeaks& of) {
    return (precision == Precision::single ? of.in_float : of.in_double).operations;
  };
  const ProcessorPeaks& of = all_threads ? peaks.all_threads : peaks.one_thread;
  return {peak_of(of), of.copy_rate, peak_of(peaks.one_thread)};
}

Roof device_roof(const Peaks& peaks, Precision precision) {
  const DevicePeak& own = precision == Precision::single ? peaks.device_float : peaks.device_double;
  if (peaks.device.kind == host::DeviceKind::cpu) return processor_roof(peaks, precision, true);
  return {std::max(own.fused, own.apart), peaks.device_copy_rate, 0};
}

}  // namespace wholehand::bench
