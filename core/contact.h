// SPDX-License-Identifier: MIT
// Kernel 4: which points touch, and where they belong.
#pragma once

#include "core/sdf.h"

namespace CORE_NS {

// Distance from the skin of a point of `radius` m at p to the surface, m; negative: penetrates.
Real separation_at(const Vessel& vessel, Vec3 p, Real radius);
// Moves p along the outward normal, evaluated anew each step, until the separation is 0 to the stop tolerance.
Vec3 proxy_of(const Vessel& vessel, Vec3 p, Real radius, bool& settled);
// Whether rounding may decide if such a point is a contact: its separation is within CONTACT_MARGIN of the contact tolerance, or it is a contact
// above the mouth of a solid vessel that lies this near to the lid's edge.
bool is_undecided(const Vessel& vessel, Vec3 p, Real separation, Real tolerance);

}  // namespace CORE_NS
