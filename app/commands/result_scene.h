// SPDX-License-Identifier: MIT
// The scene that a result file's own text describes.
#pragma once

#include <string>

#include "core/scene.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand {

// Whether the file is NetCDF-4, as results are; neither scenes nor recordings are.
bool is_result(const std::string& path);

// The result's scene with its meshes, searched for beside the result, then from where the scene lay. `trouble`: why they are no longer
// those of the sweep, "" where they are. Throws Error (usage) where the text is no scene.
Scene scene_of_result(const SweepResult& result, std::string& mesh_error);

// The same for what cannot do without the meshes: throws Error (usage) with the trouble.
Scene whole_scene_of_result(const SweepResult& result);

}  // namespace wholehand
