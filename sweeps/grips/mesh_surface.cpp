// SPDX-License-Identifier: MIT
#include "sweeps/grips/mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numeric>

#include "core/meshes/edges.h"
#include "core/vectors.h"

namespace wholehand::sweeps {
namespace {

// Corners of triangles, 3 t + k, in sets that share a position of the surface.
class CornerSets {
 public:
  explicit CornerSets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0u); }
  std::uint32_t set_of(std::uint32_t corner) {
    while (above_[corner] != corner) corner = above_[corner] = above_[above_[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) { above_[set_of(a)] = set_of(b); }

 private:
  std::vector<std::uint32_t> above_;
};

std::uint32_t corner_at(const MeshBody& body, std::uint32_t triangle, std::uint32_t vertex) {
  const auto& corners = body.triangles[triangle];
  return 3 * triangle + static_cast<std::uint32_t>(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
}

// The angle of a triangle at its k-th corner, rad; 0 where it has no area.
double corner_angle(const MeshBody& body, std::uint32_t triangle, int k) {
  const auto point = [&](int n) { return to_vec3(body.vertices[body.triangles[triangle][n % 3]]); };
  const glm::dvec3 a = point(k + 1) - point(k), b = point(k + 2) - point(k);
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

Triple unit_or(const Triple& v, const Triple& other) {
  const double length = norm(v);
  if (length > 1e-9) return {v[0] / length, v[1] / length, v[2] / length};
  return other != Triple{} ? other : Triple{0, 1, 0};
}

}  // namespace

SurfaceMesh mesh_surface(const MeshBody& body) {
  const MeshEdges found = find_edges(body);
  CornerSets sets(3 * body.triangles.size());
  for (const MeshEdge& edge : found.edges) {
    if (edge.right == NO_TRIANGLE || edge.is_crease) continue;
    for (const std::uint32_t vertex : {edge.from, edge.to})
      sets.join(corner_at(body, edge.left, vertex), corner_at(body, edge.right, vertex));
  }
  SurfaceMesh surface;
  std::vector<std::uint32_t> position_of(3 * body.triangles.size(), NO_TRIANGLE);
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& position = position_of[sets.set_of(3 * t + k)];
      if (position == NO_TRIANGLE) {
        position = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.push_back(body.vertices[body.triangles[t][k]]);
        surface.normals.push_back({});
      }
      surface.triangles.push_back(position);
      const double angle = corner_angle(body, t, k);
      for (int axis = 0; axis < 3; ++axis) surface.normals[position][axis] += angle * found.normals[t][axis];
    }
  }
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    Triple& normal = surface.normals[surface.triangles[i]];
    normal = unit_or(normal, found.normals[i / 3]);
  }
  return surface;
}

}  // namespace wholehand::sweeps
