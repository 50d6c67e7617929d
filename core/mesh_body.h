// SPDX-License-Identifier: MIT
// A vessel read from a mesh file, prepared for kernels and drawings: plain data, made by core/meshes/vessel.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/prepared.h"

namespace wholehand {

// What the check of a mesh found (core/meshes/check.h).
struct MeshFacts {
  std::size_t triangles = 0;           // as read
  std::size_t open_edges = 0;          // of one triangle only
  std::size_t non_manifold_edges = 0;  // of three or more triangles
  std::size_t odd_edges = 0;           // of these, with an odd number: there a wall ends within a body
  std::size_t inverted_pairs = 0;      // edges of two triangles that turn opposite ways
  std::size_t zero_triangles = 0;      // without area: two corners coincide, or all lie on one line
  std::size_t joined_corners = 0;      // vertices that equaled another and were merged with it
  std::size_t repeated_triangles = 0;  // left out: they duplicate others that face the same way
  std::size_t back_triangles = 0;      // left out: they duplicate others that face the other way
  std::size_t turned_triangles = 0;    // faced inward and were turned
  std::size_t holes = 0;               // loops of the edges that are still open
  double widest_hole = 0;              // of these, m across
  std::size_t open_holes = 0;          // holes that are neither flat nor small: close_holes does not close them
  double widest_open_hole = 0;         // of those, m across
  bool closable = false;               // close_holes closes all holes
  std::size_t closed_holes = 0;        // holes that were closed
  double widest_closed_hole = 0;       // of these, m across
  bool closed = false;                 // each edge has an even number of triangles: a ray's crossings show what is inside
  bool oriented = false;               // each edge is used equally often in both directions, give or take one
  bool was_inside_out = false;         // all triangles were flipped
  double thickness = 0;                // m, that a sheet without one was given
  bool closes_nothing = false;         // closing holes was requested, and no edge is open
  Triple low{}, high{};                // bounding box, m
  double area = 0;                     // m2
  double volume = 0;        // m3, > 0 if certain; for an open mesh, with each hole closed by a cone to the middle of all open edges
  Triple center_of_mass{};  // of that volume, m

  Triple size() const { return {high[0] - low[0], high[1] - low[1], high[2] - low[2]}; }  // m

  // Whether sums over the triangles describe a body: all face outward, and no wall ends within it.
  bool has_sure_volume() const { return oriented && odd_edges == 0; }
};

// Vessel frame, m.
struct MeshBody {
  std::vector<Triple> vertices;                         // shared between triangles
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  MeshFacts facts;
  bool has_lattice_volume = false;  // the triangles do not determine the volume: it and its center are those of the lattice
  double volume = 0;                // enclosed, m3, > 0
  Triple center_of_mass{};          // of that volume
  bool holds_cavity = false;        // the inner outline lies within the enclosed volume, so what it encloses is not glass
  PreparedLattice lattice;          // signed distance; in the right hand's scene
  double lattice_error = 0;         // of the lattice at the surface, m
  std::string key;                  // hash of the triangles and the lattice, hexadecimal: equal if both are equal
};

}  // namespace wholehand
