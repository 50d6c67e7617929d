// SPDX-License-Identifier: MIT
#include "core/meshes/edges.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>

#include "core/meshes/triangles.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

constexpr double NO_AREA = 1e-12;  // height of a triangle, of its longest edge: below it, rounding

glm::dvec3 vertex_of(const MeshBody& body, std::uint32_t vertex) { return to_vec3(body.vertices[vertex]); }

double length_of(const MeshBody& body, const MeshEdge& edge) {
  return glm::length(vertex_of(body, edge.to) - vertex_of(body, edge.from));
}

std::vector<MeshEdge> join_uses(const std::vector<EdgeUse>& uses) {
  std::vector<MeshEdge> edges;
  const auto add = [&](const EdgeUse& use, std::uint32_t right) {
    edges.push_back({use.is_forward ? use.low : use.high, use.is_forward ? use.high : use.low, use.triangle, right, false});
  };
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && edge[0].is_forward != edge[1].is_forward) {
      add(edge[0], edge[1].triangle);
    } else {
      for (const EdgeUse& use : edge) add(use, NO_TRIANGLE);
    }
  });
  return edges;
}

// Zero for a triangle without area.
std::vector<Triple> triangle_normals(const MeshBody& body) {
  std::vector<Triple> normals;
  normals.reserve(body.triangles.size());
  for (const auto& [i, j, k] : body.triangles) {
    const glm::dvec3 a = vertex_of(body, i), b = vertex_of(body, j), c = vertex_of(body, k), normal = glm::cross(b - a, c - a);
    const double doubled = glm::length(normal), edge = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    const glm::dvec3 unit = doubled > NO_AREA * edge * edge ? normal / doubled : glm::dvec3(0);
    normals.push_back(to_triple(unit));
  }
  return normals;
}

// A triangle without area lies in a seam: it takes its longest edge's other side's normal, and is then no crease there.
void borrow_normals(const MeshBody& body, MeshEdges& found) {
  std::vector<double> longest(body.triangles.size());
  const std::vector<Triple> own = found.normals;
  for (const MeshEdge& edge : found.edges) {
    if (edge.right == NO_TRIANGLE) continue;
    const double length = length_of(body, edge);
    for (const auto& [triangle, other] : {std::pair{edge.left, edge.right}, std::pair{edge.right, edge.left}}) {
      if (own[triangle] != Triple{} || !(length > longest[triangle])) continue;
      longest[triangle] = length;
      found.normals[triangle] = own[other];
    }
  }
}

}  // namespace

MeshEdges find_edges(const MeshBody& body) {
  MeshEdges found{join_uses(edge_uses(body.triangles)), triangle_normals(body), false};
  borrow_normals(body, found);
  for (MeshEdge& edge : found.edges) {
    if (edge.right == NO_TRIANGLE) {
      found.has_open = true;
      continue;
    }
    const Triple &a = found.normals[edge.left], &b = found.normals[edge.right];
    edge.is_crease = dot(a, b) < std::cos(CREASE_ANGLE) && a != Triple{} && b != Triple{};
  }
  return found;
}

}  // namespace wholehand
