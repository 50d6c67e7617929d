// SPDX-License-Identifier: MIT
// The largest distance of a surface from a body, between two bounds.
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "core/meshes/distance.h"
#include "core/meshes/triangles.h"
#include "evidence/trials/convex_hull.h"

namespace wholehand {

using Facet = std::array<glm::dvec3, 3>;
constexpr double CLOSE_BOUND = 0.03e-3, FINE_BOUND = 0.2e-3;  // m; distances below FINE_BOUND need no exact number

// Bounds of a distance on a facet, m.
struct FacetDistance {
  double at_center = 0, most = 0;
};

// What is known of the largest distance: it is reached at `place`, and passed nowhere by more than `most`.
struct LargestDistance {
  double reached = 0, most = 0;  // m
  glm::dvec3 place{};
};

// Branch and bound: halves the facet with the largest bound until the bounds are CLOSE_BOUND or a tenth apart (three tenths beyond four times `limit`),
// or below FINE_BOUND, and it is certain on which side of `limit` (m) the largest distance lies. Ends as soon as `enough` is reached; `most` is then
// no bound.
LargestDistance largest_distance(const std::vector<Facet>& facets, const std::function<FacetDistance(const Facet&)>& distance,
                                 double limit, double enough);

// The same for a hull's distance outside a body.
LargestDistance distance_outside(const ConvexHull& hull, const CheckedMesh& mesh, const MeshDistance& body, double limit,
                                 double enough);

// Bounds of the distance of a facet outside a body: distances differ by no more than places do, and a distance to one triangle is largest at a corner.
FacetDistance facet_outside(const Facet& facet, const CheckedMesh& mesh, const MeshDistance& body);

glm::dvec3 nearest_point(const glm::dvec3& p, const Facet& triangle);
Facet facet_of(const TriangleMesh& mesh, std::uint32_t triangle);
std::vector<Facet> facets_of(const ConvexHull& hull);

}  // namespace wholehand
