// SPDX-License-Identifier: MIT
// Triangles with shared corners, as every mesh reader makes them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/scene.h"

namespace wholehand {

using Corners = std::array<std::uint32_t, 3>;

// Vessel frame (+y up), m; counter-clockwise seen from outside, if the file is right.
struct TriangleMesh {
  std::vector<Triple> vertices;
  std::vector<Corners> triangles;
  double rounding = 0;           // in the file's unit: the largest displacement of a vertex by single precision
  bool says_what_is_up = false;  // its format does: glTF and Collada
};

constexpr std::size_t MOST_TRIANGLES = 20'000'000;
constexpr std::size_t MOST_MESH_VERTICES = 3 * MOST_TRIANGLES;

// Whether two of a triangle's corners coincide: such a triangle faces nowhere, and its place does not matter.
bool is_point_or_edge(const TriangleMesh& mesh, const Corners& triangle);

// The largest displacement by single precision of a point with these coordinates.
double single_rounding(const Triple& point);

// Where the upright line through (x, z) meets a triangle: its y, in the mesh's unit. A line through an edge or a corner that triangles share meets as
// many of them as a line beside it, so that each line meets a closed mesh an even number of times.
std::optional<double> crossing_height(const TriangleMesh& mesh, const Corners& triangle, double x, double z);

// Whether the way straight up from a point crosses the mesh an odd number of times. Visits all triangles.
bool is_enclosed(const TriangleMesh& mesh, const Triple& p);

// Finds the first of equal vertices: a hash table with open addressing, which joins the corners of an STL in less time than a sort. -0 equals 0. Keeps
// a reference to `vertices`.
class EqualVertices {
 public:
  explicit EqualVertices(const std::vector<Triple>& vertices);
  // The vertex first asked for of those that equal this one.
  std::uint32_t first_equal(std::uint32_t vertex);

 private:
  const std::vector<Triple>& vertices_;
  std::size_t mask_;
  std::vector<std::uint32_t> table_;
};

// One triangle's use of an edge.
struct EdgeUse {
  std::uint32_t low, high;  // vertices, low < high
  std::uint32_t triangle;
  bool is_forward;  // runs from low to high
};

// The uses of all edges, grouped by edge, in the order of the triangles.
std::vector<EdgeUse> edge_uses(const std::vector<Corners>& triangles);

// Calls `visit` with all uses of an edge, for each edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, const Visit& visit) {
  for (std::size_t first = 0, next = 0; first < uses.size(); first = next) {
    for (next = first; next < uses.size() && uses[next].low == uses[first].low && uses[next].high == uses[first].high;) ++next;
    visit(std::span(uses).subspan(first, next - first));
  }
}

}  // namespace wholehand
