// SPDX-License-Identifier: MIT
#include "core/meshes/holes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vectors.h"

namespace wholehand {
namespace {

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
  Triple low = mesh.vertices[hole.corners[0]], high = low;
  for (std::size_t i = 0; i < hole.corners.size(); ++i) {
    const Triple &p = mesh.vertices[hole.corners[i]], &q = mesh.vertices[hole.corners[(i + 1) % hole.corners.size()]];
    hole.length += distance(q, p);
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  hole.across = distance(high, low);
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

}  // namespace

MeshHoles find_holes(const TriangleMesh& mesh) { return LoopWalk(mesh, open_edges(mesh)).walk(); }

bool is_small_hole(const MeshHole& hole, double extent) {
  return hole.corners.size() >= 3 && hole.across <= SMALL_HOLE * extent && hole.length <= SMALL_HOLE_EDGE * extent;
}

void close_hole(const MeshHole& hole, TriangleMesh& mesh) {
  const std::vector<std::uint32_t>& corners = hole.corners;
  if (corners.size() == 3) {
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  Triple middle{};
  for (const std::uint32_t corner : corners)
    for (int k = 0; k < 3; ++k) middle[k] += mesh.vertices[corner][k] / static_cast<double>(corners.size());
  const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(middle);
  for (std::size_t i = 0; i < corners.size(); ++i)
    mesh.triangles.push_back({corners[i], corners[(i + 1) % corners.size()], center});
}

}  // namespace wholehand
