// SPDX-License-Identifier: MIT
// Grips that provoke errors: at the ends of every range, on features of a vessel and a rounding beside them, along its axis, of
// the smallest numbers there are; and others drawn from all of the range.
#pragma once

#include <functional>
#include <vector>

#include "core/scene.h"
#include "evidence/check/compare.h"
#include "tests/support/scenes.h"

namespace wholehand {

// `count` grips of one vessel of a scene, the same for the same seed, all within what a scene file may ask for.
std::vector<GripInput> adversarial_grips(const Scene& scene, std::size_t vessel, std::size_t count, std::uint64_t seed);

// Scenes that between them take every branch: shapes, shells, poses, hands of either side, torques and references, fills and tilts
// at their ends, no friction, no torsion.
std::vector<Scene> adversarial_scenes();

// How many grips a search evaluates: `portion`, or WHOLEHAND_SEARCH_GRIPS of the environment for all of it (10,000,000 take the core
// some minutes).
std::size_t search_grips(std::size_t portion);

struct Searched {
  std::size_t grips = 0, feasible = 0, not_converged = 0, unsettled = 0;
};

// Gives every vessel of every adversarial scene its share of the grips. `make` gives, for a scene, what evaluates grips of one of
// its vessels. The first value that is not finite where it must be fails the test and ends the search.
using Answer = std::function<GatheredPlanes(std::size_t vessel, const std::vector<GripInput>& grips)>;
Searched search(std::size_t grips, const std::function<Answer(const Scene&)>& make);

}  // namespace wholehand
