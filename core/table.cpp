// SPDX-License-Identifier: MIT
#include "core/table.h"

#include <algorithm>

namespace CORE_NS {

// depth = r - (y - top), where the top is the table's height and the clearance above it.
Real depth_in_table(const Vessel& vessel, Vec3 p, Real radius) { return radius - (p.y - vessel.table_top); }

Real finger_in_table(const Vessel& vessel, FingerPoints points, Vec3 radii) {
  const Real pip = depth_in_table(vessel, points.pip, radii.x);
  const Real dip = depth_in_table(vessel, points.dip, radii.y);
  const Real tip = depth_in_table(vessel, points.tip, radii.z);
  return std::max(pip, std::max(dip, tip));
}

}  // namespace CORE_NS
