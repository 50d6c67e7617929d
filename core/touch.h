// SPDX-License-Identifier: MIT
// Thresholds: when a point touches, is inside or is through the table, and where the shoulder is.
#pragma once

#include <algorithm>

#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {

// m, four of float's stop tolerances. A finger comes to rest within one of the surface, a tracked tip within one and a half, on either side, up to
// rounding; so smaller distances count as touching. It is the same in both precisions, so that precision decides no outcome.
constexpr double LEAST_CONTACT = 4e-6;

// Thresholds for separations and depths in the kernels, m: the scene's, but no less than that.
inline double judged_contact_tolerance(const HandData& hand) { return std::max(hand.contact_tolerance, LEAST_CONTACT); }
inline double judged_depth_limit(const HandData& hand) { return std::max(hand.depth_limit, LEAST_CONTACT); }

// The height in the vessel frame above which the hand's skin must stay, m. Only for a scene with a table.
inline double table_top(const Scene& scene, const VesselData& vessel) { return vessel.base + scene.table->clearance; }

// The shoulder in the vessel frame, m. Only for a scene with an arm.
inline Triple shoulder_place(const Scene& scene, const VesselData& vessel) {
  const Triple& shoulder = scene.arm->shoulder;
  return {shoulder[0], vessel.base + shoulder[1], shoulder[2]};
}
// Number of azimuths from which the holder may take a vessel: all round for a body of revolution, else only as it stands; 0 without an arm.
inline int arm_azimuths(const Scene& scene, const VesselData& vessel) {
  return !scene.arm ? 0 : vessel.is_symmetric() ? ARM_AZIMUTHS : 1;
}

}  // namespace wholehand
