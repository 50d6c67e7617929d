// SPDX-License-Identifier: MIT
// Reports where a haptic loop, and the kernels, stop being trustworthy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/text/error.h"
#include "evidence/check/extreme.h"

namespace wholehand {

struct StabilityOptions {
  std::string folder;         // made if missing; files in it are replaced, each as a whole
  std::string on = "vulkan";  // core, or a device beside it for the extreme scenes
  bool quick = false;         // under a minute on two cores
  std::uint64_t seed = 1;     // for the random devices and walls
  std::vector<ExtremeCase> extremes;
};

// Writes into the folder
//   wall.csv, wall_limits.csv, wall.svg, wall_integrators.svg   the rendered wall
//   grip_loop.csv, grip_loop.svg                                the held grip
//   extreme.csv                                                 the extreme scenes
//   stability.md                                                what is safe, in words; printed too
// Exit `no` where a passive wall does not settle, a value is missing that must be there, or double on the device is not the core's.
// Throws Error: no such device, a folder that cannot be written.
ExitCode run_stability(const StabilityOptions& options);

}  // namespace wholehand
