// SPDX-License-Identifier: MIT
// The arm that the hand belongs to, prepared for the kernels.
#pragma once

#include "core/real.h"

namespace CORE_NS {

// Vessel frame, m and rad. The ranges say how far the wrist turns either way from the neutral pose, with hand and forearm in line and the thumb up.
struct Arm {
  int azimuths = 0;  // azimuths from which the holder may take it, in even steps of a turn; 0: the scene has no arm
  Vec3 shoulder{};
  Real upper_arm = 0, forearm = 0;
  Real wrist_radius = 0, elbow_radius = 0;
  Real flexion = 0, extension = 0;
  Real ulnar = 0, radial = 0;
  Real pronation = 0, supination = 0;
};

}  // namespace CORE_NS
