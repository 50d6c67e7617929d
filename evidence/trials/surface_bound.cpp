// SPDX-License-Identifier: MIT
#include "evidence/trials/surface_bound.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <queue>

#include "core/vectors.h"

namespace wholehand {
namespace {

glm::dvec3 center_of(const Facet& facet) { return (facet[0] + facet[1] + facet[2]) / 3.0; }

struct OpenFacet {
  Facet facet{};
  double most = 0;
  bool operator<(const OpenFacet& other) const { return most < other.most; }
};

// Both halves of a facet, cut across its longest side.
std::array<Facet, 2> halves_of(const Facet& facet) {
  std::size_t longest = 0;
  double length = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double side = glm::distance(facet[k], facet[(k + 1) % 3]);
    if (side > length) {
      length = side;
      longest = k;
    }
  }
  const glm::dvec3 &a = facet[longest], &b = facet[(longest + 1) % 3], &c = facet[(longest + 2) % 3], middle = 0.5 * (a + b);
  return {Facet{a, middle, c}, Facet{middle, b, c}};
}

}  // namespace

LargestDistance largest_distance(const std::vector<Facet>& facets, const std::function<FacetDistance(const Facet&)>& distance,
                                 double limit, double enough) {
  constexpr double DECIDED = 0.01e-3;  // m: closer to the limit the answer is the upper bound
  LargestDistance found;
  std::priority_queue<OpenFacet> open;
  const auto add = [&](const Facet& facet) {
    const FacetDistance known = distance(facet);
    if (known.at_center > found.reached) {
      found.reached = known.at_center;
      found.place = center_of(facet);
    }
    open.push({facet, known.most});
  };
  for (const Facet& facet : facets) {
    if (found.reached > enough) break;
    add(facet);
  }
  while (!open.empty() && found.reached <= enough) {
    const double most = open.top().most;
    const double factor = found.reached > 4 * limit ? 1.3 : 1.1;
    const bool is_close = most <= std::max({found.reached + CLOSE_BOUND, factor * found.reached, FINE_BOUND});
    const bool is_decided = most <= limit || found.reached > limit || most - found.reached <= DECIDED;
    if (is_close && is_decided) break;
    const Facet facet = open.top().facet;
    open.pop();
    for (const Facet& half : halves_of(facet)) add(half);
  }
  found.most = open.empty() ? found.reached : std::max(found.reached, open.top().most);
  return found;
}

// The seven regions about a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
glm::dvec3 nearest_point(const glm::dvec3& p, const Facet& triangle) {
  const auto& [a, b, c] = triangle;
  const glm::dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp), d5 = glm::dot(ab, cp),
               d6 = glm::dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  return sum > 0 ? a + vb / sum * ab + vc / sum * ac : a;
}

Facet facet_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {to_vec3(mesh.vertices[a]), to_vec3(mesh.vertices[b]), to_vec3(mesh.vertices[c])};
}

std::vector<Facet> facets_of(const ConvexHull& hull) {
  std::vector<Facet> facets;
  for (const auto& [a, b, c] : hull.triangles)
    facets.push_back({to_vec3(hull.vertices[a]), to_vec3(hull.vertices[b]), to_vec3(hull.vertices[c])});
  return facets;
}

FacetDistance facet_outside(const Facet& facet, const CheckedMesh& mesh, const MeshDistance& body) {
  const glm::dvec3 center = center_of(facet);
  double radius = 0;
  for (const glm::dvec3& corner : facet) radius = std::max(radius, glm::distance(corner, center));
  std::uint32_t nearest = 0;
  const double away = body.distance(to_triple(center), nearest);
  const Facet triangle = facet_of(mesh.mesh, nearest);
  double corners = 0;
  for (const glm::dvec3& corner : facet) corners = std::max(corners, glm::distance(corner, nearest_point(corner, triangle)));
  if (body.is_inside(to_triple(center))) return {0, std::min(std::max(0.0, radius - away), corners)};
  return {away, std::max(away, std::min(away + radius, corners))};
}

LargestDistance distance_outside(const ConvexHull& hull, const CheckedMesh& mesh, const MeshDistance& body, double limit,
                                 double enough) {
  return largest_distance(
      facets_of(hull), [&](const Facet& facet) { return facet_outside(facet, mesh, body); }, limit, enough);
}

}  // namespace wholehand
