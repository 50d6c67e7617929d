// SPDX-License-Identifier: MIT
// The vessel in a grip's line drawing: its outline, or the lines of its mesh.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/prepare.h"
#include "sweeps/grips/view.h"

namespace wholehand::sweeps {

class DrawnGlass {
 public:
  // Throws Error as prepare_vessel.
  explicit DrawnGlass(const VesselData& vessel);

  // The vessel's extent along a horizontal or vertical unit vector, mm.
  std::array<double, 2> extent_along(const Triple& axis) const;
  // Prepares what `covers` and `draw` need for a view of a mesh; details below `pixel` mm are left out. The view keeps references to this.
  void look(DrawnView& view, double pixel) const;
  // Whether the glass hides a bone from a to b (m). In front and side view a bone beside a mesh counts as behind it if it is further away than the
  // mesh's middle.
  bool covers(const DrawnView& view, const Triple& a, const Triple& b) const;
  void draw(std::string& svg, const DrawnView& view) const;

 private:
  void draw_upright(std::string& svg, const DrawnView& view) const;
  void draw_from_above(std::string& svg, const DrawnView& view) const;
  void draw_cavity(std::string& svg, const DrawnView& view) const;
  void draw_mesh(std::string& svg, const DrawnView& view) const;
  bool mesh_covers(const DrawnView& view, const Triple& a, const Triple& b) const;

  PreparedVessel prepared_;
  std::shared_ptr<const MeshBody> body_;  // null for an outline
  MeshEdges edges_;
};

}  // namespace wholehand::sweeps
