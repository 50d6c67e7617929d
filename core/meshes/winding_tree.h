// SPDX-License-Identifier: MIT
// Generalized winding numbers of open meshes.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

// Barill, Dickson, Schmidt, Levin and Jacobson, "Fast winding numbers for soups and clouds" (2018), with the first term of their expansion: a distant
// cluster of triangles counts as a dipole of its summed area vectors at its center.
class WindingTree {
 public:
  explicit WindingTree(const TriangleMesh& mesh);
  // Opens clusters that are nearer than `opening` times their radius; infinity gives the exact sum.
  double winding_number(const glm::dvec3& p, double opening) const;

 private:
  struct Node {
    glm::dvec3 center{}, area{};        // mean weighted by area, m; summed area vectors, m2
    double radius = 0;                  // about the center, of a ball that encloses the triangles, m
    std::uint32_t first = 0, last = 0;  // of `order_`
    std::uint32_t left = 0, right = 0;  // 0: a leaf
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t last);
  void measure(Node& node) const;
  double exact(const Node& node, const glm::dvec3& p) const;
  glm::dvec3 corner(std::uint32_t triangle, int k) const;

  const TriangleMesh& mesh_;
  std::vector<glm::dvec3> middles_;   // of the triangles
  std::vector<std::uint32_t> order_;  // triangles, grouped by node
  std::vector<Node> nodes_;           // the root is 0
};

// How fast the winding number of an open mesh changes. It jumps where the surface is crossed. Elsewhere it changes as the magnetic potential of a
// current of 1 along the rim does: by the law of Biot and Savart its gradient is at most the integral of dl / (4 pi r2) along the open edges.
class WindingRim {
 public:
  explicit WindingRim(const TriangleMesh& mesh);
  // An upper bound of the gradient's length within `radius` of p, 1/m: infinite if an open edge may be there.
  double slope(const glm::dvec3& p, double radius) const;

 private:
  struct RimEdge {
    glm::dvec3 middle;
    double length;  // times the uses in one direction that the other direction lacks
    double half;    // of its own length
  };
  std::vector<RimEdge> edges_;
};

}  // namespace wholehand
