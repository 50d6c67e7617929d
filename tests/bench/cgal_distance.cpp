// SPDX-License-Identifier: MIT
#include "tests/bench/cgal_distance.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <optional>

namespace wholehand::bench {
namespace {

// Each query in the kernel that CGAL's manual advises for it: the plain one for distances, exact predicates for sides.
using Plain = CGAL::Simple_cartesian<double>;
using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;
template <class Kernel>
using Mesh = CGAL::Surface_mesh<typename Kernel::Point_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Plain, CGAL::AABB_face_graph_triangle_primitive<Mesh<Plain>>>>;

template <class Kernel>
Mesh<Kernel> mesh_in(const TriangleMesh& mesh) {
  Mesh<Kernel> made;
  using Vertex = typename Mesh<Kernel>::Vertex_index;
  for (const Triple& p : mesh.vertices) made.add_vertex({p[0], p[1], p[2]});
  for (const auto& [a, b, c] : mesh.triangles) made.add_face(Vertex(a), Vertex(b), Vertex(c));
  return made;
}

}  // namespace

struct CgalDistance::Parts {
  Mesh<Plain> plain;
  Mesh<Exact> exact;
  std::optional<Tree> tree;
  std::optional<CGAL::Side_of_triangle_mesh<Mesh<Exact>, Exact>> side;
};

CgalDistance::CgalDistance(const TriangleMesh& mesh) : parts_(std::make_unique<Parts>()) {
  parts_->plain = mesh_in<Plain>(mesh);
  parts_->exact = mesh_in<Exact>(mesh);
  parts_->tree.emplace(faces(parts_->plain).first, faces(parts_->plain).second, parts_->plain);
  parts_->tree->accelerate_distance_queries();
  parts_->side.emplace(parts_->exact);
  const Triple& p = mesh.vertices.front();
  is_inside(p);  // its tree is built by the first question
}

CgalDistance::~CgalDistance() = default;

double CgalDistance::distance(const Triple& p) const { return std::sqrt(parts_->tree->squared_distance({p[0], p[1], p[2]})); }

bool CgalDistance::is_inside(const Triple& p) const { return (*parts_->side)({p[0], p[1], p[2]}) == CGAL::ON_BOUNDED_SIDE; }

}  // namespace wholehand::bench
