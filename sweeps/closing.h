// What a sweep says before and after its work.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/backend.h"
#include "sweeps/plan.h"

namespace wholehand {

// Where the time of a sweep went, s. What remains of the wall time is everything else.
struct SweepTimes {
  double wall = 0;
  double kernels = 0;  // that was waited for
  double writing = 0;  // of values, syncing included
  std::uint64_t written_bytes = 0;
};

// Grips and states, device, driver and precision, what is left out.
std::string opening_lines(const Scene& scene, const Plan& plan, const BackendInfo& info);

// The files with the size of the first, the times, and what the process took: CPU seconds and its largest memory.
std::string closing_lines(const std::vector<std::string>& files, const SweepTimes& times);

}  // namespace wholehand
