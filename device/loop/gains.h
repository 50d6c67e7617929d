// SPDX-License-Identifier: MIT
// Gains that a live loop must not have: what a sampled wall or spring cannot be, on a light device.
#pragma once

#include <array>

#include "core/scene.h"

namespace wholehand {

// The largest gains at a rate that settle on the lightest devices of the reports that have a damping of 1 N s/m and more, at the device, N/m.
// K: the linear limit of a wall without delay. k_open: the smallest that simulation finds for users who react after 60 to 90 ms, with the
// gripper of GripLoop and the lightest finger; their delayed answer takes up to a sixth of what the sampled spring alone would bear. A
// heavier or more damped device bears more: see `stability wall`.
struct GainLimits {
  double stiffness = 0;  // K of the virtual coupling, for its damping B
  double k_open = 0;
};
GainLimits gain_limits(double rate, double wall_damping);

// How many times K a gripper feels at its arm or fingers, whichever is more (device/session/workspace.h's coupling_slope). `device_gap`: its own
// closed
// and open gap, m, where [device] gap_mm says none.
double device_slope(const Scene& scene, std::array<double, 2> device_gap);

// Throws Error (usage) with the gain, its limit and the remedy where a scene's live gains are beyond them at the device (K and B times
// the slope), unless `unsafe`.
void refuse_unstable_gains(const Scene& scene, std::array<double, 2> device_gap, bool unsafe);

}  // namespace wholehand
