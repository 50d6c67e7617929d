// SPDX-License-Identifier: MIT
#include "evidence/trials/convex_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "core/vectors.h"
#include "evidence/trials/mesh_rings.h"
#include "evidence/trials/plane_cuts.h"
#include "evidence/trials/surface_bound.h"

namespace wholehand {
namespace {

constexpr double IN_PLANE = 1e-6;     // m: a polygon this near the plane with all corners bounds the body on one side of it alone
constexpr double FLAT_SIDE = 20e-6;   // m: the surface this near a plane is a flat side in it
constexpr double LARGE_SIDE = 0.2;    // of a hull's section: so large a flat side is worth a cut along it
constexpr double SMALL_FACET = 1e-6;  // m2
constexpr double SAME_AREA = 1e-5;    // of the area
constexpr double LEAST_PROGRESS = 1e-3;  // of a hull's volume
constexpr double UNBOUNDED = std::numeric_limits<double>::infinity();

// A convex part of space with what it holds of the body.
struct Cell {
  std::vector<Polygon> skin;       // the body's surface within
  std::vector<Polygon> sides;      // of the cell
  std::optional<ConvexHull> hull;  // of the body within; none: nothing, or flat
  LargestDistance error;           // of the hull, outside the body
};

double facet_area(const Facet& facet) { return 0.5 * glm::length(glm::cross(facet[1] - facet[0], facet[2] - facet[0])); }

std::vector<Polygon> polygons_of(const std::vector<Facet>& facets) {
  std::vector<Polygon> polygons;
  for (const Facet& facet : facets) polygons.emplace_back(facet.begin(), facet.end());
  return polygons;
}

struct Extent {
  glm::dvec3 low{UNBOUNDED}, high{-UNBOUNDED};
  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

Extent extent_of(const ConvexHull& hull) {
  Extent extent;
  for (const Triple& p : hull.vertices) extent.add(to_vec3(p));
  return extent;
}

// The direction across `d` in which a hull is longest, by its vertices' second moments.
glm::dvec3 longest_across(const ConvexHull& hull, const glm::dvec3& d) {
  const glm::dvec3 u = glm::normalize(glm::cross(d, std::abs(d.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 v = glm::cross(d, u);
  glm::dvec3 middle(0);
  for (const Triple& p : hull.vertices) middle += to_vec3(p) / static_cast<double>(hull.vertices.size());
  double uu = 0, uv = 0, vv = 0;
  for (const Triple& p : hull.vertices) {
    const double a = glm::dot(to_vec3(p) - middle, u), b = glm::dot(to_vec3(p) - middle, v);
    uu += a * a;
    uv += a * b;
    vv += b * b;
  }
  const double angle = 0.5 * std::atan2(2 * uv, uu - vv);
  return std::cos(angle) * u + std::sin(angle) * v;
}

class Cutter {
 public:
  Cutter(const CheckedMesh& mesh, const MeshDistance& body, const glm::dvec3& axis) : mesh_(mesh), body_(body), axis_(axis) {}

  Cell whole() const {
    Cell cell;
    for (std::uint32_t t = 0; t < mesh_.mesh.triangles.size(); ++t) {
      const Facet facet = facet_of(mesh_.mesh, t);
      cell.skin.emplace_back(facet.begin(), facet.end());
    }
    constexpr double ROOM = 1e-3;  // m
    cell.sides = box_sides(to_vec3(mesh_.facts.low) - ROOM, to_vec3(mesh_.facts.high) + ROOM);
    find_hull(cell);
    measure(cell);
    return cell;
  }

  // Both sides of a level.
  std::array<Cell, 2> slabs(const Cell& cell, double height) const {
    std::array<Cell, 2> parts = cut(cell, {{0, height, 0}, {0, 1, 0}});
    for (Cell& part : parts) measure(part);
    return parts;
  }

  // The cut that leaves the least volume in the hulls; none where no cut helps.
  std::optional<std::array<Cell, 2>> halves(const Cell& cell) const {
    std::optional<std::array<Cell, 2>> best;
    double least = UNBOUNDED;
    for (const auto& [plane, extra] : candidates(cell)) {
      std::array<Cell, 2> parts = cut(cell, plane);
      if (!helps(cell, parts)) continue;
      double cost = extra;
      for (const Cell& part : parts)
        if (part.hull) cost += part.hull->volume / cell.hull->volume;
      if (cost >= least) continue;
      least = cost;
      best = std::move(parts);
    }
    if (best)
      for (Cell& part : *best) measure(part);
    return best;
  }

 private:
  static bool helps(const Cell& cell, const std::array<Cell, 2>& parts) {
    return std::all_of(parts.begin(), parts.end(), [&](const Cell& part) {
      return !part.hull || part.hull->volume < (1 - LEAST_PROGRESS) * cell.hull->volume;
    });
  }

  void find_hull(Cell& cell) const {
    std::vector<Triple> points;
    for (const Polygon& polygon : cell.skin)
      for (const glm::dvec3& p : polygon) points.push_back(to_triple(p));
    for (const Polygon& side : cell.sides)
      for (const glm::dvec3& p : side)
        if (body_.signed_distance(to_triple(p)) < -IN_PLANE) points.push_back(to_triple(p));
    cell.hull = convex_hull(points);
  }

  void measure(Cell& cell) const {
    if (!cell.hull) return;
    const auto outside = [this](const Facet& facet) { return facet_outside(facet, mesh_, body_); };
    cell.error = largest_distance(uncovered_facets(cell), outside, CONVEX_TOLERANCE, UNBOUNDED);
  }

  // The hull's facets without those of flat sides that the body's own surface fills: by the bounds of facets alone, large ones would take long.
  std::vector<Facet> uncovered_facets(const Cell& cell) const {
    std::vector<Facet> open = facets_of(*cell.hull), kept;
    const auto order = [](const Facet& a, const Facet& b) { return facet_area(a) > facet_area(b); };
    std::stable_sort(open.begin(), open.end(), order);
    while (!open.empty()) {
      const Facet& first = open.front();
      if (facet_area(first) < SMALL_FACET) break;
      const Plane plane{first[0], glm::normalize(glm::cross(first[1] - first[0], first[2] - first[0]))};
      const auto others = std::stable_partition(open.begin(), open.end(), [&](const Facet& facet) {
        return lies_in({facet.begin(), facet.end()}, plane, IN_PLANE);
      });
      double side = 0, filled = 0;
      for (auto facet = open.begin(); facet != others; ++facet) side += facet_area(*facet);
      for (const Polygon& polygon : cell.skin)
        if (lies_in(polygon, plane, IN_PLANE)) filled += 0.5 * glm::dot(double_area(polygon), plane.normal);
      if (std::abs(filled - side) > SAME_AREA * side) kept.insert(kept.end(), open.begin(), others);
      open.erase(open.begin(), others);
    }
    kept.insert(kept.end(), open.begin(), open.end());
    return kept;
  }

  // Leaves out what lies in the plane and bounds the body on its other side.
  std::vector<Polygon> skin_on(const std::vector<Polygon>& skin, const Plane& plane, double side) const {
    std::vector<Polygon> kept;
    for (const Polygon& polygon : skin) {
      if (mesh_.facts.oriented && lies_in(polygon, plane, IN_PLANE)) {
        if (side * glm::dot(double_area(polygon), plane.normal) < 0) kept.push_back(polygon);
      } else if (Polygon part = clipped(polygon, plane, side); !part.empty()) {
        kept.push_back(std::move(part));
      }
    }
    return kept;
  }

  std::array<Cell, 2> cut(const Cell& cell, const Plane& plane) const {
    std::array<Cell, 2> parts;
    const Polygon section = section_of(cell.sides, plane);
    for (std::size_t k = 0; k < 2; ++k) {
      const double side = k == 0 ? 1 : -1;
      parts[k].skin = skin_on(cell.skin, plane, side);
      parts[k].sides = clipped(cell.sides, plane, side);
      if (!section.empty()) parts[k].sides.push_back(section);
      find_hull(parts[k]);
    }
    return parts;
  }

  bool has_large_side(const Cell& cell, const Plane& plane) const {
    double flat = 0;
    for (const Polygon& polygon : cell.skin)
      if (lies_in(polygon, plane, FLAT_SIDE)) flat += glm::length(double_area(polygon));
    return flat > LARGE_SIDE * glm::length(double_area(section_of(polygons_of(facets_of(*cell.hull)), plane)));
  }

  // Planes through the bottom of the deepest hollow, each with what it costs more than others: along a flat side; as a body of revolution about the
  // axis is cut; along an outer wall, which takes a handle off; across the hull's longest direction; and those that halve the hull's box.
  std::vector<std::pair<Plane, double>> candidates(const Cell& cell) const {
    const glm::dvec3 top = cell.error.place;
    std::uint32_t triangle = 0;
    body_.distance(to_triple(top), triangle);
    const Facet facet = facet_of(mesh_.mesh, triangle);
    const glm::dvec3 bottom = nearest_point(top, facet), turn = glm::cross(facet[1] - facet[0], facet[2] - facet[0]);
    std::vector<std::pair<Plane, double>> planes;
    const auto add = [&](const glm::dvec3& point, const glm::dvec3& normal, double cost) {
      planes.push_back({{point, normal}, cost});
    };
    if (const double size = glm::length(turn); size > 0 && has_large_side(cell, {bottom, turn / size})) add(bottom, turn / size, 0);
    const double x = bottom.x - axis_.x, z = bottom.z - axis_.z, radius = std::hypot(x, z);
    if (radius > 1e-3) {
      const glm::dvec3 outward(x / radius, 0, z / radius), around(-outward.z, 0, outward.x);
      add(bottom, around, 0.001);
      if (plane_distance(*cell.hull, {axis_.x, bottom.y, axis_.z}) < 0) add(axis_, outward, 0.001);
      if (glm::dot(turn, outward) > 0.5 * glm::length(turn)) add(bottom, outward, 0.001);
    }
    add(bottom, {0, 1, 0}, 0.05);
    const double depth = glm::distance(top, bottom);
    if (depth > 0) add(bottom, longest_across(*cell.hull, (top - bottom) / depth), 0.05);
    const Extent extent = extent_of(*cell.hull);
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 normal(0);
      normal[axis] = 1;
      if (extent.high[axis] - extent.low[axis] > 2e-3) add(0.5 * (extent.low + extent.high), normal, 0.2);
    }
    return planes;
  }

  const CheckedMesh& mesh_;
  const MeshDistance& body_;
  glm::dvec3 axis_;
};

struct Piece {
  ConvexHull hull;
  double error = 0;
  Extent extent{};
  int number = 0;
};

bool touch(const Piece& a, const Piece& b) {
  constexpr double APART = 10e-6;  // m
  for (int axis = 0; axis < 3; ++axis)
    if (a.extent.low[axis] > b.extent.high[axis] + APART || b.extent.low[axis] > a.extent.high[axis] + APART) return false;
  return true;
}

// Joins pieces as long as a joint hull stays within the tolerance.
void join_pieces(std::vector<Piece>& pieces, const CheckedMesh& mesh, const MeshDistance& body) {
  std::set<std::pair<int, int>> refused;
  int next = 0;
  for (Piece& piece : pieces) piece.number = next++;
  bool is_changed = true;
  while (is_changed) {
    is_changed = false;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t j = i + 1; j < pieces.size(); ++j) {
        const std::pair pair{pieces[i].number, pieces[j].number};
        if (!touch(pieces[i], pieces[j]) || refused.contains(pair)) continue;
        std::optional<ConvexHull> hull = joint_hull(pieces[i].hull, pieces[j].hull);
        const LargestDistance error =
            hull ? distance_outside(*hull, mesh, body, CONVEX_TOLERANCE, CONVEX_TOLERANCE) : LargestDistance{UNBOUNDED, UNBOUNDED};
        if (error.most > CONVEX_TOLERANCE) {
          refused.insert(pair);
          continue;
        }
        pieces[i] = {std::move(*hull), error.most, {}, next++};
        pieces[i].extent = extent_of(pieces[i].hull);
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
        is_changed = true;
        --j;
      }
    }
  }
}

// Cuts until every piece keeps to the tolerance or there are `most` of them.
std::vector<Piece> cut_pieces(const Cutter& cutter, const std::vector<double>& levels, std::size_t most) {
  const auto is_better = [](const Cell& a, const Cell& b) { return a.error.most < b.error.most; };
  std::vector<Cell> cells;  // a heap, the worst first
  std::vector<Piece> pieces;
  const auto keep = [&](Cell& cell) {
    const Extent extent = extent_of(*cell.hull);
    pieces.push_back({std::move(*cell.hull), cell.error.most, extent, 0});
  };
  const auto add = [&](Cell&& cell) {
    if (!cell.hull) return;
    if (cell.error.most <= CONVEX_TOLERANCE) return keep(cell);
    cells.push_back(std::move(cell));
    std::push_heap(cells.begin(), cells.end(), is_better);
  };
  Cell rest = cutter.whole();
  if (rest.hull && rest.error.most > CONVEX_TOLERANCE) {
    for (const double level : levels) {
      std::array<Cell, 2> slabs = cutter.slabs(rest, level);
      add(std::move(slabs[1]));
      rest = std::move(slabs[0]);
    }
  }
  add(std::move(rest));
  while (!cells.empty()) {
    std::pop_heap(cells.begin(), cells.end(), is_better);
    Cell worst = std::move(cells.back());
    cells.pop_back();
    std::optional<std::array<Cell, 2>> halves;
    if (pieces.size() + cells.size() + 2 <= most) halves = cutter.halves(worst);
    if (!halves) {
      keep(worst);
      continue;
    }
    for (Cell& half : *halves) add(std::move(half));
  }
  return pieces;
}

}  // namespace

// Joining makes room for more cuts, so that a second turn may cut into more pieces than are allowed in the end.
ConvexCover cover_by_pieces(const CheckedMesh& mesh, const MeshDistance& body, std::size_t most_pieces) {
  constexpr int TURNS = 2;
  const LevelRings rings = level_rings(mesh);
  const Cutter cutter(mesh, body, rings.axis);
  ConvexCover best;
  std::size_t budget = most_pieces;
  for (int turn = 0; turn < TURNS; ++turn) {
    std::vector<Piece> pieces = cut_pieces(cutter, rings.levels, budget);
    join_pieces(pieces, mesh, body);
    ConvexCover cover;
    for (Piece& piece : pieces) {
      cover.error = std::max(cover.error, piece.error);
      cover.pieces.push_back(std::move(piece.hull));
    }
    if (cover.pieces.empty()) break;
    if (turn == 0 || (cover.pieces.size() <= most_pieces && cover.error < best.error)) best = std::move(cover);
    if (best.error <= CONVEX_TOLERANCE || 10 * best.pieces.size() > 9 * most_pieces) break;
    budget = std::min(most_pieces * budget / best.pieces.size(), 3 * most_pieces / 2);
  }
  return best;
}

}  // namespace wholehand
