// SPDX-License-Identifier: MIT
// The lattice of signed distances to a mesh that the kernels read.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "core/meshes/check.h"
#include "core/prepare.h"

namespace wholehand {

class MeshDistance;  // core/meshes/distance.h

// What a lattice is to be.
struct LatticeSpec {
  std::optional<double> spacing;  // m, > 0; absent: as wide as `tolerance` allows
  double tolerance = 0.25e-3;     // m, for the error at the surface
  double margin = 0;              // m beyond the mesh that the lattice reaches, and two cells more
  // Bits of a sample, 16 or 32. Absent: 32 while the samples then take at most half of `most_bytes`, else 16; but always 32 where the mesh
  // and its margin are 32 m or more across, as halves end at 63.97 m.
  std::optional<int> bits;
  // Upper limit on sample memory: what memory and the device's largest buffer allow. Uses installed, not free, memory so that the
  // lattice is reproducible.
  std::size_t most_bytes = 512u << 20;
  int threads = 0;  // 0: all cores
};

struct MeshLattice {
  PreparedLattice lattice;
  double error = 0;       // m: the largest trilinear value found at random points of the outer surface, where it should be 0
  bool at_limit = false;  // `most_bytes` had a say in choosing the spacing: with more it would be smaller
};

constexpr int SURFACE_SAMPLES = 4096;  // points of the surface at which a lattice's error is measured

// Where the samples of a lattice with this spacing (m, > 0) would lie, and in how many bits, without samples; none where it does not fit.
std::optional<PreparedLattice> lattice_at(const MeshFacts& facts, const LatticeSpec& spec, double spacing);

// Called with the share of the work that is done, from 0 to 1, ascending, by the thread that asked for the work; 0 as long as a spacing is
// sought. What it throws ends the work.
using LatticeProgress = std::function<void(double share)>;

// How long all of the work takes (s), where `done` of its `all` parts took `seconds`.
double forecast_seconds(std::size_t done, std::size_t all, double seconds);

// How long the samples of a lattice will take, by some of its own rows that are timed first.
struct LatticeForecast {
  std::function<void(const PreparedLattice& lattice, double seconds)>
      say;                        // called once, before the samples are taken; may be empty
  std::function<double()> clock;  // s, ascending; empty: the machine's
};

// The lattice as core/prepare.h's prepare_lattice lays one out, but only as wide in x, y and z as the mesh is. Without a spacing the
// widest lattice whose error, rounding to 16 bits included, stays below the tolerance, or the finest that fits `most_bytes`: then `error`
// may be above the tolerance. With 16 bits asked for, distances beyond 63.97 m are cut to that.
// Throws Error (usage) where a given spacing does not fit, or none does.
MeshLattice lattice_of_mesh(const MeshDistance& distance, const CheckedMesh& mesh, const LatticeSpec& spec,
                            const LatticeProgress& progress = {}, const LatticeForecast& forecast = {});

// What lies inside a lattice's surface.
struct EnclosedVolume {
  double volume = 0;     // m3
  double doubt = 0;      // m3: by how much walls thinner than a cell may make it too large
  Triple center{};       // of that volume, m
  bool is_empty = true;  // no sample lies inside
};

// Bodies that overlap count once, as hands feel them. `area`: of the mesh, m2.
EnclosedVolume enclosed_volume(const PreparedLattice& lattice, double area);

}  // namespace wholehand
