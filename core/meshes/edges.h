// SPDX-License-Identifier: MIT
// Where the triangles of a body meet, for whatever draws it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh_body.h"

namespace wholehand {

constexpr std::uint32_t NO_TRIANGLE = ~0u;
constexpr double CREASE_ANGLE = radians(30);  // between the normals of two triangles: from there on their edge is seen

struct MeshEdge {
  std::uint32_t from = 0, to = 0;  // vertices
  // Triangles: `left` runs from `from` to `to`, `right` back. No right one where the edge is open, belongs to more than two triangles
  // (there is then an edge for each), or to two that turn the same way.
  std::uint32_t left = 0, right = NO_TRIANGLE;
  bool is_crease = false;  // it has a right one, at CREASE_ANGLE or more
};

// Each edge once, and the unit normal of each triangle: of one without area that of its neighbor across its longest edge, zero where that
// has none either.
struct MeshEdges {
  std::vector<MeshEdge> edges;
  std::vector<Triple> normals;
  bool has_open = false;  // an edge without a right triangle
};

MeshEdges find_edges(const MeshBody& body);

}  // namespace wholehand
