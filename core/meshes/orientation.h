// SPDX-License-Identifier: MIT
// Corrects which way the triangles of a mesh face.
#pragma once

#include <cstddef>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

// Numbers of dropped triangles.
struct DoubledTriangles {
  std::size_t copies = 0;  // that duplicate another one facing the same way
  std::size_t backs = 0;   // that face the other way
};

// Drops duplicate surfaces: flat patches with the same corners and the same rim, which may be cut into triangles in different ways. One that faces
// the same way is a copy. One that faces the other way is the back of a two-sided sheet, as in models for games. Such a pair stays if the mesh is
// closed without both: then it is the face between two touching bodies, or a wall within a body. `uses`: those of the mesh, which shares its corners;
// remade.
DoubledTriangles drop_doubled(TriangleMesh& mesh, std::vector<EdgeUse>& uses);

// Flips triangles until they turn consistently across every edge of exactly two triangles, as far as the surface has two sides. In each part that
// such edges join, the side with less area is flipped. `turned`: for each triangle, whether it was flipped.
void make_consistent(TriangleMesh& mesh, std::vector<EdgeUse>& uses, std::vector<bool>& turned);

// Turns whole parts of a consistent mesh outward. A closed part that lies within no other gets a positive volume. A part that lies within others
// keeps its orientation relative to them, so that a shell that faces the other way stays the wall of a cavity. Open parts turn together, by the sign
// of their volume with each hole closed by a cone to `rim`.
void turn_outward(TriangleMesh& mesh, std::vector<EdgeUse>& uses, const Triple& rim, std::vector<bool>& turned);

}  // namespace wholehand
