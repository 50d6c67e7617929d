// SPDX-License-Identifier: MIT
// Likely mistakes in a mesh: its unit, and which way is up.
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

// The units among meters, centimeters, millimeters and inches in which a hand can hold a body of these extents along x, y and z: at most
// 400 mm large, one side that a hand can span, and no smaller than 20 mm. The likeliest first: nearest to 150 mm.
std::vector<LengthUnit> graspable_units(const Triple& numbers);

struct SizeHint {
  std::string text;            // a sentence with the scales that are likely meant; empty where a hand can hold the mesh
  bool is_other_unit = false;  // it is hardly meant as it is: another unit fits, or it is beyond 10 m or below 2 mm
};

// `scale`: that by which the file's numbers were multiplied.
SizeHint mesh_size_hint(const Triple& size, double scale = 1);

// Directions along the axes: -x, +x, -y, +y, -z, +z.
enum class Side { left, right, down, up, back, front };

// Into which a mesh is open: the way from its middle out of it is free in that direction alone. None where there is no such direction.
std::optional<Side> open_side(const TriangleMesh& mesh, const MeshFacts& facts);

// A sentence where a mesh whose format does not say which way is up does not seem to stand: it is open into another direction than up, or is
// closed and longest along another axis. It names the key of the scene that would stand it up. Else empty.
std::string posture_hint(const TriangleMesh& mesh, const MeshFacts& facts);

// A sentence where an inner outline (`height` from its floor to its mouth, `radius` at its widest, m) is far smaller than the mesh
// (`body_height`, `reach` from the axis), with the unit in which it would fit; else empty.
std::string inner_outline_hint(double height, double radius, double body_height, double reach);

}  // namespace wholehand
