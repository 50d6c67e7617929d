// SPDX-License-Identifier: MIT
#include "device/session/amounts.h"

namespace wholehand::device {

double total_spilled(const Scene& scene, const Tick& tick) {
  double spilled = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) spilled += tick.spilled[v];
  return spilled;
}

double total_arrived(const Scene& scene, const Tick& tick, std::string_view liquid) {
  double arrived = 0;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v)
    if (scene.vessels[v].liquid_name == liquid) arrived += tick.arrived[v];
  return arrived;
}

std::vector<MixedAmount> mixing_board(const Scene& scene, const Tick& tick) {
  std::vector<MixedAmount> amounts;
  if (!scene.task) return amounts;
  for (const auto& [liquid, wanted] : scene.task->amounts) {
    MixedAmount amount{liquid, total_arrived(scene, tick, liquid), wanted, 0};
    for (std::size_t v = 0; v < scene.vessels.size(); ++v)
      if (scene.vessels[v].liquid_name == liquid) amount.spilled += tick.spilled[v];
    amounts.push_back(amount);
  }
  return amounts;
}

}  // namespace wholehand::device
