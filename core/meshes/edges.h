// SPDX-License-Identifier: MIT
// Edges between the triangles of a body, for drawings.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh_body.h"

namespace wholehand {

constexpr std::uint32_t NO_TRIANGLE = ~0u;
constexpr double CREASE_ANGLE = radians(30);  // between the normals of two triangles; from this angle on, their edge is drawn

struct MeshEdge {
  std::uint32_t from = 0, to = 0;  // vertices
  // Triangles: `left` runs from `from` to `to`, `right` back. An edge has no right triangle if it is open, belongs to more than two triangles (then
  // each has an edge), or to two that turn the same way.
  std::uint32_t left = 0, right = NO_TRIANGLE;
  bool is_crease = false;  // has a right triangle, at CREASE_ANGLE or more
};

// Each edge once, and the unit normal of each triangle. A triangle without area gets the normal of its neighbor across its longest edge, or zero if
// that has none either.
struct MeshEdges {
  std::vector<MeshEdge> edges;
  std::vector<Triple> normals;
  bool has_open = false;  // an edge without a right triangle
};

MeshEdges find_edges(const MeshBody& body);

}  // namespace wholehand
