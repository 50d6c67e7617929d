// SPDX-License-Identifier: MIT
#include "core/meshes/triangles.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace wholehand {

bool is_point_or_edge(const TriangleMesh& mesh, const Corners& triangle) {
  const Triple &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
  return a == b || b == c || c == a;
}

double single_rounding(const Triple& point) {
  return 0x1p-24 * std::max({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
}

std::vector<EdgeUse> edge_uses(const std::vector<Corners>& triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      uses.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return uses;
}

}  // namespace wholehand
