// SPDX-License-Identifier: MIT
// How near is touching, how deep is inside, and how low is through the table.
#pragma once

#include <algorithm>

#include "core/scene.h"

namespace wholehand {

// m, four of float's stop tolerances. A finger that comes to rest ends within one of the surface, a tracked tip within one and a half, on
// either side of it and to rounding: so nearer than this nothing can be told from touching. The same in both precisions, so that which
// one computes decides no outcome.
constexpr double LEAST_CONTACT = 4e-6;

// What the kernels compare separations and depths with, m: the scene's, but no less than that.
inline double judged_contact_tolerance(const HandData& hand) { return std::max(hand.contact_tolerance, LEAST_CONTACT); }
inline double judged_depth_limit(const HandData& hand) { return std::max(hand.depth_limit, LEAST_CONTACT); }

// The height in the vessel frame that the hand's skin must stay above, m. Only of a scene with a table.
inline double table_top(const Scene& scene, const VesselData& vessel) { return vessel.base + scene.table->clearance; }

}  // namespace wholehand
