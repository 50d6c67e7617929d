// SPDX-License-Identifier: MIT
// The states of a vessel that are tried.
#pragma once

#include <cstddef>
#include <vector>

#include "core/evaluator.h"
#include "core/scene.h"
#include "evidence/trials/options.h"

namespace wholehand {

constexpr int FORCE_DIRECTIONS = 6;
extern const std::array<const char*, FORCE_DIRECTIONS> FORCE_DIRECTION_NAMES;  // "+x" ..

// By default: of the scene's fills above 0 the first, the middle one and the last. One fill, 0, for a scene without liquid and for a vessel that
// holds none.
std::vector<double> usual_fills(const Scene& scene, const Evaluator& core, std::size_t vessel);

// By default: four of the scene's tilts, the first, the last and two between them, or all if there are fewer.
std::vector<double> usual_tilts(const Scene& scene);

// The cases of a vessel, in the order of the table: fills with ascending tilts, then for each material the six directions at the largest fill. By
// default, a fill has only the tilts that count (core/counted_tilts.h). Throws Error (usage): fills are requested, and the vessel holds no liquid.
std::vector<TrialCase> trial_cases(const Scene& scene, const Evaluator& core, std::size_t vessel, const TrialOptions& options);

}  // namespace wholehand
