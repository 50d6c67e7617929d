// SPDX-License-Identifier: MIT
// The views of a grip's line drawing, and the format of its numbers and positions.
#pragma once

#include <memory>
#include <string>

#include "core/vectors.h"
#include "sweeps/grips/mesh_lines.h"

namespace wholehand::sweeps {

// An orthographic view: unit vectors of the vessel frame, and its origin's place on the sheet, mm to the right and mm down.
struct DrawnView {
  const char* name;
  Triple right, up, toward;
  Flat origin{};
  std::shared_ptr<const MeshView> mesh;  // of a vessel that is a body of revolution

  double along(const Triple& axis, const Triple& p) const { return 1e3 * dot(axis, p); }
  double depth(const Triple& p) const { return along(toward, p); }  // mm, larger is nearer
  Flat flat(const Triple& p) const { return {origin[0] + along(right, p), origin[1] - along(up, p)}; }
  bool is_level() const { return up[1] == 1; }  // front and side: the vessel's axis runs up
};

std::string number_text(double value);  // mm, two decimals
std::string point_text(const Flat& p);
void draw_line(std::string& svg, const Flat& a, const Flat& b, const char* style);

}  // namespace wholehand::sweeps
