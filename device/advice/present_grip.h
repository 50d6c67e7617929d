// SPDX-License-Identifier: MIT
// The grip that a hand would have if it closed now: converts a session's state to the six numbers of a grip.
#pragma once

#include <optional>

#include "core/result.h"
#include "device/session/live_scene.h"
#include "device/session/vessel_tracker.h"

namespace wholehand::device {

// The vessel near the hand, and the hand's pose relative to it.
struct Approach {
  int vessel = -1;
  bool is_held = false;
  GripInput grip;  // in the world of the scene; of the scene's own hand
};

// The approach to the touched or held vessel, else to the nearest one with both tips within NEAR_VESSEL of its surface. Absent if there is none, if
// the line of the tips passes further above or below it than grips reach, if the session is over, or while a vessel returns to its place.
std::optional<Approach> approach_of(const LiveScene& live, const Tick& tick, const VesselPoses& poses);

constexpr double NEAR_VESSEL = 0.2;  // m

}  // namespace wholehand::device
