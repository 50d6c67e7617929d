// SPDX-License-Identifier: MIT
// The arm that a hand belongs to, made ready for the kernels.
#pragma once

#include "core/real.h"

namespace CORE_NS {

// Vessel frame, m and rad. The ranges are how far the wrist goes either way from where hand and forearm are in line and the thumb is up.
struct Arm {
  int azimuths = 0;  // about the vessel's axis at which the holder may take it, even steps of a turn; 0: the scene has no arm
  Vec3 shoulder{};
  Real upper_arm = 0, forearm = 0;
  Real wrist_radius = 0, elbow_radius = 0;
  Real flexion = 0, extension = 0;
  Real ulnar = 0, radial = 0;
  Real pronation = 0, supination = 0;
};

}  // namespace CORE_NS
