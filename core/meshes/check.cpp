// SPDX-License-Identifier: MIT
#include "core/meshes/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/meshes/holes.h"
#include "core/meshes/orientation.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

constexpr double LEAST_THICKNESS = 1e-9;  // volume over area, of the largest extent: below it, rounding
constexpr double LEAST_HEIGHT = 1e-12;    // of a triangle, of its longest edge: below it, rounding
constexpr std::uint32_t NO_VERTEX = ~0u;

glm::dvec3 corner_of(const TriangleMesh& mesh, std::uint32_t vertex) { return to_vec3(mesh.vertices[vertex]); }

// The mesh with equal vertices joined and those that no triangle uses left out, nor triangles that are points or edges; the order is that of
// the vertices' coordinates.
TriangleMesh weld(const TriangleMesh& mesh, MeshFacts& facts) {
  struct KeptVertex {
    Triple at;
    std::uint32_t vertex;
  };
  EqualVertices equal(mesh.vertices);
  std::vector<std::uint32_t> first(mesh.vertices.size(), NO_VERTEX);
  std::vector<KeptVertex> kept;
  for (const auto& triangle : mesh.triangles) {
    if (is_point_or_edge(mesh, triangle)) continue;
    for (const std::uint32_t corner : triangle) {
      if (first[corner] != NO_VERTEX) continue;
      first[corner] = equal.first_equal(corner);
      if (first[corner] == corner) {
        kept.push_back({mesh.vertices[corner], corner});
      } else {
        ++facts.joined_corners;
      }
    }
  }
  std::sort(kept.begin(), kept.end(), [](const KeptVertex& a, const KeptVertex& b) { return a.at < b.at; });
  TriangleMesh welded;
  welded.vertices.reserve(kept.size());
  std::vector<std::uint32_t> place(mesh.vertices.size());
  for (const auto& [at, vertex] : kept) {
    place[vertex] = static_cast<std::uint32_t>(welded.vertices.size());
    welded.vertices.push_back(at);
  }
  welded.triangles.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle;
    if (!is_point_or_edge(mesh, triangle)) welded.triangles.push_back({place[first[a]], place[first[b]], place[first[c]]});
  }
  facts.triangles = mesh.triangles.size();
  facts.zero_triangles = mesh.triangles.size() - welded.triangles.size();
  return welded;
}

void measure_extent(const TriangleMesh& mesh, MeshFacts& facts) {
  facts.low = facts.high = mesh.vertices.front();
  for (const Triple& vertex : mesh.vertices)
    for (int k = 0; k < 3; ++k) {
      facts.low[k] = std::min(facts.low[k], vertex[k]);
      facts.high[k] = std::max(facts.high[k], vertex[k]);
    }
}

// Counts edges, and returns the mean of the open ones' middles; the box's middle where none is open.
Triple count_edges(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses, MeshFacts& facts) {
  facts.open_edges = facts.non_manifold_edges = facts.odd_edges = facts.inverted_pairs = 0;
  facts.closed = facts.oriented = true;
  glm::dvec3 rim(0);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    const auto count = static_cast<std::ptrdiff_t>(edge.size()),
               forward = std::count_if(edge.begin(), edge.end(), [](const EdgeUse&use) { return use.is_forward; });
    if (count % 2 == 1) facts.closed = false;
    if (std::abs(2 * forward - count) > 1) facts.oriented = false;
    if (count > 2) ++facts.non_manifold_edges;
    if (count > 2 && count % 2 == 1) ++facts.odd_edges;
    if (count == 2 && forward != 1) ++facts.inverted_pairs;
    if (count != 1) return;
    ++facts.open_edges;
    rim += (corner_of(mesh, edge[0].low) + corner_of(mesh, edge[0].high)) / 2.0;
  });
  if (facts.open_edges > 0) return to_triple(rim / static_cast<double>(facts.open_edges));
  return {(facts.low[0] + facts.high[0]) / 2, (facts.low[1] + facts.high[1]) / 2, (facts.low[2] + facts.high[2]) / 2};
}

// Sums the tetrahedra of the triangles and `apex`, signed: volume and its center.
void measure_volume(const TriangleMesh& mesh, const Triple& from, MeshFacts& facts) {
  const glm::dvec3 apex = to_vec3(from);
  glm::dvec3 moment(0);
  for (const auto& triangle : mesh.triangles) {
    const glm::dvec3 a = corner_of(mesh, triangle[0]) - apex, b = corner_of(mesh, triangle[1]) - apex,
                     c = corner_of(mesh, triangle[2]) - apex;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double doubled = glm::length(normal), edge = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    if (doubled <= LEAST_HEIGHT * edge * edge) ++facts.zero_triangles;
    const double part = glm::dot(a, glm::cross(b, c)) / 6;
    facts.area += doubled / 2;
    facts.volume += part;
    moment += part / 4 * (a + b + c);
  }
  const glm::dvec3 center = apex + (facts.volume != 0 ? moment / facts.volume : glm::dvec3(0));
  facts.center_of_mass = to_triple(center);
}

double largest_extent(const MeshFacts& facts) {
  const Triple size = facts.size();
  return *std::max_element(size.begin(), size.end());
}

const char* was(std::size_t count) { return count == 1 ? "was" : "were"; }

// Takes m.
std::string millimeters(double length) { return plain_text(1e3 * length, 4); }

// The mesh's extent along an axis, mm.
std::string span_text(const MeshFacts& facts, int axis) {
  return millimeters(facts.low[axis]) + " to " + millimeters(facts.high[axis]);
}

// Closes all holes, or says why not; unless the scene asks for that, only measures them.
void note_holes(TriangleMesh& mesh, const std::string& name, bool closes, MeshFacts& facts) {
  const MeshHoles holes = find_holes(mesh);
  const double extent = largest_extent(facts);
  const HoleClosing closing = plan_closing(mesh, holes, extent);
  double longest = 0;  // edge of a hole that stays open
  for (const std::size_t i : closing.open) {
    facts.widest_open_hole = std::max(facts.widest_open_hole, holes.loops[i].across);
    longest = std::max(longest, holes.loops[i].length);
  }
  if (closes && !closing.open.empty()) {
    const bool is_one = closing.open.size() == 1;
    throw usage_error(fmt::format(
        "{}: close_holes: {} of {} {} neither flat nor small, up to {} mm across and {} mm along the edge, and at most {} "
        "and {} mm are closed: close {} where the mesh was made, or leave out close_holes",
        name, readable_number(closing.open.size()), counted(holes.loops.size(), "hole"), is_one ? "is" : "are",
        millimeters(facts.widest_open_hole), millimeters(longest), millimeters(SMALL_HOLE * extent),
        millimeters(SMALL_HOLE_EDGE * extent), is_one ? "it" : "them"));
  }
  if (closes && holes.loose_edges > 0)
    throw usage_error(
        fmt::format("{}: close_holes: {} form no loop, as {}: remove it where the mesh was made, or leave out close_holes", name,
                    counted(holes.loose_edges, "open edge"),
                    facts.non_manifold_edges > 0 ? "a surface meets others there" : "the surface has one side only"));
  for (const MeshHole& hole : holes.loops) facts.widest_hole = std::max(facts.widest_hole, hole.across);
  facts.holes = holes.loops.size();
  facts.open_holes = closing.open.size();
  facts.closable = holes.loose_edges == 0 && closing.open.empty();
  if (!closes) return;
  close_holes(holes, closing, mesh);
  facts.closed_holes = std::exchange(facts.holes, 0);
  facts.widest_closed_hole = std::exchange(facts.widest_hole, 0);
}

// The remedy for an open mesh.
std::string holes_text(const MeshFacts& facts) {
  if (facts.holes == 0) return ": close them for a sure answer.";
  const std::string holes = fmt::format(": {}, up to {} mm across, ", counted(facts.holes, "hole"), millimeters(facts.widest_hole));
  if (facts.closable) return holes + "which close_holes = true closes.";
  if (facts.open_holes > 0)
    return holes + fmt::format(
                       "which close_holes does not close, as {}, up to {} mm across, {} neither flat nor small: close them for "
                       "a sure answer.",
                       readable_number(facts.open_holes), millimeters(facts.widest_open_hole),
                       facts.open_holes == 1 ? "is" : "are");
  return holes + "which close_holes does not close, as an edge forms no loop: close them for a sure answer.";
}

}  // namespace

CheckedMesh check_mesh(const TriangleMesh& mesh, const std::string& name, bool close_holes) {
  CheckedMesh checked;
  MeshFacts& facts = checked.facts;
  checked.mesh = weld(mesh, facts);
  if (checked.mesh.triangles.empty()) throw usage_error(name + ": has no triangle with an area");
  measure_extent(checked.mesh, facts);
  std::vector<EdgeUse> uses = edge_uses(checked.mesh.triangles);
  Triple rim = count_edges(checked.mesh, uses, facts);
  if (facts.non_manifold_edges > 0) {
    const DoubledTriangles doubled = drop_doubled(checked.mesh, uses);
    facts.repeated_triangles = doubled.copies;
    facts.back_triangles = doubled.backs;
    rim = count_edges(checked.mesh, uses, facts);
  }
  std::vector<bool> turned(checked.mesh.triangles.size());
  if (facts.inverted_pairs > 0) {
    make_consistent(checked.mesh, uses, turned);
    rim = count_edges(checked.mesh, uses, facts);
  }
  facts.closes_nothing = close_holes && facts.open_edges == 0;
  if (facts.open_edges > 0) {
    note_holes(checked.mesh, name, close_holes, facts);
    if (facts.closed_holes > 0) uses = edge_uses(checked.mesh.triangles);
    if (facts.closed_holes > 0) rim = count_edges(checked.mesh, uses, facts);
  }
  const std::size_t own = turned.size();
  turned.resize(checked.mesh.triangles.size());  // what closes a hole was never turned
  turn_outward(checked.mesh, uses, rim, turned);
  rim = count_edges(checked.mesh, uses, facts);
  facts.turned_triangles =
      static_cast<std::size_t>(std::count(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(own), true));
  facts.was_inside_out = facts.turned_triangles == own;
  measure_volume(checked.mesh, rim, facts);
  if (facts.has_sure_volume() && !(facts.volume > LEAST_THICKNESS * facts.area * largest_extent(facts)))
    throw usage_error(name +
                      ": encloses no volume (a flat sheet, or surfaces that cancel), so it has no inside: give it a thickness in a "
                      "modeling program");
  return checked;
}

std::string filled_text(double volume, const Triple& center) {
  const auto hundredths = [](double length) { return plain_text(std::round(1e5 * length) / 100); };
  return fmt::format("{} cm3, center of mass ({}, {}, {}) mm", plain_text(1e6 * volume, 4), hundredths(center[0]),
                     hundredths(center[1]), hundredths(center[2]));
}

std::string mesh_check_text(const MeshFacts& facts) {
  std::string text =
      fmt::format("{}, {} x {} x {} mm (x {}, y {}, z {}), ", counted(facts.triangles, "triangle"),
                  millimeters(facts.high[0] - facts.low[0]), millimeters(facts.high[1] - facts.low[1]),
                  millimeters(facts.high[2] - facts.low[2]), span_text(facts, 0), span_text(facts, 1), span_text(facts, 2));
  text += facts.closed           ? "closed"
          : facts.open_edges > 0 ? fmt::format("not closed ({})", counted(facts.open_edges, "open edge"))
                                 : "not closed";
  text += fmt::format("; {}, {}, {}; ", counted(facts.non_manifold_edges, "non-manifold edge"),
                      counted(facts.inverted_pairs, "inverted pair"), counted(facts.zero_triangles, "triangle") + " without area");
  text += facts.has_sure_volume() ? fmt::format("its triangles enclose {}.", filled_text(facts.volume, facts.center_of_mass))
                                  : "volume by its lattice.";
  if (facts.joined_corners > 0)
    text +=
        fmt::format(" {} {} equal to others joined with them.", counted(facts.joined_corners, "corner"), was(facts.joined_corners));
  if (facts.repeated_triangles > 0)
    text += fmt::format(" {} {} there before and left out.", counted(facts.repeated_triangles, "triangle"),
                        was(facts.repeated_triangles));
  if (facts.back_triangles > 0)
    text += fmt::format(" {} lay upon others that face the other way and {} left out.", counted(facts.back_triangles, "triangle"),
                        was(facts.back_triangles));
  if (facts.closed_holes > 0)
    text += fmt::format(" {} {} closed, up to {} mm across.", counted(facts.closed_holes, "hole"), was(facts.closed_holes),
                        millimeters(facts.widest_closed_hole));
  if (facts.oriented && facts.was_inside_out) {
    text += " It was inside out and has been turned round.";
  } else if (facts.oriented && facts.turned_triangles > 0) {
    text += fmt::format(" {} faced inward and {} turned outward.", counted(facts.turned_triangles, "triangle"),
                        was(facts.turned_triangles));
  }
  if (facts.thickness > 0) text += fmt::format(" The sheet has walls of {} mm behind it.", millimeters(facts.thickness));
  if (facts.closes_nothing) text += " close_holes closes nothing: no edge is open.";
  if (facts.holes > 0 || (facts.open_edges > 0 && facts.odd_edges == 0 && facts.oriented))
    text += " What lies inside is judged by the winding number, which guesses across the holes" + holes_text(facts);
  if (facts.odd_edges > 0)
    text += fmt::format(" At {} a wall or a fin ends on the body, and the winding number guesses what lies beside it: remove it.",
                        counted(facts.odd_edges, "edge") + " of three triangles or more");
  if (!facts.oriented)
    text +=
        " Its triangles cannot all face outward, as the surface has one side only or parts that meet at edges: make one body of "
        "it.";
  return text;
}

}  // namespace wholehand
