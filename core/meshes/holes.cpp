// SPDX-License-Identifier: MIT
#include "core/meshes/holes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numeric>
#include <utility>

#include "core/meshes/polygon.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

constexpr double NO_HOLE_AREA = 1e-12;   // of a loop's squared length: below it, rounding
constexpr double NO_FAN_AREA = 1e-9;     // of a triangle of a fan, of the hole's area: below it, rounding
constexpr double SAME_DIRECTION = 0.99;  // cosine of the angle between two holes in one plane

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

// The edges of one triangle only, turned round: so they run in the triangles that would close the mesh. Sorted.
std::vector<DirectedEdge> open_edges(const TriangleMesh& mesh) {
  std::vector<DirectedEdge> edges;
  for_each_edge(edge_uses(mesh.triangles), [&](std::span<const EdgeUse> uses) {
    const EdgeUse& use = uses.front();
    if (uses.size() == 1) edges.push_back(use.is_forward ? DirectedEdge{use.high, use.low} : DirectedEdge{use.low, use.high});
  });
  std::sort(edges.begin(), edges.end());
  return edges;
}

void measure_hole(const TriangleMesh& mesh, MeshHole& hole) {
  const std::size_t count = hole.corners.size();
  Triple low = mesh.vertices[hole.corners[0]], high = low;
  glm::dvec3 sum(0), area(0);
  const auto corner = [&](std::size_t i) { return to_vec3(mesh.vertices[hole.corners[i % count]]); };
  for (std::size_t i = 0; i < count; ++i) {
    const Triple &p = mesh.vertices[hole.corners[i]], &q = mesh.vertices[hole.corners[(i + 1) % count]];
    hole.length += distance(q, p);
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
    sum += corner(i);
    area += glm::cross(corner(i) - corner(0), corner(i + 1) - corner(0)) / 2.0;
  }
  hole.across = distance(high, low);
  const glm::dvec3 middle = sum / static_cast<double>(count);
  hole.middle = to_triple(middle);
  if (!(glm::length(area) > NO_HOLE_AREA * hole.length * hole.length)) return;
  hole.area = to_triple(area);
  hole.has_fan = true;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 from = corner(i) - middle, to = corner(i + 1) - middle;
    hole.off_plane = std::max(hole.off_plane, std::abs(glm::dot(from, area)) / glm::length(area));
    if (!(glm::dot(glm::cross(from, to), area) > NO_FAN_AREA * glm::dot(area, area))) hole.has_fan = false;
  }
}

// Follows open edges from vertex to vertex, each once.
class LoopWalk {
 public:
  LoopWalk(const TriangleMesh& mesh, std::vector<DirectedEdge> edges)
      : mesh_(mesh), edges_(std::move(edges)), next_(edges_.size()), place_(mesh.vertices.size(), NOWHERE) {
    for (std::size_t i = 0; i < edges_.size(); ++i) next_[i] = i;  // of the first edge from a vertex: the next one not yet gone
    // where the edges from a vertex end: looked up, as a vertex may have most of the edges and the way come by it as often
    end_.resize(edges_.size());
    for (std::size_t i = edges_.size(); i-- > 0;)
      end_[i] = i + 1 < edges_.size() && edges_[i + 1].first == edges_[i].first ? end_[i + 1] : i + 1;
  }

  MeshHoles walk() {
    for (std::size_t first = 0; first < edges_.size(); first = end_[first])
      while (next_[first] < end_[first]) follow(edges_[first].first);
    return std::move(found_);
  }

 private:
  static constexpr std::uint32_t NOWHERE = ~0u;

  std::size_t first_from(std::uint32_t vertex) const {
    return static_cast<std::size_t>(std::lower_bound(edges_.begin(), edges_.end(), DirectedEdge{vertex, 0}) - edges_.begin());
  }

  // Goes on until there is no way; whatever part of the way came back to a vertex of it is a loop and is cut off.
  void follow(std::uint32_t start) {
    std::vector<std::uint32_t> path{start};
    place_[start] = 0;
    while (true) {
      const std::size_t first = first_from(path.back());
      if (first == edges_.size() || edges_[first].first != path.back() || next_[first] == end_[first]) break;
      const std::uint32_t vertex = edges_[next_[first]++].second;
      if (place_[vertex] == NOWHERE) {
        place_[vertex] = static_cast<std::uint32_t>(path.size());
        path.push_back(vertex);
        continue;
      }
      MeshHole& hole = found_.loops.emplace_back();
      hole.corners.assign(path.begin() + place_[vertex], path.end());
      measure_hole(mesh_, hole);
      while (path.back() != vertex) {
        place_[path.back()] = NOWHERE;
        path.pop_back();
      }
    }
    found_.loose_edges += path.size() - 1;
    for (const std::uint32_t vertex : path) place_[vertex] = NOWHERE;
  }

  const TriangleMesh& mesh_;
  std::vector<DirectedEdge> edges_;
  std::vector<std::size_t> next_, end_;
  std::vector<std::uint32_t> place_;  // on the path
  MeshHoles found_;
};

// A flat hole as its plane is seen from outside: without the coordinate along which it faces most.
PolygonLoop flattened(const TriangleMesh& mesh, const MeshHole& hole, const Triple& area) {
  int facing = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(area[k]) > std::abs(area[facing])) facing = k;
  int right = (facing + 1) % 3, up = (facing + 2) % 3;
  if (area[facing] < 0) std::swap(right, up);
  PolygonLoop loop;
  loop.reserve(hole.corners.size());
  for (const std::uint32_t corner : hole.corners) loop.push_back({mesh.vertices[corner][right], mesh.vertices[corner][up], corner});
  return loop;
}

// Whether a flat hole lies within another one, in its plane; `tolerance`: off it, m.
bool lies_within(const TriangleMesh& mesh, const MeshHole& inner, const MeshHole& outer, double tolerance) {
  const double size = norm(outer.area);
  const auto off_plane = [&](const Triple& p) {
    const Triple from{p[0] - outer.middle[0], p[1] - outer.middle[1], p[2] - outer.middle[2]};
    return std::abs(dot(from, outer.area)) / size;
  };
  if (off_plane(inner.middle) > tolerance) return false;
  if (distance(inner.middle, outer.middle) > outer.across + tolerance) return false;  // a box about `outer` has both
  if (std::abs(dot(inner.area, outer.area)) < SAME_DIRECTION * norm(inner.area) * size) return false;
  return std::all_of(inner.corners.begin(), inner.corners.end(),
                     [&](std::uint32_t corner) { return off_plane(mesh.vertices[corner]) <= tolerance; }) &&
         is_within(flattened(mesh, outer, outer.area), flattened(mesh, inner, outer.area).front());
}

// Gathers flat holes, given by falling area, into polygons. A hole belongs to the smallest one around it if that is an outer loop and faces the other
// way; else it is an outer loop of its own.
std::vector<std::vector<std::size_t>> nest_holes(const TriangleMesh& mesh, const std::vector<MeshHole>& loops,
                                                 const std::vector<std::size_t>& flat, double tolerance) {
  std::vector<std::vector<std::size_t>> polygons;
  std::vector<std::size_t> polygon_of(flat.size());
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const MeshHole& hole = loops[flat[i]];
    std::size_t around = flat.size() <= MOST_NESTED_HOLES ? i : 0;
    while (around > 0 && !lies_within(mesh, hole, loops[flat[around - 1]], tolerance)) --around;
    const std::size_t polygon = around > 0 ? polygon_of[around - 1] : 0;
    if (around > 0 && polygons[polygon].front() == flat[around - 1] && dot(hole.area, loops[flat[around - 1]].area) < 0) {
      polygon_of[i] = polygon;
      polygons[polygon].push_back(flat[i]);
    } else {
      polygon_of[i] = polygons.size();
      polygons.push_back({flat[i]});
    }
  }
  return polygons;
}

void close_by_fan(const MeshHole& hole, TriangleMesh& mesh) {
  const std::vector<std::uint32_t>& corners = hole.corners;
  if (corners.size() == 3) {
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(hole.middle);
  for (std::size_t i = 0; i < corners.size(); ++i)
    mesh.triangles.push_back({corners[i], corners[(i + 1) % corners.size()], center});
}

}  // namespace

MeshHoles find_holes(const TriangleMesh& mesh) { return LoopWalk(mesh, open_edges(mesh)).walk(); }

bool is_small_hole(const MeshHole& hole, double extent) {
  return hole.corners.size() >= 3 && hole.across <= SMALL_HOLE * extent && hole.length <= SMALL_HOLE_EDGE * extent;
}

bool is_flat_hole(const MeshHole& hole, double extent) { return hole.area != Triple{} && hole.off_plane <= FLAT_HOLE * extent; }

HoleClosing plan_closing(const TriangleMesh& mesh, const MeshHoles& holes, double extent) {
  const std::vector<MeshHole>& loops = holes.loops;
  HoleClosing closing;
  const auto close_alone = [&](std::size_t i) { (is_small_hole(loops[i], extent) ? closing.fans : closing.open).push_back(i); };
  std::vector<std::size_t> flat;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (is_flat_hole(loops[i], extent)) {
      flat.push_back(i);
    } else {
      close_alone(i);
    }
  }
  std::stable_sort(flat.begin(), flat.end(),
                   [&](std::size_t a, std::size_t b) { return norm(loops[a].area) > norm(loops[b].area); });
  std::size_t left = MOST_CUT_CORNERS * MOST_CUT_CORNERS;  // the largest polygons take theirs first
  for (const std::vector<std::size_t>& polygon : nest_holes(mesh, loops, flat, 2 * FLAT_HOLE * extent)) {
    const std::size_t corners = std::accumulate(polygon.begin(), polygon.end(), std::size_t{0},
                                                [&](std::size_t sum, std::size_t i) { return sum + loops[i].corners.size(); });
    if (polygon.size() == 1 && loops[polygon[0]].has_fan) {
      closing.fans.push_back(polygon[0]);
    } else if (corners * corners <= left) {
      left -= corners * corners;
      closing.polygons.push_back(polygon);
    } else {
      std::for_each(polygon.begin(), polygon.end(), close_alone);
    }
  }
  return closing;
}

void close_holes(const MeshHoles& holes, const HoleClosing& closing, TriangleMesh& mesh) {
  for (const std::size_t i : closing.fans) close_by_fan(holes.loops[i], mesh);
  for (const std::vector<std::size_t>& polygon : closing.polygons) {
    const Triple& area = holes.loops[polygon[0]].area;
    std::vector<PolygonLoop> loops;
    for (const std::size_t i : polygon) loops.push_back(flattened(mesh, holes.loops[i], area));
    const PolygonLoop outer = std::move(loops.front());
    loops.erase(loops.begin());
    const std::vector<Corners> triangles = cut_polygon(outer, std::move(loops));
    mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
  }
}

}  // namespace wholehand
