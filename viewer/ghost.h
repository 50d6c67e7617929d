// SPDX-License-Identifier: MIT
// The hand of an advised grip, where it would be now.
#pragma once

#include <array>
#include <optional>

#include "advice/advice.h"
#include "core/quaternion.h"
#include "live/vessel_tracker.h"

namespace wholehand {

// A place and a turn, world frame of the scene.
struct GhostNode {
  Triple place{};
  Quaternion turn{0, 0, 0, 1};
};

struct GhostHand {
  GhostNode wrist;
  std::array<GhostNode, JOINT_COUNT> joints;
};

// Of the best grip, on its vessel where that is. Nothing where no grip is better than the present one.
std::optional<GhostHand> ghost_of(const Scene& scene, const Advice& advice, const VesselPoses& poses);

}  // namespace wholehand
