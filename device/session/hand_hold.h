// SPDX-License-Identifier: MIT
// Efforts of the whole hand at a moment of a session: kernels 9 and 10 on the displayed hand.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "device/session/live_scene.h"
#include "device/session/tick.h"
#include "device/session/vessel_tracker.h"

namespace wholehand::device {

// One pressing contact, world frame of the scene.
struct HandPress {
  int digit = 0;             // a finger, or FINGER_COUNT for the palm
  Triple place{}, normal{};  // m; unit, into the vessel
  Triple force{};            // on the vessel, N
};

// Efforts are shares of the strength, infinite if no force holds the vessel. The least effort lies in [low, effort], and the forces of `presses`
// attain `effort`.
struct HandHold {
  double effort = 0, low = 0;
  double tips = 0;      // the effort of thumb and index tip alone
  double strength = 0;  // of the weaker one of thumb and index finger at this opening, N
  std::vector<HandPress> presses;

  // The hold force, N, in the whole hand and of the two tips alone: the most that the weaker of thumb and index finger presses with. The stronger one
  // may press with effort times its own strength.
  double force() const { return effort * strength; }
  double tips_force() const { return tips * strength; }
};

// The hold of a tick in which a vessel is held; `posed` are the joints that rest on it. World frame of the scene. Nothing if the scene
// has no strengths, or nothing is held. It depends only on these arguments, so a recording shows what its session did.
std::optional<HandHold> hand_hold(const LiveScene& live, const Tick& tick, const std::array<Triple, JOINT_COUNT>& posed);

}  // namespace wholehand::device
