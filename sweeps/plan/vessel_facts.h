// SPDX-License-Identifier: MIT
// The grip-independent facts of vessels in a result file.
#pragma once

#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"

namespace wholehand::sweeps {

// Facts of a vessel that no grip changes.
struct VesselFacts {
  double capacity = 0;               // m3, upright to the brim
  double empty_mass = 0;             // kg
  Triple empty_center_of_mass{};     // vessel frame, m
  std::vector<double> pouring_tilt;  // per fill, rad; empty without liquid
  std::vector<LiquidResult> liquid;  // fill-major over the tilts; empty without liquid or tilts
};

// Facts of every vessel: the table of liquid from the backend, the rest from the core. Throws Error (failure) if the table does not match the scene's
// fills and tilts.
std::vector<VesselFacts> vessel_facts(const Scene& scene, Backend& backend, const Evaluator& evaluator);

}  // namespace wholehand::sweeps
