// SPDX-License-Identifier: MIT
// Signed distance to a mesh by CGAL's AABB tree, beside which core/meshes/distance.h is measured; only where libcgal-dev is installed.
#pragma once

#include <memory>

#include "core/meshes/mesh.h"

namespace wholehand::bench {

class CgalDistance {
 public:
  // Closed, oriented outward. Builds both trees at once.
  explicit CgalDistance(const TriangleMesh& mesh);
  ~CgalDistance();
  double distance(const Triple& p) const;  // m, >= 0
  bool is_inside(const Triple& p) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wholehand::bench
