// SPDX-License-Identifier: MIT
// Checks a mesh before it is used.
#pragma once

#include <cstddef>
#include <string>

#include "core/meshes/triangles.h"

namespace wholehand {

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
  bool closable = false;               // close_holes closes them all
  std::size_t closed_holes = 0;        // small holes that were closed
  double widest_closed_hole = 0;       // of these, m across
  bool closed = false;                 // each edge has an even number of triangles: a ray's crossings show what is inside
  bool oriented = false;               // each edge is used equally often in both directions, give or take one
  bool was_inside_out = false;         // all triangles were flipped
  bool closes_nothing = false;         // closing holes was requested, and no edge is open
  Triple low{}, high{};                // bounding box, m
  double area = 0;                     // m2
  double volume = 0;        // m3, > 0 if certain; for an open mesh, with each hole closed by a cone to the middle of all open edges
  Triple center_of_mass{};  // of that volume, m

  Triple size() const { return {high[0] - low[0], high[1] - low[1], high[2] - low[2]}; }  // m

  // Whether sums over the triangles describe a body: all face outward, and no wall ends within it.
  bool has_sure_volume() const { return oriented && odd_edges == 0; }
};

// Triangles that share their corners, facing outward, and the findings.
struct CheckedMesh {
  TriangleMesh mesh;
  MeshFacts facts;
};

// Merges vertices that are equal in all three coordinates, drops triangles with coinciding corners and duplicates, closes holes if `close_holes` is
// set (core/meshes/holes.h), and turns triangles outward (core/meshes/orientation.h). `name` is for messages. Throws Error (usage) if a surface that
// faces outward encloses no volume, such as a flat sheet, or if a hole to be closed is too large.
CheckedMesh check_mesh(const TriangleMesh& mesh, const std::string& name, bool close_holes = false);

// "93.92 cm3, center of mass (0, 39.14, 0) mm", to a hundredth of a millimeter; of m3 and m.
std::string filled_text(double volume, const Triple& center);

// The findings as one paragraph, with their consequences; ends without a line break.
std::string mesh_check_text(const MeshFacts& facts);

}  // namespace wholehand
