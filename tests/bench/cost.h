// SPDX-License-Identifier: MIT
// What a piece of work costs.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>

namespace wholehand::bench {

// Seconds that this process has had of all processors; or this thread of one (CLOCK_THREAD_CPUTIME_ID). getrusage() would be some
// milliseconds late for what runs at the moment.
inline double processor_seconds(clockid_t clock = CLOCK_PROCESS_CPUTIME_ID) {
  timespec used{};
  clock_gettime(clock, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
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

inline Cost least_of(const Cost& a, const Cost& b) { return {std::min(a.wall, b.wall), std::min(a.processor, b.processor)}; }

// The least of some tries, of either.
template <class Work>
Cost best_cost(int tries, const Work& work) {
  Cost best = cost_of(work);
  for (int k = 1; k < tries; ++k) best = least_of(best, cost_of(work));
  return best;
}

}  // namespace wholehand::bench
