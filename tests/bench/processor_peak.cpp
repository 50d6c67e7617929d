// SPDX-License-Identifier: MIT
#include "tests/bench/processor_peak.h"

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <barrier>
#include <cstring>
#include <functional>
#include <numeric>
#include <thread>
#include <vector>

#include "tests/bench/cost.h"
#include "tests/bench/peak/multiply_add.h"

namespace wholehand::bench {
namespace {

constexpr int TRIES = 5;
constexpr double TRY_SECONDS = 0.04;
constexpr std::size_t LEAST_COPY = std::size_t(64) << 20, LARGEST_COPY = std::size_t(512) << 20;  // bytes of an array
constexpr int COPIES = 3;                                                                         // in a try

struct InstructionSet {
  const char* name;
  MultiplyAdds run;
};

std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets{{"16-byte vectors", vector_multiply_adds()}};
#ifdef WHOLEHAND_PEAK_X86
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) sets.push_back({"AVX2 with FMA", avx2_multiply_adds()});
  if (__builtin_cpu_supports("avx512f")) sets.push_back({"AVX-512", avx512_multiply_adds()});
#endif
  return sets;
}

// Seconds until the last of the threads is done, which begin together.
double seconds_of_threads(int threads, const std::function<void(int)>& work) {
  std::barrier ready(threads + 1);
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i)
    workers.emplace_back([&, i] {
      ready.arrive_and_wait();
      work(i);
    });
  return cost_of([&] {
           ready.arrive_and_wait();
           for (std::thread& worker : workers) worker.join();
         })
      .wall;
}

// Operations a second of one thread among others that do the same.
double own_rate(MultiplyAdd multiply_adds, std::uint64_t turns) {
  double sum = 0;
  const double before = processor_seconds(CLOCK_THREAD_CPUTIME_ID);
  const double operations = multiply_adds(turns, sum);
  benchmark::DoNotOptimize(sum);
  return operations / (processor_seconds(CLOCK_THREAD_CPUTIME_ID) - before);
}

double rate_of(MultiplyAdd multiply_adds, int threads) {
  double sum = 0;
  std::uint64_t turns = 1 << 12;
  while (cost_of([&] { multiply_adds(turns, sum); }).processor < TRY_SECONDS) turns *= 2;
  benchmark::DoNotOptimize(sum);
  double best = 0;
  for (int k = 0; k < TRIES; ++k) {
    std::vector<double> rates(static_cast<std::size_t>(threads));
    seconds_of_threads(threads, [&](int i) { rates[static_cast<std::size_t>(i)] = own_rate(multiply_adds, turns); });
    best = std::max(best, std::accumulate(rates.begin(), rates.end(), 0.0));
  }
  return best;
}

MultiplyAdd of_precision(const MultiplyAdds& run, Precision precision) {
  return precision == Precision::single ? run.in_float : run.in_double;
}

}  // namespace

ProcessorPeak processor_peak(Precision precision, int threads) {
  ProcessorPeak peak;
  for (const InstructionSet& set : instruction_sets()) {
    const double rate = rate_of(of_precision(set.run, precision), threads);
    if (rate > peak.operations) peak = {set.name, rate};
  }
  return peak;
}

ProcessorPeak scalar_peak(Precision precision, int threads) {
  return {"scalar", rate_of(of_precision(scalar_multiply_adds(), precision), threads)};
}

double processor_copy_rate(int threads) {
  const long cache = std::max(0L, sysconf(_SC_LEVEL3_CACHE_SIZE));
  const std::size_t bytes = std::clamp(std::size_t{2} * static_cast<std::size_t>(cache), LEAST_COPY, LARGEST_COPY);
  const std::size_t part = bytes / static_cast<std::size_t>(threads);
  std::vector<char> from(bytes, 1), to(bytes, 2);
  double best = 0;
  for (int k = 0; k < TRIES; ++k) {
    const double seconds = seconds_of_threads(threads, [&](int i) {
      for (int copy = 0; copy < COPIES; ++copy) {
        std::memcpy(to.data() + static_cast<std::size_t>(i) * part, from.data() + static_cast<std::size_t>(i) * part, part);
        benchmark::ClobberMemory();
      }
    });
    best = std::max(best, 2.0 * COPIES * static_cast<double>(part) * threads / seconds);
  }
  return best;
}

}  // namespace wholehand::bench
