// SPDX-License-Identifier: MIT
// Takes the samples of a lattice of signed distances.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/meshes/distance.h"
#include "core/prepare.h"

namespace wholehand {

// Called with the finished share of the work, 0 to 1, ascending, on the thread that requested the work; 0 while a spacing is sought. An exception
// from it ends the work.
using LatticeProgress = std::function<void(double share)>;

// Estimates the total time (s), given that `done` of `all` parts took `seconds`.
double forecast_seconds(std::size_t done, std::size_t all, double seconds);

// Where a sample lies, m.
inline Triple lattice_place(const PreparedLattice& lattice, int i, int j, int k) {
  return {lattice.origin[0] + lattice.spacing * i, lattice.origin[1] + lattice.spacing * j,
          lattice.origin[2] + lattice.spacing * k};
}

// Each sample is what MeshDistance::signed_distance gives. The side of a sample is that of a neighbor, before it in its row or in the row before,
// from which the surface is farther away than the way between them if, for an open mesh, the winding number cannot change enough on that way.
class LatticeSampler {
 public:
  // Keeps references to both.
  LatticeSampler(const MeshDistance& distance, const PreparedLattice& lattice, int threads);

  // All samples, as a lattice's words.
  std::vector<std::uint32_t> take_all(const LatticeProgress& progress) const;
  // Takes rows from all over the lattice, one per thread and then twice as many each time, until they took a fifth of a second or are a 32nd of all,
  // and extrapolates the total time. The samples are not kept. `clock`: s, ascending; empty: the machine's.
  double forecast(const std::function<double()>& clock) const;

 private:
  struct SidedSample {
    MeshSide side;
    double away = 0;
  };

  // Takes the samples along x. `line`: those of the row before, if there is one, which these replace.
  void take_row(int j, int k, bool has_row_before, std::vector<SidedSample>& line) const;
  bool keeps_side(const SidedSample& from, int i, int j, int k, MeshSide& side) const;
  double slope_at(int i, int j, int k) const;

  const MeshDistance& distance_;
  const PreparedLattice& lattice_;
  int threads_;
  std::size_t blocks_x_ = 0, blocks_y_ = 0;
  std::vector<double> slopes_;  // of the winding number in blocks of BLOCK cells along each side, 1/m; empty for a closed mesh
};

}  // namespace wholehand
