// SPDX-License-Identifier: MIT
#include "tests/bench/device_peak.h"

#include <algorithm>
#include <vector>

#include "base/numbers/parallel.h"
#include "host/commands.h"
#include "host/run_once.h"
#include "tests/bench/cost.h"
#include "tests/bench/shaders.h"
#include "tests/bench/shaders/peak.h"

namespace wholehand::bench {
namespace {

constexpr int TRIES = 5;
constexpr double TRY_SECONDS = 0.03;
constexpr std::uint32_t MOST_TURNS = 60000;      // of a loop that a driver may end after 65,535
constexpr std::uint32_t CPU_INVOCATIONS = 4096;  // vectors enough for every core
constexpr std::uint32_t GPU_INVOCATIONS = std::uint32_t(1) << 18;
constexpr std::size_t CPU_COPY = std::size_t(128) << 20, GPU_COPY = std::size_t(512) << 20;  // bytes of a buffer

host::Kernel bench_kernel(const host::Device& on, const char* name, Precision precision, bool fused = true) {
  const std::vector<host::Constant> constants{{CONST_GROUP_SIZE, std::uint32_t(GROUP_SIZE)}, {CONST_FUSED, std::int32_t(fused)}};
  return {on, host::find_shader(name, precision, BUILD_WIDE, OUTLINE_NONE, bench_shaders()), constants, name};
}

double best_seconds(const host::Device& on, const host::Commands& commands) {
  double best = host::run_once(on, commands);
  for (int k = 1; k < TRIES; ++k) best = std::min(best, host::run_once(on, commands));
  return best;
}

// A driver on the processor is timed as if it had all processors to itself.
double best_computing_seconds(const host::Device& on, const host::Commands& commands) {
  double best = best_seconds(on, commands);
  for (int k = 0; k < TRIES && on.info().kind == host::DeviceKind::cpu; ++k) {
    const Cost cost = cost_of([&] { host::run_once(on, commands); });
    best = std::min(best, cost.processor / thread_count());
  }
  return best;
}

double multiply_add_rate(const host::Device& on, Precision precision, bool fused) {
  const host::Kernel kernel = bench_kernel(on, "peak", precision, fused);
  const std::uint32_t invocations = on.info().kind == host::DeviceKind::cpu ? CPU_INVOCATIONS : GPU_INVOCATIONS;
  const host::Buffer sums(on, invocations * sizeof(double));
  const auto commands_of = [&](std::uint32_t turns) {
    host::Commands commands;
    commands.bind(BINDING_REAL_OUT, sums);
    commands.dispatch(kernel, host::groups_for(on, kernel, invocations), Push{invocations, 1024, 0, turns});
    return commands;
  };
  std::uint32_t turns = 16;
  host::run_once(on, commands_of(turns));  // with the driver's compilation
  while (turns < MOST_TURNS / 2 && host::run_once(on, commands_of(turns)) < TRY_SECONDS) turns *= 2;
  return 2.0 * PEAK_CHAINS * PEAK_STEPS * turns * invocations / best_computing_seconds(on, commands_of(turns));
}

}  // namespace

DevicePeak device_peak(const host::Device& on, Precision precision) {
  return {multiply_add_rate(on, precision, true), multiply_add_rate(on, precision, false)};
}

double device_copy_rate(const host::Device& on) {
  const host::Kernel kernel = bench_kernel(on, "copy", Precision::single);
  const std::size_t wanted = on.info().kind == host::DeviceKind::cpu ? CPU_COPY : GPU_COPY;
  const std::size_t bytes = std::min<std::size_t>({wanted, on.info().max_storage_range, on.info().memory / 4}) / 4096 * 4096;
  const host::Buffer from(on, bytes), to(on, bytes);
  const auto pieces = static_cast<std::uint32_t>(bytes / (COPY_WORDS * sizeof(std::uint32_t)));
  host::Commands commands;
  commands.bind(BINDING_GRIPS, from);
  commands.clear(BINDING_GRIPS);
  commands.bind(BINDING_REAL_OUT, to);
  commands.clear(BINDING_REAL_OUT);
  commands.dispatch(kernel, host::groups_for(on, kernel, pieces), Push{pieces, 0, 0, 0});
  host::run_once(on, commands);  // with the driver's compilation, and memory that is there
  return 2.0 * static_cast<double>(bytes) / best_seconds(on, commands.only(2));
}

}  // namespace wholehand::bench
