// SPDX-License-Identifier: MIT
// Refuses gains that would make a live loop unstable: a sampled wall or spring cannot be that stiff on a light device.
#pragma once

#include <array>

#include "core/scene.h"

namespace wholehand::device {

// The largest gains at a rate that settle, at the device, N/m, on the lightest devices of the reports that have a damping of 1 N s/m or more. K: the
// linear limit of a wall without delay. k_open: the smallest found by simulation for users who react after 60 to 90 ms, with the gripper of GripLoop
// and the lightest finger; their delayed response costs up to a sixth of what the sampled spring alone would allow. A heavier or more damped device
// tolerates more: see `stability wall`.
struct GainLimits {
  double stiffness = 0;  // K of the virtual coupling, for its damping B
  double k_open = 0;
};
GainLimits gain_limits(double rate, double wall_damping);

// The factor by which a gripper feels K at its arm or its fingers, whichever is more (device/session/workspace.h's coupling_slope). `device_gap`: the
// device's own closed and open gap, m, used if [device] gap_mm is absent.
double device_slope(const Scene& scene, std::array<double, 2> device_gap);

// Throws Error (usage) with the gain, its limit and the remedy if a scene's live gains exceed them at the device (K and B times the slope), unless
// `unsafe`.
void refuse_unstable_gains(const Scene& scene, std::array<double, 2> device_gap, bool unsafe);

}  // namespace wholehand::device
