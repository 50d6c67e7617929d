// SPDX-License-Identifier: MIT
#include "evidence/trials/convex_hull.h"

#include <algorithm>
#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "core/vectors.h"
#include "sweeps/grips/qhull_run.h"

namespace wholehand {
namespace {

glm::dvec3 corner(const ConvexHull& hull, std::uint32_t vertex) { return to_vec3(hull.vertices[vertex]); }

// Copies the triangles, with the vertices numbered anew, and turns each outward.
ConvexHull read_hull(qhT* qh) {
  constexpr std::uint32_t UNSEEN = ~0u;
  ConvexHull hull;
  std::vector<std::uint32_t> number(static_cast<std::size_t>(qh->num_points), UNSEEN);
  facetT* facet = nullptr;  // the names that Qhull's macros want
  vertexT *vertex = nullptr, **vertexp = nullptr;
  FORALLfacets {
    std::array<std::uint32_t, 3> triangle{};
    std::size_t count = 0;
    FOREACHvertex_(facet->vertices) {
      const auto point = static_cast<std::size_t>((vertex->point - qh->first_point) / 3);
      if (number[point] == UNSEEN) {
        number[point] = static_cast<std::uint32_t>(hull.vertices.size());
        hull.vertices.push_back({vertex->point[0], vertex->point[1], vertex->point[2]});
      }
      if (count < 3) triangle[count] = number[point];
      ++count;
    }
    if (count != 3 || !facet->normal) continue;
    const glm::dvec3 a = corner(hull, triangle[0]), normal{facet->normal[0], facet->normal[1], facet->normal[2]};
    const glm::dvec3 turn = glm::cross(corner(hull, triangle[1]) - a, corner(hull, triangle[2]) - a);
    if (glm::dot(turn, normal) < 0) std::swap(triangle[1], triangle[2]);
    hull.triangles.push_back(triangle);
  }
  return hull;
}

std::optional<ConvexHull> run_qhull(std::vector<coordT> numbers, const char* options) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> nowhere(std::fopen("/dev/null", "w"), &std::fclose);
  if (!nowhere) return std::nullopt;  // Qhull would print to stderr
  sweeps::QhullRun run;
  std::string command = options;  // Qhull wants to write to it
  if (qh_new_qhull(run.get(), 3, static_cast<int>(numbers.size() / 3), numbers.data(), False, command.data(), nullptr,
                   nowhere.get()) != 0)
    return std::nullopt;
  return read_hull(run.get());
}

}  // namespace

// Option Qt cuts facets into triangles. Where its merging of nearly coplanar facets fails, QJ, which moves the points by rounding errors, does not.
std::optional<ConvexHull> convex_hull(const std::vector<Triple>& points) {
  if (points.size() < 4) return std::nullopt;
  std::vector<coordT> numbers;
  numbers.reserve(3 * points.size());
  for (const Triple& p : points) numbers.insert(numbers.end(), p.begin(), p.end());
  std::optional<ConvexHull> hull = run_qhull(numbers, "qhull Qt");
  if (!hull) hull = run_qhull(numbers, "qhull QJ");
  if (!hull || hull->triangles.size() < 4) return std::nullopt;
  double area = 0;
  const glm::dvec3 o = to_vec3(hull->vertices.front());
  for (const auto& [i, j, k] : hull->triangles) {
    const glm::dvec3 a = corner(*hull, i) - o, b = corner(*hull, j) - o, c = corner(*hull, k) - o;
    hull->volume += glm::dot(a, glm::cross(b, c)) / 6;
    area += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  if (!(hull->volume > FLAT_HULL * area)) return std::nullopt;
  return hull;
}

std::optional<ConvexHull> joint_hull(const ConvexHull& a, const ConvexHull& b) {
  std::vector<Triple> points = a.vertices;
  points.insert(points.end(), b.vertices.begin(), b.vertices.end());
  return convex_hull(points);
}

double plane_distance(const ConvexHull& hull, const Triple& point) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : hull.triangles) {
    const glm::dvec3 a = corner(hull, i), normal = glm::cross(corner(hull, j) - a, corner(hull, k) - a);
    const double size = glm::length(normal);
    if (size > 0) farthest = std::max(farthest, glm::dot(to_vec3(point) - a, normal) / size);
  }
  return farthest;
}

}  // namespace wholehand
