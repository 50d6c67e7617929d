// SPDX-License-Identifier: MIT
// Notes on what a scene requests without any effect, and on criteria that it lacks.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene.h"
#include "sweeps/plan/plan.h"

namespace wholehand::sweeps {

// A line on [strength] in a scene without [tilts]: no states exist whose effort could be found. Empty in other scenes.
std::string idle_strength_note(const Scene& scene);

// A line for the terminal on missing criteria, if the scene has no [table], [strength] or [tilts], or a single grip of each vessel. Empty in scenes
// that have everything.
std::string unjudged_note(const Scene& scene, const Plan& plan);

// The first line, and one for each deviation of [robust] that changes no score: friction if no score depends on a force, azimuth for bodies of
// revolution, and all of them if the sweep lists no grips (`best` is 0).
std::vector<std::string> idle_notes(const Scene& scene, const Plan& plan, std::size_t best);

}  // namespace wholehand::sweeps
