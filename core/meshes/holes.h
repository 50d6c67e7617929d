// SPDX-License-Identifier: MIT
// Finds and closes holes of a mesh: flat ones of any size, others if they are small.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/meshes/triangles.h"

namespace wholehand {

// The largest hole that is closed although it is not flat, as a share of the mesh's largest extent: across, and along its edge.
constexpr double SMALL_HOLE = 0.1, SMALL_HOLE_EDGE = 0.4;
// How far the corners of a flat hole may lie off its plane, as a share of the same extent. The rounding that read_mesh accepts moves points of a flat
// rim that far. All lids between such corners agree to twice that much: 0.25 mm, at which a lattice aims, for a mesh of 125 mm.
constexpr double FLAT_HOLE = 1e-3;
// Flat holes that have no fan about their middle are cut into triangles, which takes time as the square of a polygon's corners. The squares of a
// mesh's polygons add up to that of so many corners at most: about a second.
constexpr std::size_t MOST_CUT_CORNERS = 15'000;
// Flat holes of a mesh: up to here each is compared with each, to find those that lie within others.
constexpr std::size_t MOST_NESTED_HOLES = 1'000;

// A loop of open edges.
struct MeshHole {
  std::vector<std::uint32_t> corners;  // vertices in the order of an outward-facing triangle that fills it
  double across = 0;                   // diagonal of its bounding box, m
  double length = 0;                   // of its edges, m
  Triple middle{};                     // mean of its corners
  Triple area{};                       // its area vector, outward, m2
  double off_plane = 0;                // largest distance of a corner from the plane through `middle` at right angles to `area`, m
  bool has_fan = false;                // triangles from `middle` to each edge all face along `area`
};

struct MeshHoles {
  std::vector<MeshHole> loops;
  std::size_t loose_edges = 0;  // open edges that are not part of a loop: their triangles turn opposite ways
};

// The holes of a mesh whose triangles share their corners. A loop that meets itself at a vertex counts as two.
MeshHoles find_holes(const TriangleMesh& mesh);

// `extent`: the mesh's largest, m.
bool is_small_hole(const MeshHole& hole, double extent);
bool is_flat_hole(const MeshHole& hole, double extent);

// How to close the holes of a mesh, as indices of loops. Fans close with a triangle, or about the middle, which becomes a vertex. Polygons are cut
// into triangles: a flat loop, and those within it that face the other way, such as the two rims of a double wall. Open ones are not small, and
// neither flat nor within MOST_CUT_CORNERS.
struct HoleClosing {
  std::vector<std::size_t> fans, open;
  std::vector<std::vector<std::size_t>> polygons;
};

HoleClosing plan_closing(const TriangleMesh& mesh, const MeshHoles& holes, double extent);

// Closes the holes but the open ones. The new triangles face as their neighbors do.
void close_holes(const MeshHoles& holes, const HoleClosing& closing, TriangleMesh& mesh);

}  // namespace wholehand
