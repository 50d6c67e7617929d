// SPDX-License-Identifier: MIT
#include "evidence/trials/plane_cuts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wholehand {
namespace {

constexpr double ON_PLANE = 0.1e-6;  // m

}  // namespace

Polygon clipped(const Polygon& polygon, const Plane& plane, double side) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double u = side * plane.height(a), v = side * plane.height(b);
    if (u >= -ON_PLANE) kept.push_back(a);
    if ((u < -ON_PLANE && v > ON_PLANE) || (u > ON_PLANE && v < -ON_PLANE)) kept.push_back(a + u / (u - v) * (b - a));
  }
  if (kept.size() < 3) kept.clear();
  return kept;
}

std::vector<Polygon> clipped(const std::vector<Polygon>& polygons, const Plane& plane, double side) {
  std::vector<Polygon> kept;
  for (const Polygon& polygon : polygons)
    if (Polygon part = clipped(polygon, plane, side); !part.empty()) kept.push_back(std::move(part));
  return kept;
}

glm::dvec3 double_area(const Polygon& polygon) {
  glm::dvec3 sum(0);
  for (std::size_t k = 2; k < polygon.size(); ++k) sum += glm::cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
  return sum;
}

bool lies_in(const Polygon& polygon, const Plane& plane, double tolerance) {
  return std::all_of(polygon.begin(), polygon.end(), [&](const glm::dvec3& p) { return std::abs(plane.height(p)) < tolerance; });
}

Polygon section_of(const std::vector<Polygon>& sides, const Plane& plane) {
  Polygon points;
  for (const Polygon& polygon : sides)
    for (const glm::dvec3& p : clipped(polygon, plane, 1))
      if (std::abs(plane.height(p)) <= 2 * ON_PLANE) points.push_back(p);
  if (points.size() < 3) return {};
  glm::dvec3 middle(0);
  for (const glm::dvec3& p : points) middle += p / static_cast<double>(points.size());
  const glm::dvec3 u =
      glm::normalize(glm::cross(plane.normal, std::abs(plane.normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 v = glm::cross(plane.normal, u);
  const auto angle = [&](const glm::dvec3& p) { return std::atan2(glm::dot(p - middle, v), glm::dot(p - middle, u)); };
  std::sort(points.begin(), points.end(), [&](const glm::dvec3& a, const glm::dvec3& b) { return angle(a) < angle(b); });
  return points;
}

std::vector<Polygon> box_sides(const glm::dvec3& low, const glm::dvec3& high) {
  std::vector<Polygon> sides;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {low[axis], high[axis]}) {
      Polygon side;
      for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        glm::dvec3 p;
        p[axis] = at;
        p[(axis + 1) % 3] = (u ? high : low)[(axis + 1) % 3];
        p[(axis + 2) % 3] = (v ? high : low)[(axis + 2) % 3];
        side.push_back(p);
      }
      sides.push_back(std::move(side));
    }
  }
  return sides;
}

}  // namespace wholehand
