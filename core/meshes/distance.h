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

struct MeshSide {
  bool is_inside = false;
  double room = 0;  // by how much the winding number may change before the side may be the other one; infinite for a closed mesh
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
  MeshSide side(const Triple& p) const;
  // The largest change of the winding number per m within `radius` of p, except where it jumps: on the surface. 0 for a closed mesh; infinite at the
  // edge of an open one, or if it has too many open edges to ask.
  double winding_slope(const Triple& p, double radius) const;
  // The solid angle in which p sees the surface's inside, over 4 pi: for a closed mesh 1 inside and 0 outside, for an open one to 1e-3.
  double winding_number(const Triple& p) const;

 private:
  friend struct MeshQueries;  // the callbacks
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wholehand
