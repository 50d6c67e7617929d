// SPDX-License-Identifier: MIT
// The picture of a surveyed mesh.
#pragma once

#include <string>

#include "core/meshes/survey.h"

namespace wholehand::sweeps {

// An SVG of the section through the cavity's axis and the farthest point of the mesh, to scale: the walls, the inner outline, and the liquid at half
// of what the outline holds.
std::string vessel_section(const MeshSurvey& survey, const std::string& title);

}  // namespace wholehand::sweeps
