// SPDX-License-Identifier: MIT
// Twin of core/table.cpp.
#ifndef TABLE_GLSL
#define TABLE_GLSL

#include "hand.glsl"

// Whether the scene has a table; without one, nothing of this kernel is compiled.
layout(constant_id = CONST_TABLE) const bool ON_TABLE = false;

Real depth_in_table(Vec3 p, Real radius) { return radius - (p.y - scene.table_top); }

Real finger_in_table(FingerPoints points, Vec3 radii) {
  Real pip = depth_in_table(points.pip, radii.x);
  Real dip = depth_in_table(points.dip, radii.y);
  Real tip = depth_in_table(points.tip, radii.z);
  return max(pip, max(dip, tip));
}

#endif
