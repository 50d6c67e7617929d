// SPDX-License-Identifier: MIT
// A gripper with a virtual user on it: everything up to the wire can be run without a device.
#pragma once

#include <cstdint>
#include <memory>

#include "core/scene.h"
#include "device/gripper.h"

namespace wholehand {

// The device is the paper's: 12 N at the arm, 8 N at the fingers; its gap is the hand's own unless [device] gap_mm says otherwise, and it
// measures at the scene's rate. Its user (device/sim_user.h) moves along minimum-jerk paths, holds it with an arm and with fingers that have
// mass, damping and stiffness, feels and sees a reaction time late, works against the error of the felt grip force once a contact is felt,
// and trembles, by `seed`. The same seed, scene and forces give the same motion to the bit.
// Throws Error (usage) where the user finds nothing to do.
std::unique_ptr<Gripper> open_sim(const Scene& scene, std::uint64_t seed);

// Of the user, SI: FACTS of the literature where there are any (docs/devices.md).
struct SimPerson {
  double arm_mass = 0.6, arm_damping = 25, arm_stiffness = 300;              // with the device's handle
  double finger_mass = 0.062, finger_damping = 4.5, finger_stiffness = 500;  // with the jaw: 50 g, 0.5 N s/m
  double reaction = 0.075, response = 0.15;                                  // s
  double excess = 3;                                                         // N beyond F_base that are held
  double arm_tremor = 0.15e-3, grip_tremor = 0.02;                           // m, N: standard deviations
};

}  // namespace wholehand
