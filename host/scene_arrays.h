// SPDX-License-Identifier: MIT
// A scene as the arrays that shaders read (layout.h's bindings), in double; converted to the shader's reals on upload.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/evaluator.h"
#include "core/prepare.h"
#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand::host {

// LOAD_STRIDE numbers describe a load: its mass, the liquid's share of the mass, and that share times the lean and the height of the liquid's
// center of mass.
constexpr int LOAD_STRIDE = 4;

struct VesselArrays {
  Parameters<double> parameters{};
  std::vector<double> outline;                                // OUTLINE_STRIDE an element
  std::shared_ptr<const std::vector<std::uint32_t>> lattice;  // samples as layout.h has them, x fastest; null for an outline
  bool halves = false;                                        // .. two to a word
  std::vector<LiquidResult> liquid;                           // of every fill and tilt, fill-major; empty without liquid
  std::vector<double> loads;                                  // LOAD_STRIDE for each of them, or for each tilt without liquid
  std::vector<std::size_t> counted_tilts;                     // at each fill, from the first tilt on; the others are left out
  int outline_count = 0;
};

struct SceneArrays {
  std::vector<double> hand;   // 4 * HAND_VECTORS
  std::vector<double> tilts;  // sine, cosine, tilt
  std::vector<VesselArrays> vessels;
};

// `core` evaluates the same scene with the same options. Liquids, masses, references and lattices come from it.
SceneArrays make_scene_arrays(const Scene& scene, const Evaluator& core, const EvaluatorOptions& options = {});

// States as the effort kernel reads them, STATE_STRIDE each: those that can be the worst, and all that count.
struct EffortStates {
  std::vector<double> worst, safe;
};
EffortStates effort_states(const Scene& scene, std::size_t v, const VesselArrays& vessel);

// A parameter block in the shader's reals.
template <class Real>
Parameters<Real> convert(const Parameters<double>& from);

}  // namespace wholehand::host
