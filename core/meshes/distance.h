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
  parity,     // closed, not all outward: inside if the number of crossings is odd
  winding     // open: generalized winding number above one half
};

// Any number of threads may ask at once.
class MeshDistance {
 public:
  // Keeps a reference to `mesh`. Throws Error (failure) if Embree cannot start or runs out of memory.
  explicit MeshDistance(const CheckedMesh& mesh);
  ~MeshDistance();
  MeshDistance(const MeshDistance&) = delete;
  MeshDistance& operator=(const MeshDistance&) = delete;

  MeshSign sign() const;
  // Distance to the nearest triangle, m, in double precision, negative inside. `p`: vessel frame, m, finite.
  double signed_distance(const Triple& p) const;
  // The unsigned distance, >= 0. `nearest`: on input a nearby triangle's number, from 0, which shortens the search; on return the nearest one's.
  double distance(const Triple& p, std::uint32_t& nearest) const;
  bool is_inside(const Triple& p) const;
  // The solid angle in which p sees the surface's inside, over 4 pi: for a closed mesh 1 inside and 0 outside, for an open one to 1e-3.
  double winding_number(const Triple& p) const;

 private:
  friend struct MeshQueries;  // the callbacks
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wholehand
