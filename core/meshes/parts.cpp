// SPDX-License-Identifier: MIT
#include "core/meshes/parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/vectors.h"

namespace wholehand {
namespace {

constexpr std::size_t MOST_OUTER = 64;       // parts that may have others within them, the largest ones
constexpr std::size_t MOST_NESTED = 10'000;  // parts that may lie within others: beyond, they are crumbs
constexpr std::size_t SAMPLES = 8;           // triangles of a part that tell where it lies
constexpr std::size_t MOST_POINTS = 2000;    // of a part that may reach into another one
constexpr double SAME_SIZE = 1e-6;           // of the largest number: the unit changes the rounding of a box
constexpr double ON_SURFACE = 1e-5;          // of a part's box: a point so close above or below is on its surface

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t set) {
  while (parent[set] != set) set = parent[set] = parent[parent[set]];
  return set;
}

double box_size(const MeshPart& part) { return distance(part.low, part.high); }

bool is_box_within(const MeshPart& inner, const MeshPart& outer) {
  for (int k = 0; k < 3; ++k)
    if (inner.low[k] < outer.low[k] || inner.high[k] > outer.high[k]) return false;
  return true;
}

Triple middle_of_triangle(const TriangleMesh& mesh, const Corners& triangle) {
  Triple middle{};
  for (const std::uint32_t corner : triangle)
    for (int axis = 0; axis < 3; ++axis) middle[axis] += mesh.vertices[corner][axis] / 3;
  return middle;
}

std::vector<Corners> triangles_of_part(const TriangleMesh& mesh, const MeshParts& parts, std::uint32_t part) {
  std::vector<Corners> triangles;
  triangles.reserve(parts.parts[part].triangles);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (parts.of_triangle[t] == part) triangles.push_back(mesh.triangles[t]);
  return triangles;
}

// Leaves one of several triangles with the same corners, as a check does; sorts them. `first`: for each vertex the first one that equals it.
void leave_one_of_each(std::vector<Corners>& triangles, const std::vector<std::uint32_t>& first) {
  for (Corners& corners : triangles) {
    for (std::uint32_t& corner : corners) corner = first[corner];
    std::sort(corners.begin(), corners.end());
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
}

// Points by slabs across x, in each of them by z, so that a triangle finds those above or below it.
class PointSlabs {
 public:
  explicit PointSlabs(const std::vector<Triple>& points) : points_(points) {
    const auto [least, most] = std::minmax_element(points.begin(), points.end());  // by x first
    low_ = (*least)[0];
    high_ = (*most)[0];
    slabs_.resize(static_cast<std::size_t>(std::sqrt(static_cast<double>(points.size()))) + 1);
    for (std::uint32_t k = 0; k < points.size(); ++k) slabs_[slab(points[k][0])].push_back(k);
    for (std::vector<std::uint32_t>& some : slabs_)
      std::sort(some.begin(), some.end(), [&](std::uint32_t a, std::uint32_t b) { return points[a][2] < points[b][2]; });
  }

  // Calls `visit` with each point in the triangle's box as seen from above, and others nearby.
  template <class Visit>
  void visit_near(const Triple& a, const Triple& b, const Triple& c, const Visit& visit) const {
    const double low = std::min({a[0], b[0], c[0]}), high = std::max({a[0], b[0], c[0]}), below = std::min({a[2], b[2], c[2]}),
                 above = std::max({a[2], b[2], c[2]});
    if (high < low_ || low > high_) return;
    for (std::size_t s = slab(low); s <= slab(high); ++s) {
      auto at =
          std::lower_bound(slabs_[s].begin(), slabs_[s].end(), below, [&](std::uint32_t k, double z) { return points_[k][2] < z; });
      for (; at != slabs_[s].end() && points_[*at][2] <= above; ++at) visit(*at);
    }
  }

 private:
  std::size_t slab(double x) const {
    if (!(x > low_)) return 0;
    const double share = std::min(1.0, (x - low_) / (high_ - low_));
    return std::min(slabs_.size() - 1, static_cast<std::size_t>(share * static_cast<double>(slabs_.size())));
  }

  const std::vector<Triple>& points_;
  double low_ = 0, high_ = 0;
  std::vector<std::vector<std::uint32_t>> slabs_;
};

// Which of some points, one at least, a surface encloses. Those that lie on it, within `tolerance` above or below, are outside.
std::vector<bool> enclosed_points(const TriangleMesh& mesh, const std::vector<Corners>& surface, const std::vector<Triple>& points,
                                  double tolerance) {
  const PointSlabs slabs(points);
  std::vector<bool> is_inside(points.size()), is_on(points.size());
  for (const Corners& triangle : surface) {
    const auto meet = [&](std::uint32_t k) {
      const std::optional<double> height = crossing_height(mesh, triangle, points[k][0], points[k][2]);
      if (!height) return;
      if (std::abs(*height - points[k][1]) <= tolerance) is_on[k] = true;
      if (*height > points[k][1]) is_inside[k] = !is_inside[k];
    };
    slabs.visit_near(mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]], meet);
  }
  for (std::size_t k = 0; k < points.size(); ++k) is_inside[k] = is_inside[k] && !is_on[k];
  return is_inside;
}

void measure_boxes(const TriangleMesh& mesh, MeshParts& parts) {
  constexpr double FAR = std::numeric_limits<double>::infinity();
  for (MeshPart& part : parts.parts) part = {0, {FAR, FAR, FAR}, {-FAR, -FAR, -FAR}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (parts.of_triangle[t] == NO_PART) continue;
    MeshPart& part = parts.parts[parts.of_triangle[t]];
    ++part.triangles;
    for (const std::uint32_t corner : mesh.triangles[t])
      for (int k = 0; k < 3; ++k) {
        part.low[k] = std::min(part.low[k], mesh.vertices[corner][k]);
        part.high[k] = std::max(part.high[k], mesh.vertices[corner][k]);
      }
  }
}

// Gives each part the number of `place`, and measures them again.
void renumber(const TriangleMesh& mesh, MeshParts& parts, const std::vector<std::uint32_t>& place, std::size_t count) {
  for (std::uint32_t& part : parts.of_triangle)
    if (part != NO_PART) part = place[part];
  parts.parts.assign(count, {});
  measure_boxes(mesh, parts);
}

// The largest box first. Boxes that differ only by rounding from the largest of their kind are equal, and sorted by where they lie.
void sort_by_size(const TriangleMesh& mesh, MeshParts& parts) {
  std::vector<double> sizes;
  double largest = 0;
  for (const MeshPart& part : parts.parts) {
    sizes.push_back(box_size(part));
    for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(part.low[k]), std::abs(part.high[k])});
  }
  std::vector<std::uint32_t> order(sizes.size()), place(sizes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return sizes[a] > sizes[b]; });
  for (auto first = order.begin(), next = first; first != order.end(); first = next) {
    next = std::find_if(first, order.end(), [&](std::uint32_t part) { return sizes[part] < sizes[*first] - SAME_SIZE * largest; });
    std::sort(first, next, [&](std::uint32_t a, std::uint32_t b) {
      const Triple &one = parts.parts[a].low, &other = parts.parts[b].low;
      return one != other ? one < other : a < b;  // the order of the file, which a check keeps
    });
  }
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<std::uint32_t>(k);
  renumber(mesh, parts, place, order.size());
}

// Middles and corners of some triangles of each of the first parts.
std::vector<std::vector<Triple>> samples_of_parts(const TriangleMesh& mesh, const MeshParts& parts, std::size_t count) {
  std::vector<std::vector<Triple>> samples(count);
  std::vector<std::size_t> visited(count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t part = parts.of_triangle[t];
    if (part >= count || visited[part]++ % (parts.parts[part].triangles / SAMPLES + 1) != 0) continue;
    samples[part].push_back(middle_of_triangle(mesh, mesh.triangles[t]));
    samples[part].push_back(mesh.vertices[mesh.triangles[t][0]]);
  }
  return samples;
}

// Joins parts with the largest one that encloses all samples of them.
void join_nested(const TriangleMesh& mesh, MeshParts& parts, const std::vector<std::uint32_t>& first) {
  const std::size_t count = std::min(parts.parts.size(), MOST_NESTED);
  const std::vector<std::vector<Triple>> samples = samples_of_parts(mesh, parts, count);
  std::vector<std::uint32_t> outer(parts.parts.size());
  std::iota(outer.begin(), outer.end(), 0U);
  for (std::uint32_t candidate = 0; candidate < std::min(count, MOST_OUTER); ++candidate) {
    if (outer[candidate] != candidate) continue;
    std::vector<std::uint32_t> part_of_point;
    std::vector<Triple> points;
    for (std::uint32_t inner = candidate + 1; inner < count; ++inner) {
      if (outer[inner] != inner || !is_box_within(parts.parts[inner], parts.parts[candidate])) continue;
      points.insert(points.end(), samples[inner].begin(), samples[inner].end());
      part_of_point.resize(points.size(), inner);
      outer[inner] = candidate;
    }
    if (points.empty()) continue;
    std::vector<Corners> surface = triangles_of_part(mesh, parts, candidate);
    leave_one_of_each(surface, first);
    const std::vector<bool> is_inside = enclosed_points(mesh, surface, points, ON_SURFACE * box_size(parts.parts[candidate]));
    for (std::size_t k = 0; k < points.size(); ++k)
      if (!is_inside[k]) outer[part_of_point[k]] = part_of_point[k];
  }
  std::vector<std::uint32_t> place(parts.parts.size());
  std::uint32_t next = 0;
  for (std::uint32_t part = 0; part < place.size(); ++part) place[part] = outer[part] == part ? next++ : place[outer[part]];
  if (next < place.size()) renumber(mesh, parts, place, next);
}

// The parts as they come in the file. `parent`: for each vertex one that it is joined with, itself or an earlier one.
MeshParts connected_parts(const TriangleMesh& mesh, std::vector<std::uint32_t> parent) {
  MeshParts parts;
  parts.of_triangle.assign(mesh.triangles.size(), NO_PART);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_point_or_edge(mesh, mesh.triangles[t])) continue;
    parts.of_triangle[t] = 0;
    for (const int k : {1, 2}) {
      const std::uint32_t a = root(parent, mesh.triangles[t][0]), b = root(parent, mesh.triangles[t][k]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<std::uint32_t> number(mesh.vertices.size(), NO_PART);
  std::uint32_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (parts.of_triangle[t] == NO_PART) continue;
    std::uint32_t& part = number[root(parent, mesh.triangles[t][0])];
    if (part == NO_PART) part = count++;
    parts.of_triangle[t] = part;
  }
  parts.parts.resize(count);
  measure_boxes(mesh, parts);
  return parts;
}

}  // namespace

MeshParts find_parts(const TriangleMesh& mesh) {
  EqualVertices equal(mesh.vertices);
  std::vector<std::uint32_t> first(mesh.vertices.size());
  for (std::uint32_t vertex = 0; vertex < first.size(); ++vertex) first[vertex] = equal.first_equal(vertex);
  MeshParts parts = connected_parts(mesh, first);
  if (parts.parts.size() > 1) {
    sort_by_size(mesh, parts);
    join_nested(mesh, parts, first);
  }
  return parts;
}

TriangleMesh parts_alone(const TriangleMesh& mesh, const MeshParts& parts, std::span<const int> numbers) {
  std::vector<bool> is_taken(parts.parts.size());
  for (const int number : numbers) is_taken[static_cast<std::size_t>(number - 1)] = true;
  TriangleMesh alone = mesh;
  alone.triangles.clear();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (parts.of_triangle[t] != NO_PART && is_taken[parts.of_triangle[t]]) alone.triangles.push_back(mesh.triangles[t]);
  return alone;
}

bool reaches_into(const TriangleMesh& mesh, const MeshParts& parts, int of, int into) {
  const auto part = static_cast<std::uint32_t>(of - 1), other = static_cast<std::uint32_t>(into - 1);
  const MeshPart& outer = parts.parts[other];
  std::vector<Triple> points;  // within the other's box: the ends of a handle rather than its bow
  const auto take = [&](const Triple& p) {
    if (is_box_within({0, p, p}, outer)) points.push_back(p);
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (parts.of_triangle[t] != part) continue;
    take(middle_of_triangle(mesh, mesh.triangles[t]));
    for (const std::uint32_t corner : mesh.triangles[t]) take(mesh.vertices[corner]);
  }
  if (points.empty()) return false;
  std::vector<Triple> some;
  for (std::size_t k = 0; k < points.size(); k += points.size() / MOST_POINTS + 1) some.push_back(points[k]);
  const std::vector<bool> is_inside =
      enclosed_points(mesh, triangles_of_part(mesh, parts, other), some, ON_SURFACE * box_size(outer));
  return std::find(is_inside.begin(), is_inside.end(), true) != is_inside.end();
}

}  // namespace wholehand
