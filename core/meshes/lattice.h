// SPDX-License-Identifier: MIT
// The lattice of signed distances to a mesh that the kernels read.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>

#include "core/meshes/check.h"
#include "core/meshes/sampling.h"
#include "core/prepare.h"

namespace wholehand {

// The specification of a lattice.
struct LatticeSpec {
  std::optional<double> spacing;  // m, > 0; absent: as wide as `tolerance` allows
  double tolerance = 0.25e-3;     // m, the allowed error at the surface
  double margin = 0;              // m that the lattice extends beyond the mesh, plus two cells
  // Bits of a sample, 16 or 32. Absent: 32 if the samples then take at most half of `most_bytes`, else 16; but always 32 if the mesh and its margin
  // are 32 m or more across, because halves end at 63.97 m.
  std::optional<int> bits;
  // Upper limit on sample memory: what memory and the device's largest buffer allow. Uses installed, not free, memory so that the
  // lattice is reproducible.
  std::size_t most_bytes = 512u << 20;
  double most_samples = std::numeric_limits<int>::max();  // the kernels count in 32 bits
  int threads = 0;                                        // 0: all cores
};

struct MeshLattice {
  PreparedLattice lattice;
  double error = 0;       // m: the largest absolute trilinear value at random points of the outer surface, where it should be 0
  bool at_limit = false;  // memory or time limited the spacing: with more it would be smaller
};

constexpr int SURFACE_SAMPLES = 4096;  // points of the surface at which a lattice's error is measured

// The places and bits of a lattice's samples with this spacing (m, > 0), without the samples; none if it does not fit.
std::optional<PreparedLattice> lattice_at(const MeshFacts& facts, const LatticeSpec& spec, double spacing);

// A lattice before its samples are taken.
struct LatticePlan {
  PreparedLattice lattice;
  double seconds = 0;                    // forecast
  std::optional<PreparedLattice> finer;  // the one that the tolerance asks for, if that takes longer than is allowed
  double finer_seconds = 0;              // of that one
};

// Predicts the time for the samples of a lattice by timing some of its rows first.
struct LatticeForecast {
  std::function<void(const LatticePlan& plan)> say;  // called once, before sampling; may be empty
  std::function<double()> clock;                     // s, ascending; empty: the machine's
  // Without a given spacing, the finest lattice is taken that is predicted to take no longer, but none coarser than that with which the
  // search for a spacing starts.
  double most_seconds = std::numeric_limits<double>::infinity();
};

// A lattice laid out as by core/prepare.h's prepare_lattice, but only as wide in x, y and z as the mesh is. Without a given spacing,
// it is the widest lattice whose error, including rounding to 16 bits, stays below the tolerance, or the finest that fits `most_bytes`
// and `forecast.most_seconds`; then `error` may exceed the tolerance. If 16 bits are requested, distances are clamped to 63.97 m. Throws
// Error (usage) if the given spacing, or any, does not fit.
MeshLattice lattice_of_mesh(const MeshDistance& distance, const CheckedMesh& mesh, const LatticeSpec& spec,
                            const LatticeProgress& progress = {}, const LatticeForecast& forecast = {});

// What lies inside a lattice's surface.
struct EnclosedVolume {
  double volume = 0;     // m3
  double doubt = 0;      // m3: by how much walls thinner than a cell may make it too large
  Triple center{};       // of that volume, m
  bool is_empty = true;  // no sample lies inside
};

// Overlapping bodies count once, as hands feel them. `area`: of the mesh, m2.
EnclosedVolume enclosed_volume(const PreparedLattice& lattice, double area);

}  // namespace wholehand
