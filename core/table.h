// SPDX-License-Identifier: MIT
// Kernel 8: the table on which the vessel stands, a level plane above which the hand must stay.
#pragma once

#include "core/hand.h"
#include "core/sdf.h"

namespace CORE_NS {

// How far the skin of a point of `radius` m at p reaches below the top of the vessel's table and its clearance, m; negative: it stays above. Only for
// a vessel on a table.
Real depth_in_table(const Vessel& vessel, Vec3 p, Real radius);
// The largest depth of three points with the radii of PIP, DIP and tip (for a thumb: MCP, IP and tip), m.
Real finger_in_table(const Vessel& vessel, FingerPoints points, Vec3 radii);

}  // namespace CORE_NS
