// SPDX-License-Identifier: MIT
// How near is touching, how deep is inside, how low is through the table, and where the shoulder is.
#pragma once

#include <algorithm>

#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {

// m, four of float's stop tolerances. A finger that comes to rest ends within one of the surface, a tracked tip within one and a half, on
// either side of it and to rounding: so a smaller distance counts as touching. The same in both precisions, so that the
// precision decides no outcome.
constexpr double LEAST_CONTACT = 4e-6;

// What the kernels compare separations and depths with, m: the scene's, but no less than that.
inline double judged_contact_tolerance(const HandData& hand) { return std::max(hand.contact_tolerance, LEAST_CONTACT); }
inline double judged_depth_limit(const HandData& hand) { return std::max(hand.depth_limit, LEAST_CONTACT); }

// The height in the vessel frame that the hand's skin must stay above, m. Only of a scene with a table.
inline double table_top(const Scene& scene, const VesselData& vessel) { return vessel.base + scene.table->clearance; }

// The shoulder in the vessel frame, m. Only of a scene with an arm.
inline Triple shoulder_place(const Scene& scene, const VesselData& vessel) {
  const Triple& shoulder = scene.arm->shoulder;
  return {shoulder[0], vessel.base + shoulder[1], shoulder[2]};
}
// Azimuths at which the holder may take a vessel: one that is the same from all sides from any, another as it stands; 0 without an arm.
inline int arm_azimuths(const Scene& scene, const VesselData& vessel) {
  return !scene.arm ? 0 : vessel.is_symmetric() ? ARM_AZIMUTHS : 1;
}

}  // namespace wholehand
