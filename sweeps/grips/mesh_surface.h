// SPDX-License-Identifier: MIT
// A mesh vessel's body with normals, as viewers shade it.
#pragma once

#include "core/mesh_body.h"
#include "sweeps/grips/surface.h"

namespace wholehand::sweeps {

// The body's triangles in order. Across edges that are not creases (core/meshes/edges.h), corners share a position and its normal, the mean of the
// triangles' weighted by their angles. At creases, open edges, and where more than two triangles meet, positions are repeated.
SurfaceMesh mesh_surface(const MeshBody& body);

}  // namespace wholehand::sweeps
