// SPDX-License-Identifier: MIT
// The visible lines of a mesh in a line drawing from one side.
#pragma once

#include "core/mesh_body.h"
#include "core/meshes/edges.h"
#include "sweeps/grips/depth_map.h"

namespace wholehand::sweeps {

// Points right and up in the view, m.
struct MeshLines {
  std::vector<std::vector<Flat>> contours;  // edges between a triangle that faces the viewer and one that does not, and open edges
  std::vector<std::vector<Flat>> creases;   // sharp edges within the visible surface
  std::vector<std::vector<Flat>> covered;   // closed lines around the mesh's covered area, the first point not repeated; even-odd
};

// An orthographic view of a mesh. `right`, `up`, `toward` (to the viewer): unit vectors, a right-handed frame. Details below `pixel` m are
// left out.
class MeshView {
 public:
  // Keeps references to `body` and `edges`.
  MeshView(const MeshBody& body, const MeshEdges& edges, const Triple& right, const Triple& up, const Triple& toward, double pixel);

  // Chains of edges, cut where they go behind the mesh, simplified to a quarter of a pixel. Contours and creases together have at most
  // MOST_LINE_POINTS points, and so has `covered`; if there are more, they are simplified to four pixels and only the longest lines stay, contours
  // first.
  MeshLines lines() const;
  // How far the mesh's nearest surface lies in front of p, m: negative if p is in front of it; DepthMap::NOTHING if the mesh does not cover p.
  double cover_at(const Triple& p) const;

 private:
  Triple seen(const Triple& p) const;
  bool faces_viewer(std::uint32_t triangle) const;
  std::vector<std::vector<std::uint32_t>> chains(bool of_contours) const;
  void add_visible(const std::vector<std::uint32_t>& chain, std::vector<std::vector<Flat>>& lines) const;

  const MeshBody& body_;
  const MeshEdges& edges_;
  Triple right_, up_, toward_;
  std::vector<Triple> points_;  // of the body, seen
  DepthMap depths_;
};

constexpr std::size_t MOST_LINE_POINTS = 8000;

// Douglas and Peucker: drops points that are within `tolerance` of the remaining line. The ends stay; for a closed line, whose first point is not
// repeated, two points far apart stay.
std::vector<Flat> simplified(const std::vector<Flat>& line, double tolerance);
std::vector<Flat> simplified_loop(const std::vector<Flat>& loop, double tolerance);

}  // namespace wholehand::sweeps
