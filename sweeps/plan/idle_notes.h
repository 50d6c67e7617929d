// SPDX-License-Identifier: MIT
// What a scene asks for that changes nothing of what is computed, and what it leaves unjudged.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene.h"
#include "sweeps/plan/plan.h"

namespace wholehand {

// A line on [strength] in a scene without [tilts]: there are no states whose effort could be found. Empty in other scenes.
std::string idle_strength_note(const Scene& scene);

// A line for the terminal on what no grip is judged by, since the scene has no [table], [strength] or [tilts], or a single grip of each vessel. Empty
// in scenes
// that have all of them.
std::string unjudged_note(const Scene& scene, const Plan& plan);

// The first line, and one for each deviation of [robust] that changes no score: friction where no score depends on a force, azimuth
// about bodies of revolution, and all of them where the sweep lists no grips (`best` is 0).
std::vector<std::string> idle_notes(const Scene& scene, const Plan& plan, std::size_t best);

}  // namespace wholehand
