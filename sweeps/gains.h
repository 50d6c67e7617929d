// Gains that a live loop must not have: what a sampled wall or spring cannot be, on a light device.
#pragma once

#include "core/scene.h"

namespace wholehand {

// The largest gains at a rate that settle on the lightest devices of the reports (wall_devices(); the gripper of GripLoop with the lightest
// finger that people have); N/m. Where a device is heavier or more damped the limits are higher: `stability wall` tells.
struct GainLimits {
  double stiffness = 0;  // K of the virtual coupling, for its damping B
  double k_open = 0;
};
GainLimits gain_limits(double rate, double wall_damping);

// Throws Error (usage) with the gain, its limit and the remedy where a scene's live gains are beyond them, unless `unsafe`.
void refuse_unstable_gains(const Scene& scene, bool unsafe);

}  // namespace wholehand
