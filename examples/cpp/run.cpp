// SPDX-License-Identifier: MIT
// sweeps/run/run.h: what `wholehand sweep` does, with its files and what it prints.
#include <cstdio>
#include <filesystem>

#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/run/run.h"

int main() {
  using namespace wholehand;
  const ExitCode code = sweeps::run_sweep(read_scene_file(find_scene("small")), {.output = "swept.nc", .on = "core"});
  std::printf("swept.nc has %llu bytes\n", static_cast<unsigned long long>(std::filesystem::file_size("swept.nc")));
  return code == ExitCode::done ? 0 : 1;
}
