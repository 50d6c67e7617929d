// SPDX-License-Identifier: MIT
// Caches lattices of meshes between runs, since one may take half a minute.
#pragma once

#include <string>

#include "core/meshes/lattice.h"

namespace wholehand {

// lattice_of_mesh's lattice, taken from a file of `folder`/grids where one holds it, else made and put there. `folder` empty:
// cache_folder(). `progress` and `forecast` are called only where the lattice is made.
//
// A file is found by the triangles and by what of the spec decides the lattice; one that is damaged, cut off or something else is made
// again. Files appear whole, so that several processes may use one folder. Beyond cache_limit() those unused for longest go first. No
// folder, one that cannot be written or a full disk cost nothing but the time.
//
// Throws what lattice_of_mesh, MeshDistance and cache_limit throw.
MeshLattice cached_lattice(const CheckedMesh& mesh, const LatticeSpec& spec, const std::string& folder = "",
                           const LatticeProgress& progress = {}, const LatticeForecast& forecast = {});

// 32 hexadecimal digits, equal if the triangles and the lattice's places and bits are equal, and practically only then.
std::string mesh_key(const CheckedMesh& mesh, const PreparedLattice& lattice);

}  // namespace wholehand
