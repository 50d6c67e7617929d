// SPDX-License-Identifier: MIT
#include "core/meshes/triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace wholehand {
namespace {

constexpr std::uint32_t EMPTY_SLOT = ~0u;

std::size_t vertex_hash(const Triple& vertex) {
  std::uint64_t mixed = 0;
  for (const double x : vertex) {
    mixed = (mixed ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9E3779B97F4A7C15u;  // + 0.0: -0 and 0 are equal
    mixed ^= mixed >> 32;
  }
  return mixed;
}

// Whether the ray from (x, z) along +x meets the edge, seen from above. An edge has its end of lower z and lacks the other one, so that a ray through
// a corner meets one edge of two that go on. Both triangles at an edge round alike, as the order of its ends does not matter.
bool ray_meets_edge(const Triple& a, const Triple& b, double x, double z) {
  if ((a[2] > z) == (b[2] > z)) return false;
  const Triple &low = a[2] < b[2] ? a : b, &high = a[2] < b[2] ? b : a;
  const double met = low[0] + (z - low[2]) / (high[2] - low[2]) * (high[0] - low[0]);
  return std::clamp(met, std::min(a[0], b[0]), std::max(a[0], b[0])) > x;
}

}  // namespace

bool is_point_or_edge(const TriangleMesh& mesh, const Corners& triangle) {
  const Triple &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
  return a == b || b == c || c == a;
}

double single_rounding(const Triple& point) {
  return 0x1p-24 * std::max({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
}

std::optional<double> crossing_height(const TriangleMesh& mesh, const Corners& triangle, double x, double z) {
  const Triple &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
  const bool meets_ab = ray_meets_edge(a, b, x, z), meets_bc = ray_meets_edge(b, c, x, z), meets_ca = ray_meets_edge(c, a, x, z);
  if ((meets_ab != meets_bc) == meets_ca) return {};
  const auto turn = [&](const Triple& from, const Triple& to) { return (from[0] - x) * (to[2] - z) - (from[2] - z) * (to[0] - x); };
  const double ab = turn(a, b), bc = turn(b, c), ca = turn(c, a), area = ab + bc + ca;
  // an upright triangle is met only by rounding, somewhere in its height
  const double height = area != 0 ? (bc * a[1] + ca * b[1] + ab * c[1]) / area : (a[1] + b[1] + c[1]) / 3;
  return std::clamp(height, std::min({a[1], b[1], c[1]}), std::max({a[1], b[1], c[1]}));
}

bool is_enclosed(const TriangleMesh& mesh, const Triple& p) {
  bool is_inside = false;
  for (const Corners& triangle : mesh.triangles) {
    const std::optional<double> height = crossing_height(mesh, triangle, p[0], p[2]);
    if (height && *height > p[1]) is_inside = !is_inside;
  }
  return is_inside;
}

EqualVertices::EqualVertices(const std::vector<Triple>& vertices)
    : vertices_(vertices), mask_(std::bit_ceil(2 * vertices.size() + 1) - 1), table_(mask_ + 1, EMPTY_SLOT) {}

std::uint32_t EqualVertices::first_equal(std::uint32_t vertex) {
  std::size_t slot = vertex_hash(vertices_[vertex]) & mask_;
  while (table_[slot] != EMPTY_SLOT && vertices_[table_[slot]] != vertices_[vertex]) slot = (slot + 1) & mask_;
  if (table_[slot] == EMPTY_SLOT) table_[slot] = vertex;
  return table_[slot];
}

// Sorts by `low` in one pass, as vertices can be counted; each vertex then has a few edges to sort. A plain sort takes three times as long.
std::vector<EdgeUse> edge_uses(const std::vector<Corners>& triangles) {
  std::uint32_t vertices = 0;
  for (const Corners& triangle : triangles) vertices = std::max({vertices, triangle[0] + 1, triangle[1] + 1, triangle[2] + 1});
  std::vector<std::size_t> next(vertices + std::size_t{1});  // of each vertex: where its next edge goes
  const auto for_each_use = [&](const auto& take) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
        take(EdgeUse{std::min(from, to), std::max(from, to), t, from < to});
      }
  };
  for_each_use([&](const EdgeUse& use) { ++next[use.low + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<EdgeUse> uses(3 * triangles.size());
  for_each_use([&](const EdgeUse& use) { uses[next[use.low]++] = use; });
  auto first = uses.begin();
  for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
    const auto last = uses.begin() + static_cast<std::ptrdiff_t>(next[vertex]);
    std::sort(first, last,
              [](const EdgeUse& a, const EdgeUse& b) { return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle); });
    first = last;
  }
  return uses;
}

}  // namespace wholehand
