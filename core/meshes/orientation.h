// SPDX-License-Identifier: MIT
// Which way the triangles of a mesh face, made what it should be.
#pragma once

#include <cstddef>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

// How many triangles were left out.
struct DoubledTriangles {
  std::size_t copies = 0;  // that face as another one upon which they lie
  std::size_t backs = 0;   // that face the other way
};

// Leaves out what lies upon another part of the surface: flat patches with the same corners and the same rim, which may be cut into triangles
// in different ways. One that faces the same way is a copy. One that faces the other way is the back of a sheet with two sides, as models for
// games have. It stays where the mesh is closed without both: that is the face between two bodies that touch, or a wall within a body.
// `uses`: those of the mesh, which shares its corners; made anew.
DoubledTriangles drop_doubled(TriangleMesh& mesh, std::vector<EdgeUse>& uses);

// Turns triangles until they turn the same way over every edge of exactly two triangles, as far as the surface has two sides. In each part
// that such edges join, the side with less area turns. `turned`: of each triangle, whether it is the other way round than it was.
void make_consistent(TriangleMesh& mesh, std::vector<EdgeUse>& uses, std::vector<bool>& turned);

// Turns whole parts of a consistent mesh outward. A closed part that lies within no other one encloses a positive volume. One that lies
// within others keeps how it faces relative to them, so that a shell that faces the other way stays the wall of a cavity. Open parts turn all
// together, by the sign of their volume with each hole closed by a cone to `rim`.
void turn_outward(TriangleMesh& mesh, std::vector<EdgeUse>& uses, const Triple& rim, std::vector<bool>& turned);

}  // namespace wholehand
