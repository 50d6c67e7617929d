// SPDX-License-Identifier: MIT
// Level rings along which a mesh turns sharply, such as rim, base, the edge of an inner floor or the foot of a neck.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/meshes/check.h"

namespace wholehand {

struct LevelRings {
  std::vector<double> levels;  // m, ascending: where the surface turns inward; a body of revolution is best cut there first
  glm::dvec3 axis{};           // a point of the upright line through the middle of the longest ring; the origin without rings
};

// Rings of 60 mm and more.
LevelRings level_rings(const CheckedMesh& mesh);

}  // namespace wholehand
