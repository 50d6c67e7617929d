// SPDX-License-Identifier: MIT
// Signed distance to a triangle mesh.
#pragma once

#include <cstdint>
#include <memory>

#include "core/meshes/check.h"
#include "core/scene.h"

namespace wholehand {

// How inside is distinguished from outside; see docs/mesh.md.
enum class MeshSign {
  crossings,  // closed, and all faces outward: signed crossings of a ray, inside where they do not cancel
  parity,     // closed, not all outward: inside where the crossings are odd
  winding     // open: generalized winding number above one half
};

// Any number of threads may ask at once.
class MeshDistance {
 public:
  // Keeps a reference to `mesh`. Throws Error (failure) where Embree cannot be started or runs out of memory.
  explicit MeshDistance(const CheckedMesh& mesh);
  ~MeshDistance();
  MeshDistance(const MeshDistance&) = delete;
  MeshDistance& operator=(const MeshDistance&) = delete;

  MeshSign sign() const;
  // Distance to the nearest triangle, m, in double precision, negative inside. `p`: vessel frame, m, finite.
  double signed_distance(const Triple& p) const;
  // The distance without its sign, >= 0. `nearest`: a triangle's number, from 0, near for a short search; on return the nearest one's.
  double distance(const Triple& p, std::uint32_t& nearest) const;
  bool is_inside(const Triple& p) const;
  // The solid angle under which p sees the surface from inside, over 4 pi: of a closed mesh 1 inside and 0 outside,
  // of an open one to 1e-3.
  double winding_number(const Triple& p) const;

 private:
  friend struct MeshQueries;  // the callbacks
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wholehand
