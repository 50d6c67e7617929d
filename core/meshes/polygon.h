// SPDX-License-Identifier: MIT
// Cuts a flat polygon, with or without holes, into triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

struct PolygonCorner {
  double x = 0, y = 0;
  std::uint32_t vertex = 0;  // of a mesh; no two corners of a polygon have the same place and different vertices
};
using PolygonLoop = std::vector<PolygonCorner>;  // at least three corners

// Whether `p` lies within the loop; a point on it may count either way.
bool is_within(const PolygonLoop& loop, const PolygonCorner& p);

// Cuts the polygon between `outer`, which runs counter-clockwise, and the loops within it, which run clockwise and apart from each other, into
// counter-clockwise triangles (ear clipping; inner loops are first joined with the outer one by bridges, Eberly 2002). The triangles have the loops'
// corners and no others: n + 2 h - 2 triangles for n corners and h inner loops. Each edge of a loop belongs to one of them. That holds even if loops
// cross; then triangles overlap. Takes quadratic time.
std::vector<Corners> cut_polygon(const PolygonLoop& outer, std::vector<PolygonLoop> inner = {});

}  // namespace wholehand
