// SPDX-License-Identifier: MIT
#include "objects/triangles.h"

namespace wholehand {

bool is_point_or_edge(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Triple &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
  return a == b || b == c || c == a;
}

}  // namespace wholehand
