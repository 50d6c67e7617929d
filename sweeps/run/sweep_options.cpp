// SPDX-License-Identifier: MIT
#include "sweeps/run/sweep_options.h"

namespace wholehand {

std::string default_output(const Scene& scene) {
  std::string stem = scene.file.substr(scene.file.rfind('/') + 1);
  if (stem.ends_with(".toml")) stem.resize(stem.size() - 5);
  return (stem.empty() ? "sweep" : stem) + ".nc";
}

}  // namespace wholehand
