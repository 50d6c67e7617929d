// SPDX-License-Identifier: MIT
#include "objects/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "core/vectors.h"
#include "objects/holes.h"
#include "system/readable.h"

namespace wholehand {
namespace {

constexpr double LARGE_MESH = 10;         // m: nothing that a hand holds
constexpr double SMALL_MESH = 2e-3;       // m: likewise
constexpr double LEAST_THICKNESS = 1e-9;  // volume over area, of the largest extent: below it, rounding
constexpr double LEAST_HEIGHT = 1e-12;    // of a triangle, of its longest edge: below it, rounding

glm::dvec3 corner_of(const TriangleMesh& mesh, std::uint32_t vertex) { return to_vec3(mesh.vertices[vertex]); }

// Leaves out triangles that are there before, with the same corners in the same turn: copies one upon the other bound the same body, and make each
// distance as many times as slow. Returns how many.
std::size_t drop_repeated(TriangleMesh& mesh) {
  const auto least_first = [&](std::uint32_t i) {
    const auto& [a, b, c] = mesh.triangles[i];
    if (a < b && a < c) return std::array{a, b, c};
    return b < c ? std::array{b, c, a} : std::array{c, a, b};
  };
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const auto one = least_first(i), other = least_first(j);
    return one != other ? one < other : i < j;
  });
  std::vector<bool> is_repeated(order.size());
  for (std::size_t i = 1; i < order.size(); ++i) is_repeated[order[i]] = least_first(order[i]) == least_first(order[i - 1]);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (!is_repeated[i]) mesh.triangles[kept++] = mesh.triangles[i];
  mesh.triangles.resize(kept);
  return order.size() - kept;
}

// The mesh with equal vertices joined and those that no triangle uses left out, nor triangles that are points or edges; the order is that of
// the vertices' coordinates.
TriangleMesh weld(const TriangleMesh& mesh, MeshFacts& facts) {
  std::vector<bool> used(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles) {
    if (is_point_or_edge(mesh, triangle)) continue;
    for (const std::uint32_t corner : triangle) used[corner] = true;
  }
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
    if (used[i]) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return mesh.vertices[a] < mesh.vertices[b]; });
  TriangleMesh welded;
  std::vector<std::uint32_t> place(mesh.vertices.size());
  for (const std::uint32_t i : order) {
    if (welded.vertices.empty() || welded.vertices.back() != mesh.vertices[i]) welded.vertices.push_back(mesh.vertices[i]);
    place[i] = static_cast<std::uint32_t>(welded.vertices.size() - 1);
  }
  for (const auto& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle;
    if (!is_point_or_edge(mesh, triangle)) welded.triangles.push_back({place[a], place[b], place[c]});
  }
  facts.triangles = mesh.triangles.size();
  facts.zero_triangles = mesh.triangles.size() - welded.triangles.size();
  facts.joined_corners = order.size() - welded.vertices.size();
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

// One use of an edge: its ends in order of number, and whether it runs from the larger. Fits a word, as there are fewer than 2^31 vertices.
std::uint64_t edge_use(std::uint32_t from, std::uint32_t to) {
  const std::uint64_t low = std::min(from, to), high = std::max(from, to);
  return low << 32 | high << 1 | (from > to ? 1 : 0);
}

// Counts edges, and returns the mean of the open ones' middles; the box's middle where none is open.
glm::dvec3 count_edges(const TriangleMesh& mesh, MeshFacts& facts) {
  facts.open_edges = facts.non_manifold_edges = facts.inverted_pairs = 0;
  std::vector<std::uint64_t> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) uses.insert(uses.end(), {edge_use(a, b), edge_use(b, c), edge_use(c, a)});
  std::sort(uses.begin(), uses.end());
  facts.closed = facts.oriented = true;
  glm::dvec3 rim(0);
  for (std::size_t first = 0, next = 0; first < uses.size(); first = next) {
    std::size_t backward = 0;
    for (next = first; next < uses.size() && uses[next] >> 1 == uses[first] >> 1; ++next) backward += uses[next] & 1u;
    const std::size_t count = next - first;
    if (count % 2 == 1) facts.closed = false;
    if (2 * backward > count + 1 || 2 * backward + 1 < count) facts.oriented = false;
    if (count > 2) ++facts.non_manifold_edges;
    if (count == 2 && backward != 1) ++facts.inverted_pairs;
    if (count != 1) continue;
    ++facts.open_edges;
    const auto low = static_cast<std::uint32_t>(uses[first] >> 32),
               high = static_cast<std::uint32_t>(uses[first] >> 1 & 0x7FFFFFFFu);
    rim += (corner_of(mesh, low) + corner_of(mesh, high)) / 2.0;
  }
  if (facts.open_edges > 0) return rim / static_cast<double>(facts.open_edges);
  return {(facts.low[0] + facts.high[0]) / 2, (facts.low[1] + facts.high[1]) / 2, (facts.low[2] + facts.high[2]) / 2};
}

// Sums the tetrahedra of the triangles and `apex`, signed: volume and its centre.
void measure_volume(const TriangleMesh& mesh, const glm::dvec3& apex, MeshFacts& facts) {
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
  double extent = 0;
  for (int k = 0; k < 3; ++k) extent = std::max(extent, facts.high[k] - facts.low[k]);
  return extent;
}

void turn_round(TriangleMesh& mesh, MeshFacts& facts) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  facts.volume = -facts.volume;
  facts.was_inside_out = true;
}

const char* was(std::size_t count) { return count == 1 ? "was" : "were"; }

// The mesh's extent along an axis, mm.
std::string span_text(const MeshFacts& facts, int axis) {
  return fmt::format("{:.4g} to {:.4g}", 1e3 * facts.low[axis], 1e3 * facts.high[axis]);
}

// Closes all holes, or says why not; without the wish only measures them.
void note_holes(TriangleMesh& mesh, const std::string& name, bool close_holes, MeshFacts& facts) {
  const MeshHoles holes = find_holes(mesh);
  const double extent = largest_extent(facts);
  for (const MeshHole& hole : holes.loops) {
    facts.widest_hole = std::max(facts.widest_hole, hole.across);
    if (close_holes && !is_small_hole(hole, extent))
      throw usage_error(fmt::format(
          "{}: close_holes: a hole is {:.4g} mm across, its edge {:.4g} mm long, and at most {:.4g} and {:.4g} mm are closed: "
          "close it where the mesh was made, or leave out close_holes",
          name, 1e3 * hole.across, 1e3 * hole.length, 1e3 * SMALL_HOLE * extent, 1e3 * SMALL_HOLE_EDGE * extent));
  }
  if (close_holes && holes.loose_edges > 0)
    throw usage_error(
        fmt::format("{}: close_holes: {} form no loop, as triangles beside them face opposite ways: let all face outward where the "
                    "mesh was made, or leave out close_holes",
                    name, counted(holes.loose_edges, "open edge")));
  facts.holes = holes.loops.size();
  facts.closable = holes.loose_edges == 0 && std::all_of(holes.loops.begin(), holes.loops.end(),
                                                         [&](const MeshHole& hole) { return is_small_hole(hole, extent); });
  if (!close_holes) return;
  for (const MeshHole& hole : holes.loops) close_hole(hole, mesh);
  facts.closed_holes = std::exchange(facts.holes, 0);
  facts.widest_closed_hole = std::exchange(facts.widest_hole, 0);
}

// What an open mesh might do about it.
std::string holes_text(const MeshFacts& facts) {
  if (facts.holes == 0) return ": close them for a sure answer.";
  const std::string holes = fmt::format(": {}, up to {:.4g} mm across, ", counted(facts.holes, "hole"), 1e3 * facts.widest_hole);
  if (facts.closable) return holes + "which close_holes = true closes.";
  if (facts.widest_hole > SMALL_HOLE * largest_extent(facts))
    return holes + fmt::format("more than the {:.4g} mm that close_holes closes: close them for a sure answer.",
                               1e3 * SMALL_HOLE * largest_extent(facts));
  return holes + "which close_holes does not close, as an edge is too long or forms no loop: close them for a sure answer.";
}

}  // namespace

CheckedMesh check_mesh(const TriangleMesh& mesh, const std::string& name, bool close_holes) {
  CheckedMesh checked;
  MeshFacts& facts = checked.facts;
  checked.mesh = weld(mesh, facts);
  if (checked.mesh.triangles.empty()) throw usage_error(name + ": has no triangle with an area");
  measure_extent(checked.mesh, facts);
  glm::dvec3 rim = count_edges(checked.mesh, facts);
  if (facts.non_manifold_edges > 0) {
    facts.repeated_triangles = drop_repeated(checked.mesh);
    if (facts.repeated_triangles > 0) rim = count_edges(checked.mesh, facts);
  }
  if (facts.open_edges > 0) {
    note_holes(checked.mesh, name, close_holes, facts);
    if (facts.closed_holes > 0) rim = count_edges(checked.mesh, facts);
  }
  measure_volume(checked.mesh, rim, facts);
  if (!(std::abs(facts.volume) > LEAST_THICKNESS * facts.area * largest_extent(facts))) {
    throw usage_error(name +
                      ": encloses no volume (a flat sheet, or surfaces that cancel), so it has no inside: give it a thickness");
  }
  if (facts.volume < 0) turn_round(checked.mesh, facts);
  return checked;
}

std::string mesh_check_text(const MeshFacts& facts) {
  std::string text =
      fmt::format("{}, {:.4g} x {:.4g} x {:.4g} mm (x {}, y {}, z {}), ", counted(facts.triangles, "triangle"),
                  1e3 * (facts.high[0] - facts.low[0]), 1e3 * (facts.high[1] - facts.low[1]), 1e3 * (facts.high[2] - facts.low[2]),
                  span_text(facts, 0), span_text(facts, 1), span_text(facts, 2));
  text += facts.closed ? "closed" : fmt::format("not closed ({})", counted(facts.open_edges, "open edge"));
  text += fmt::format("; {}, {}, {}; volume {:.4g} cm3, centre of mass ({:.4g}, {:.4g}, {:.4g}) mm.",
                      counted(facts.non_manifold_edges, "non-manifold edge"), counted(facts.inverted_pairs, "inverted pair"),
                      counted(facts.zero_triangles, "triangle") + " without area", 1e6 * facts.volume,
                      1e3 * facts.center_of_mass[0], 1e3 * facts.center_of_mass[1], 1e3 * facts.center_of_mass[2]);
  if (facts.joined_corners > 0)
    text +=
        fmt::format(" {} {} equal to others joined with them.", counted(facts.joined_corners, "corner"), was(facts.joined_corners));
  if (facts.repeated_triangles > 0)
    text += fmt::format(" {} {} there before and left out.", counted(facts.repeated_triangles, "triangle"),
                        was(facts.repeated_triangles));
  if (facts.closed_holes > 0)
    text += fmt::format(" {} {} closed, up to {:.4g} mm across.", counted(facts.closed_holes, "hole"), was(facts.closed_holes),
                        1e3 * facts.widest_closed_hole);
  if (facts.was_inside_out) text += " It was inside out and has been turned round.";
  if (!facts.closed)
    text += " What lies inside is judged by the winding number, which guesses across the holes" + holes_text(facts);
  if (!facts.oriented) text += " Its triangles do not all face outward, so volume and centre of mass are not to be trusted.";
  return text;
}

// Exporters that forget the unit write millimetres, centimetres or inches as if they were metres, or the other way about.
std::string mesh_size_warning(const MeshFacts& facts, double scale) {
  const double extent = largest_extent(facts);
  if (extent > SMALL_MESH && extent <= LARGE_MESH) return "";
  const bool is_large = extent > LARGE_MESH;
  double factor = is_large ? (extent > 20 ? 0.001 : 0.01) : extent >= 0.5e-3 ? 100 : extent >= 0.5e-6 ? 1000 : 1e6;
  if (scale * factor > 0.999 && scale * factor < 1.001) factor = 1 / scale;  // so that 1 is written as 1
  return fmt::format(
      "it is {:.4g} {} large: its numbers{} are taken as metres; the likely scale is mesh_scale = {:.6g}, with which it is {:.4g} "
      "mm large",
      is_large ? extent : 1e3 * extent, is_large ? "m" : "mm", scale == 1 ? "" : fmt::format(" times {:.6g}", scale),
      scale * factor, 1e3 * factor * extent);
}

}  // namespace wholehand
