// SPDX-License-Identifier: MIT
// A mesh as a line drawing shows it from one side, without what is hidden.
#pragma once

#include "core/mesh_body.h"
#include "core/meshes/edges.h"
#include "sweeps/grips/depth_map.h"

namespace wholehand {

// Points right and up in the view, m.
struct MeshLines {
  std::vector<std::vector<Flat>> contours;  // edges between a triangle that faces the viewer and one that does not, and open edges
  std::vector<std::vector<Flat>> creases;   // sharp edges within what faces the viewer
  std::vector<std::vector<Flat>> covered;   // closed lines round what the mesh covers, the first point not repeated; even-odd
};

// An orthographic view of a mesh. `right`, `up`, `toward` (to the viewer): unit vectors, a right-handed frame. Details below `pixel` m are
// left out.
class MeshView {
 public:
  // Keeps references to both.
  MeshView(const MeshBody& body, const MeshEdges& edges, const Triple& right, const Triple& up, const Triple& toward, double pixel);

  // Chains of edges, cut where they go behind the mesh, simplified to a quarter of a pixel. At most MOST_LINE_POINTS points in all contours and
  // creases and as many in `covered`: of more, simplified to four pixels, the longest lines, contours first.
  MeshLines lines() const;
  // How much of the mesh's nearest surface lies in front of p, m: negative where p is in front of it; DepthMap::NOTHING where the mesh is
  // not behind or before p at all.
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

// Douglas and Peucker: leaves out points as long as none of them is farther than `tolerance` from the line that is left. The ends stay; of a
// closed line, whose first point is not repeated, two points far apart.
std::vector<Flat> simplified(const std::vector<Flat>& line, double tolerance);
std::vector<Flat> simplified_loop(const std::vector<Flat>& loop, double tolerance);

}  // namespace wholehand
