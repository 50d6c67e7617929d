// SPDX-License-Identifier: MIT
// Detects likely mistakes in a mesh: its unit, and its up direction.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/meshes/check.h"

namespace wholehand {

struct LengthUnit {
  const char* name;
  double meters;
};

// The units among meters, centimeters, millimeters and inches in which a hand can hold a body of these extents along x, y and z: at most 400 mm
// large, one side that a hand can span, and no smaller than 20 mm. The likeliest first: nearest to 150 mm.
std::vector<LengthUnit> graspable_units(const Triple& numbers);

// The unit in which the largest extent is nearest to that, whether or not a hand can hold the body then.
LengthUnit nearest_unit(const Triple& numbers);

struct SizeHint {
  std::string text;            // a sentence with the likely scales; empty if a hand can hold the mesh
  bool is_other_unit = false;  // the scale is probably a mistake: another unit fits, or the mesh is beyond 10 m or below 2 mm
};

// `scale`: the factor that was applied to the file's numbers.
SizeHint mesh_size_hint(const Triple& size, double scale = 1);

// Directions along the axes: -x, +x, -y, +y, -z, +z.
enum class Side { left, right, down, up, back, front };

// "+x" and the like.
const char* side_name(Side side);

// The direction in which a mesh is open: the only one in which the way out from its middle is free. None if there is none.
std::optional<Side> open_side(const TriangleMesh& mesh, const MeshFacts& facts);

// A sentence, with the scene key that would fix it, if a mesh whose format does not define up seems not to stand: it opens in another direction than
// up, or is closed and longest along another axis. Else empty.
std::string posture_hint(const TriangleMesh& mesh, const MeshFacts& facts);

// A sentence if an inner outline (`height` from its floor to its mouth, `radius` at its widest, m) is far smaller than the mesh (`body_height`,
// `reach` from the axis), with the unit in which it would fit; else empty.
std::string inner_outline_hint(double height, double radius, double body_height, double reach);

}  // namespace wholehand
