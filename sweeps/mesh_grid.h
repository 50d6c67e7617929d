// The lattice of signed distances to a mesh that the kernels read.
#pragma once

#include <cstddef>

#include "core/prepare.h"
#include "sweeps/mesh_check.h"

namespace wholehand {

class MeshDistance;  // sweeps/mesh_distance.h

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
