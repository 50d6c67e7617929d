// SPDX-License-Identifier: MIT
// Reads the scene from a result file's own text.
#pragma once

#include <string>

#include "core/scene.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand {

// Whether the file is NetCDF-4, as results are; neither scenes nor recordings are.
bool is_result(const std::string& path);

// The result's scene with its meshes, searched for beside the result, then at the scene's former place. `mesh_error`: why they are no longer the
// sweep's, "" if they are. Throws Error (usage) if the text is not a scene.
Scene scene_of_result(const sweeps::SweepResult& result, std::string& mesh_error);

// The same for callers that need the meshes: throws Error (usage) with that reason.
Scene whole_scene_of_result(const sweeps::SweepResult& result);

}  // namespace wholehand
