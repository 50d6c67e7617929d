// SPDX-License-Identifier: MIT
// The files beside a result: which are a sweep's own, and what may not be written over.
#pragma once

#include <string>

#include "sweeps/plan/plan.h"
#include "sweeps/result/output_names.h"

namespace wholehand {

// Whether NAME.best.csv is there and a sweep wrote it.
bool is_best_list(const std::string& path);

// Throws Error (usage) where one of the files that a sweep writes beside its result is there and is not of a sweep, or is the scene or a mesh of it.
// `best`, `pictures`: whether the list and the heat maps are written; `glb`: grips of each vessel.
void check_companions(const Scene& scene, const OutputNames& names, bool best, bool pictures, int glb);

// The glTF files alone, for those who write nothing else beside: the first `glb` of each list of best grips.
void check_best_glb(const Scene& scene, const Plan& plan, const OutputNames& names, int glb);

}  // namespace wholehand
