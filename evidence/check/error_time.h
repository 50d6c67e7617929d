// SPDX-License-Identifier: MIT
// Measures what every shortcut costs in error and gains in time: what `wholehand error-time` does.
#pragma once

#include <cstdint>
#include <string>

#include "base/text/error.h"
#include "core/scene.h"

namespace wholehand {

struct ErrorTimeOptions {
  std::string output;         // folder
  std::string on = "vulkan";  // see open_backend; "core": no device
  bool quick = false;
  std::uint64_t seed = 1;
  int threads = 0;  // for the core; 0: all
};

// Writes error-time.csv, its grips, error-time.md and pictures into the folder, each whole or not at all, and prints the report. Throws Error.
ExitCode run_error_time(const Scene& scene, const ErrorTimeOptions& options);

}  // namespace wholehand
