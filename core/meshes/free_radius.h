// SPDX-License-Identifier: MIT
// How far level rays from an upright axis reach before they meet a mesh.
#pragma once

#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

constexpr int RAY_AZIMUTHS = 360;

// The free radii at one height, m, one per azimuth 2 PI k / RAY_AZIMUTHS from x to z; infinite where nothing is met.
using FreeRadii = std::vector<double>;

// The free radii about the axis through (x, z), m, at each height (m, ascending).
std::vector<FreeRadii> free_radii(const TriangleMesh& mesh, double x, double z, const std::vector<double>& heights);

// The least distance of the mesh from that axis at each height (m, ascending), between the rays too, m; infinite where there is no mesh.
std::vector<double> least_radii(const TriangleMesh& mesh, double x, double z, const std::vector<double>& heights);

// Heights, m, at which an upright line meets the mesh, ascending.
std::vector<double> heights_on_line(const TriangleMesh& mesh, double x, double z);

}  // namespace wholehand
