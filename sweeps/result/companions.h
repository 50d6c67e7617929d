// SPDX-License-Identifier: MIT
// The files beside a result: which belong to a sweep, and which must not be overwritten.
#pragma once

#include <string>

#include "sweeps/plan/plan.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {

// Whether NAME.best.csv exists and a sweep wrote it.
bool is_best_list(const std::string& path);

// Throws Error (usage) if a file that a sweep writes beside its result exists and is not a sweep's, or is the scene or one of its meshes. `best`,
// `pictures`: whether the list and the heat maps are written; `glb`: grips of each vessel.
void check_companions(const Scene& scene, const OutputNames& names, bool best, bool pictures, int glb);

// Only the glTF files, for commands that write nothing else: the first `glb` of each list of best grips.
void check_best_glb(const Scene& scene, const Plan& plan, const OutputNames& names, int glb);

}  // namespace wholehand::sweeps
