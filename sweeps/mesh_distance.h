// Signed distance to a triangle mesh, and the lattice of it that the kernels read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/prepare.h"
#include "sweeps/mesh_check.h"

namespace wholehand {

// How inside is told from outside; see docs/mesh.md.
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
  // To the nearest triangle, m, in double precision, negative inside. `p`: vessel frame, m, finite.
  double signed_distance(const Triple& p) const;
  // Without its sign, >= 0. `nearest`: a triangle's number, from 0; the search is shorter where it is near. On return the nearest one's.
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

// What a lattice is to be.
struct GridWish {
  double spacing = 0;                   // m; 0: as wide as `tolerance` allows
  double tolerance = 0.25e-3;           // m, for the error at the surface
  double margin = 0;                    // m beyond the mesh that the lattice reaches, and two cells more
  bool halves = false;                  // 16 bits a sample, not 32
  std::size_t most_bytes = 512u << 20;  // of the samples
  int threads = 0;                      // 0: all cores
};

struct MeshGrid {
  PreparedGrid grid;
  double error = 0;  // m: the largest trilinear value found at random points of the surface, where it should be 0
};

// The lattice as core/prepare.h's prepare_grid lays one out, but only as wide in x, y and z as the mesh is. Without a spacing the
// widest lattice whose error stays below the tolerance, or the finest that fits `most_bytes`: then `error` is above the tolerance.
// Throws Error (usage) where a given spacing does not fit.
MeshGrid grid_of_mesh(const MeshDistance& distance, const CheckedMesh& mesh, const GridWish& wish);

}  // namespace wholehand
