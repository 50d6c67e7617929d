// SPDX-License-Identifier: MIT
// Efforts of the whole hand at a moment of a session: kernels 9 and 10 on the hand that is shown.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "device/session/live_scene.h"
#include "device/session/tick.h"
#include "device/session/vessel_tracker.h"

namespace wholehand {

// One contact that presses, world frame of the scene.
struct HandPress {
  int digit = 0;             // a finger, or FINGER_COUNT for the palm
  Triple place{}, normal{};  // m; unit, into the vessel
  Triple force{};            // on the vessel, N
};

// Efforts are shares of the strength, infinite where no force holds the vessel. The least effort lies in [low, effort], and the
// forces of `presses` attain `effort`.
struct HandHold {
  double effort = 0, low = 0;
  double tips = 0;      // the effort of thumb and index tip alone
  double strength = 0;  // of the weaker one of thumb and index finger at this opening, N
  std::vector<HandPress> presses;

  // The hold force, N, in the whole hand and of the two tips alone: what the weaker of thumb and index finger presses with at most. The
  // other one may press with effort times its own strength.
  double force() const { return effort * strength; }
  double tips_force() const { return tips * strength; }
};

// The hold of a tick that holds a vessel, which is at `vessel`; `posed` are the joints that rest on it. World frame of the scene. Nothing
// where the scene has no strengths, or nothing is held. A function of these alone, so that a recording shows what its session did.
std::optional<HandHold> hand_hold(const LiveScene& live, const Tick& tick, const VesselPose& vessel,
                                  const std::array<Triple, JOINT_COUNT>& posed);

}  // namespace wholehand
