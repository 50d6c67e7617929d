// SPDX-License-Identifier: MIT
// What a piece of work costs.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <chrono>

namespace wholehand::bench {

// Seconds that this process has had of all processors; or this thread of one (RUSAGE_THREAD).
inline double processor_seconds(__rusage_who who = RUSAGE_SELF) {
  rusage used{};
  getrusage(who, &used);
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

struct Cost {
  double wall = 0, processor = 0;  // seconds: by the clock, and of all processors together
};

template <class Work>
Cost cost_of(const Work& work) {
  const double used = processor_seconds();
  const auto start = std::chrono::steady_clock::now();
  work();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {wall, processor_seconds() - used};
}

// The least of some tries, of either.
template <class Work>
Cost best_cost(int tries, const Work& work) {
  Cost best = cost_of(work);
  for (int k = 1; k < tries; ++k) {
    const Cost cost = cost_of(work);
    best = {std::min(best.wall, cost.wall), std::min(best.processor, cost.processor)};
  }
  return best;
}

}  // namespace wholehand::bench
