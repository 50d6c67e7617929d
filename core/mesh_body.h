// SPDX-License-Identifier: MIT
// A vessel read from a mesh file, prepared for kernels and drawings: plain data, made by core/meshes/vessel.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/prepared.h"

namespace wholehand {

// Vessel frame, m.
struct MeshBody {
  std::vector<Triple> vertices;                         // shared between triangles
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  Triple low{}, high{};                                 // bounding box
  double volume = 0;                                    // enclosed, m3, > 0
  Triple center_of_mass{};                              // of that volume
  bool holds_cavity = false;  // the inner outline lies within the enclosed volume, so what it encloses is not glass
  PreparedLattice lattice;    // signed distance; in the right hand's scene
  double lattice_error = 0;   // of the lattice at the surface, m
  std::string facts;          // what the check found, in one paragraph
  std::string key;            // hash of the triangles and the lattice, hexadecimal: equal if both are equal
};

}  // namespace wholehand
