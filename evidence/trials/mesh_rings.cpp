// SPDX-License-Identifier: MIT
#include "evidence/trials/mesh_rings.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <span>
#include <utility>

#include "core/vectors.h"
#include "evidence/trials/surface_bound.h"

namespace wholehand {
namespace {

class RingSearch {
 public:
  explicit RingSearch(const CheckedMesh& mesh) : mesh_(mesh) {
    for_each_edge(edge_uses(mesh.mesh.triangles), [this](std::span<const EdgeUse> uses) {
      if (uses.size() == 2) add(uses);
    });
  }

  LevelRings rings() const {
    constexpr double RING = 60e-3;  // m; the least length
    LevelRings found;
    double longest = RING;
    for (const auto& [place, ring] : rings_) {
      if (place.second && ring.length > RING) found.levels.push_back(ring.moment.y / ring.length);
      if (ring.length <= longest) continue;
      longest = ring.length;
      found.axis = {ring.moment.x / ring.length, 0, ring.moment.z / ring.length};
    }
    return found;
  }

 private:
  struct Ring {
    double length = 0;
    glm::dvec3 moment{};
  };

  void add(std::span<const EdgeUse> uses) {
    constexpr double LEVEL = 20e-6;  // m
    constexpr double SHARP = 0.3;    // sine of the turn
    const glm::dvec3 a = to_vec3(mesh_.mesh.vertices[uses[0].low]), b = to_vec3(mesh_.mesh.vertices[uses[0].high]);
    if (std::abs(a.y - b.y) > LEVEL) return;
    const Facet facet = facet_of(mesh_.mesh, uses[0].triangle), other = facet_of(mesh_.mesh, uses[1].triangle);
    const glm::dvec3 turn = glm::cross(facet[1] - facet[0], facet[2] - facet[0]), from = (other[0] + other[1] + other[2]) / 3.0 - a;
    const glm::dvec3 across = from - glm::dot(from, b - a) / glm::dot(b - a, b - a) * (b - a);
    const double rise = glm::dot(turn, across), size = glm::length(turn) * glm::length(across);
    if (!(std::abs(rise) > SHARP * size)) return;
    Ring& ring = rings_[{std::lround(a.y / LEVEL), rise > 0}];
    ring.length += glm::distance(a, b);
    ring.moment += glm::distance(a, b) * 0.5 * (a + b);
  }

  const CheckedMesh& mesh_;
  std::map<std::pair<long, bool>, Ring> rings_;  // by the height, and whether inward
};

}  // namespace

LevelRings level_rings(const CheckedMesh& mesh) { return RingSearch(mesh).rings(); }

}  // namespace wholehand
