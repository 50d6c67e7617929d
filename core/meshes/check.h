// SPDX-License-Identifier: MIT
// Checks a mesh before it is used.
#pragma once

#include <string>

#include "core/mesh_body.h"
#include "core/meshes/triangles.h"

namespace wholehand {

// Triangles that share their corners, facing outward, and the findings.
struct CheckedMesh {
  TriangleMesh mesh;
  MeshFacts facts;
};

// Merges vertices that are equal in all three coordinates, drops triangles with coinciding corners and duplicates, closes holes if `close_holes` is
// set (core/meshes/holes.h), and turns triangles outward (core/meshes/orientation.h). `name` is for messages. Throws Error (usage) if a surface that
// faces outward encloses no volume, such as a flat sheet, or if a hole to be closed is neither flat nor small.
CheckedMesh check_mesh(const TriangleMesh& mesh, const std::string& name, bool close_holes = false);

// "93.92 cm3, center of mass (0, 39.14, 0) mm", to a hundredth of a millimeter; of m3 and m.
std::string filled_text(double volume, const Triple& center);

// The findings as one paragraph, with their consequences; ends without a line break.
std::string mesh_check_text(const MeshFacts& facts);

}  // namespace wholehand
