// SPDX-License-Identifier: MIT
#include "tests/support/mesh_faults.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vectors.h"

namespace wholehand {

TriangleMesh in_unit(TriangleMesh mesh, double meters_per_unit) {
  for (Triple& p : mesh.vertices)
    for (double& x : p) x /= meters_per_unit;
  return mesh;
}

TriangleMesh z_up(TriangleMesh mesh) {
  for (Triple& p : mesh.vertices) p = {p[0], -p[2], p[1]};
  return mesh;
}

TriangleMesh lying(TriangleMesh mesh) {
  for (Triple& p : mesh.vertices) p = {p[1], -p[0], p[2]};
  return mesh;
}

TriangleMesh two_sided(TriangleMesh mesh) {
  const std::size_t fronts = mesh.triangles.size();
  for (std::size_t i = 0; i < fronts; ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    mesh.triangles.push_back({a, c, b});
  }
  return mesh;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  return mesh;
}

TriangleMesh unjoined(const TriangleMesh& mesh) {
  TriangleMesh loose;
  for (const Corners& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.vertices.size());
    for (const std::uint32_t corner : triangle) loose.vertices.push_back(mesh.vertices[corner]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  return loose;
}

TriangleMesh without_base(TriangleMesh mesh) {
  const auto is_on_ground = [&](const Corners& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t i) { return mesh.vertices[i][1] == 0; });
  };
  std::erase_if(mesh.triangles, is_on_ground);
  return mesh;
}

TriangleMesh with_hole(TriangleMesh mesh, const Triple& center, double radius) {
  const auto is_there = [&](const Corners& triangle) {
    Triple middle{};
    for (const std::uint32_t i : triangle)
      for (int k = 0; k < 3; ++k) middle[k] += mesh.vertices[i][k] / 3;
    return distance(middle, center) < radius;
  };
  std::erase_if(mesh.triangles, is_there);
  return mesh;
}

}  // namespace wholehand
