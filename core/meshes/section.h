// SPDX-License-Identifier: MIT
// The section of a mesh by an upright plane.
#pragma once

#include <array>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

// Lines of the surface in the plane through the y axis and the direction (cos, 0, sin) of the azimuth (rad): points (along that direction, y), m. A
// line that ends where it began has the same first and last point. What is inside lies on the same side of all lines.
std::vector<std::vector<std::array<double, 2>>> mesh_section(const TriangleMesh& mesh, double azimuth);

// The azimuth of the vertex that is farthest from the y axis, where a handle is.
double farthest_azimuth(const TriangleMesh& mesh);

}  // namespace wholehand
