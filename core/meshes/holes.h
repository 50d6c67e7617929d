// SPDX-License-Identifier: MIT
// Finds and closes small holes of a mesh.
#pragma once

#include <cstddef>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

// The largest hole that is closed, as a share of the mesh's largest extent: across, and along its edge.
constexpr double SMALL_HOLE = 0.1, SMALL_HOLE_EDGE = 0.4;

// A loop of open edges.
struct MeshHole {
  std::vector<std::uint32_t> corners;  // vertices in the order of an outward-facing triangle that fills it
  double across = 0;                   // diagonal of its bounding box, m
  double length = 0;                   // of its edges, m
};

struct MeshHoles {
  std::vector<MeshHole> loops;
  std::size_t loose_edges = 0;  // open edges that are not part of a loop: their triangles turn opposite ways
};

// The holes of a mesh whose triangles share their corners. A loop that meets itself at a vertex counts as two.
MeshHoles find_holes(const TriangleMesh& mesh);

// `extent`: the mesh's largest, m.
bool is_small_hole(const MeshHole& hole, double extent);

// Closes it with a triangle, or with a fan about the mean of its corners, which becomes a vertex. The new triangles face as their neighbors do.
void close_hole(const MeshHole& hole, TriangleMesh& mesh);

}  // namespace wholehand
