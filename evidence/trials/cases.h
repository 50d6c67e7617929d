// SPDX-License-Identifier: MIT
// Which states of a vessel are tried.
#pragma once

#include <cstddef>
#include <vector>

#include "core/evaluator.h"
#include "core/scene.h"
#include "evidence/trials/options.h"

namespace wholehand {

constexpr int FORCE_DIRECTIONS = 6;
extern const std::array<const char*, FORCE_DIRECTIONS> FORCE_DIRECTION_NAMES;  // "+x" ..

// Where nothing is asked for: of the scene's fills above 0 the first, the middle one and the last. One fill, 0, of a scene
// without liquid and of a vessel that holds none.
std::vector<double> usual_fills(const Scene& scene, const Evaluator& core, std::size_t vessel);

// Where nothing is asked for: four of the scene's tilts, the first, the last and two between them, or all where there are fewer.
std::vector<double> usual_tilts(const Scene& scene);

// The cases of a vessel, in the order of the table: fills with ascending tilts, then for each material the six directions at the
// largest of the fills. Where no tilts are asked for, a fill has only those that count (core/counted_tilts.h).
// Throws Error (usage): fills are asked for, and the vessel holds no liquid.
std::vector<TrialCase> trial_cases(const Scene& scene, const Evaluator& core, std::size_t vessel, const TrialOptions& options);

}  // namespace wholehand
