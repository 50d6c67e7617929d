// SPDX-License-Identifier: MIT
#include "sweeps/plan/vessel_facts.h"

#include <fmt/format.h>

#include "base/text/error.h"
#include "core/capacity.h"

namespace wholehand::sweeps {

std::vector<VesselFacts> vessel_facts(const Scene& scene, Backend& backend, const Evaluator& evaluator) {
  std::vector<VesselFacts> facts(scene.vessels.size());
  for (std::size_t v = 0; v < facts.size(); ++v) {
    facts[v].capacity = scene.liquid ? evaluator.capacity(v) : capacity_of(scene.vessels[v]);
    facts[v].empty_mass = evaluator.empty_mass(v);
    facts[v].empty_center_of_mass = evaluator.empty_center_of_mass(v);
    if (!scene.liquid) continue;
    for (const double fill : vessel_fills(scene, scene.vessels[v]))
      facts[v].pouring_tilt.push_back(evaluator.pouring_tilt(v, fill));
    if (scene.tilts.empty()) continue;
    facts[v].liquid = backend.liquid(v);
    if (facts[v].liquid.size() != scene_fills(scene) * scene.tilts.size()) {
      throw failure_error(fmt::format("{}: gave {} states of liquid instead of {}", backend.info().device, facts[v].liquid.size(),
                                      scene_fills(scene) * scene.tilts.size()));
    }
  }
  return facts;
}

}  // namespace wholehand::sweeps
