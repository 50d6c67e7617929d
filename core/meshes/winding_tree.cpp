// SPDX-License-Identifier: MIT
#include "core/meshes/winding_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

#include "core/vectors.h"

namespace wholehand {
namespace {

constexpr std::uint32_t WINDING_LEAF = 8;  // triangles
// Open edges of a mesh: beyond, all of them take longer than what they save, and they are all over the mesh, where they save nothing.
constexpr std::size_t MOST_RIM_EDGES = 20'000;

// The solid angle of a triangle seen from the origin, signed: van Oosterom and Strackee (1983). 0 where it is seen edge on.
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double above = glm::dot(a, glm::cross(b, c));
  const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return above == 0 ? 0 : 2 * std::atan2(above, below);
}

}  // namespace

WindingTree::WindingTree(const TriangleMesh& mesh) : mesh_(mesh), middles_(mesh.triangles.size()), order_(mesh.triangles.size()) {
  for (std::uint32_t i = 0; i < middles_.size(); ++i) middles_[i] = (corner(i, 0) + corner(i, 1) + corner(i, 2)) / 3.0;
  std::iota(order_.begin(), order_.end(), 0u);
  build(0, static_cast<std::uint32_t>(order_.size()));
}

glm::dvec3 WindingTree::corner(std::uint32_t triangle, int k) const {
  return to_vec3(mesh_.vertices[mesh_.triangles[triangle][k]]);
}

// Halves by the median of the middles along the longest side, so the depth is at most 32.
std::uint32_t WindingTree::build(std::uint32_t first, std::uint32_t last) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_[index].first = first;
  nodes_[index].last = last;
  measure(nodes_[index]);
  if (last - first <= WINDING_LEAF) return index;
  glm::dvec3 low = middles_[order_[first]], high = low;
  for (std::uint32_t i = first; i < last; ++i) {
    low = glm::min(low, middles_[order_[i]]);
    high = glm::max(high, middles_[order_[i]]);
  }
  const glm::dvec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) { return middles_[a][axis] < middles_[b][axis]; });
  const std::uint32_t left = build(first, middle), right = build(middle, last);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

void WindingTree::measure(Node& node) const {
  double weight = 0;
  for (std::uint32_t i = node.first; i < node.last; ++i) {
    const std::uint32_t t = order_[i];
    const glm::dvec3 area = glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)) / 2.0;
    node.area += area;
    node.center += glm::length(area) * middles_[t];
    weight += glm::length(area);
  }
  node.center = weight > 0 ? node.center / weight : middles_[order_[node.first]];
  for (std::uint32_t i = node.first; i < node.last; ++i)
    for (int k = 0; k < 3; ++k) node.radius = std::max(node.radius, glm::length(corner(order_[i], k) - node.center));
}

double WindingTree::exact(const Node& node, const glm::dvec3& p) const {
  double angle = 0;
  for (std::uint32_t i = node.first; i < node.last; ++i)
    angle += solid_angle(corner(order_[i], 0) - p, corner(order_[i], 1) - p, corner(order_[i], 2) - p);
  return angle;
}

double WindingTree::winding_number(const glm::dvec3& p, double opening) const {
  double angle = 0;
  std::array<std::uint32_t, 64> waiting{};  // twice the depth
  std::size_t count = 1;
  while (count > 0) {
    const Node& node = nodes_[waiting[--count]];
    const glm::dvec3 there = node.center - p;
    const double away = glm::length(there);
    if (away > opening * node.radius) {
      angle += glm::dot(node.area, there) / (away * away * away);
    } else if (node.left == 0) {
      angle += exact(node, p);
    } else {
      waiting[count++] = node.left;
      waiting[count++] = node.right;
    }
  }
  return angle / (4 * std::numbers::pi);
}

WindingRim::WindingRim(const TriangleMesh& mesh) {
  for_each_edge(edge_uses(mesh.triangles), [&](std::span<const EdgeUse> uses) {
    int net = 0;
    for (const EdgeUse& use : uses) net += use.is_forward ? 1 : -1;
    if (net == 0) return;
    const glm::dvec3 from = to_vec3(mesh.vertices[uses.front().low]), to = to_vec3(mesh.vertices[uses.front().high]);
    const double length = glm::length(to - from);
    edges_.push_back({(from + to) / 2.0, std::abs(net) * length, length / 2});
  });
}

double WindingRim::slope(const glm::dvec3& p, double radius) const {
  constexpr double UNKNOWN = std::numeric_limits<double>::infinity();
  if (edges_.size() > MOST_RIM_EDGES) return UNKNOWN;
  double sum = 0;
  for (const RimEdge& edge : edges_) {
    const double away = glm::length(edge.middle - p) - edge.half - radius;
    if (!(away > 0)) return UNKNOWN;
    sum += edge.length / (away * away);
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace wholehand
