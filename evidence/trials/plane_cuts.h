// SPDX-License-Identifier: MIT
// Polygons cut by planes.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace wholehand {

using Polygon = std::vector<glm::dvec3>;  // convex, in a plane

struct Plane {
  glm::dvec3 point{}, normal{};  // unit normal
  double height(const glm::dvec3& p) const { return glm::dot(p - point, normal); }
};

// What lies above the plane, or with `side` -1 below it; a corner within a tenth of a micrometer lies on both sides. Empty: nothing.
Polygon clipped(const Polygon& polygon, const Plane& plane, double side);
// Each of them, without those of which nothing is left.
std::vector<Polygon> clipped(const std::vector<Polygon>& polygons, const Plane& plane, double side);
// Along the normal, twice as long as the area is large.
glm::dvec3 double_area(const Polygon& polygon);
// Whether all corners are nearer to the plane than the tolerance.
bool lies_in(const Polygon& polygon, const Plane& plane, double tolerance);
// The polygon in which a plane meets a convex body with these sides.
Polygon section_of(const std::vector<Polygon>& sides, const Plane& plane);
std::vector<Polygon> box_sides(const glm::dvec3& low, const glm::dvec3& high);

}  // namespace wholehand
