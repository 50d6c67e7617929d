// SPDX-License-Identifier: MIT
// A gripper with a virtual user, so that everything except the wire runs without a device.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/people/participant.h"
#include "core/scene.h"
#include "device/loop/gripper.h"
#include "device/simulated/sim_user.h"

namespace wholehand::device {

// The device is the paper's: 12 N at the arm, 8 N at the fingers; its gap is the hand's own unless [device] gap_mm says otherwise, and it measures at
// the scene's rate. Its user (device/simulated/sim_user.h) is `person`. The user moves along minimum-jerk paths; holds the device with an arm and
// fingers (device/simulated/sim_fingers.h) that have mass, damping and stiffness; feels and sees one reaction time late; presses with the force that
// the person thinks the vessel needs; follows what opens the fingers; and trembles, by `seed`. The same person, seed, scene and forces give the same
// motion to the bit. The scene has the person's own hand (Participant::hand). Throws Error (usage) if the user finds nothing to do.
std::unique_ptr<Gripper> open_sim(const Scene& scene, std::uint64_t seed, const Participant& person,
                                  ShownGripSource* shown = nullptr);
// The median person of the scene's population.
std::unique_ptr<Gripper> open_sim(const Scene& scene, std::uint64_t seed, ShownGripSource* shown = nullptr);
// A person with only these jobs.
std::unique_ptr<Gripper> open_sim(const Scene& scene, std::uint64_t seed, const Participant& person, std::vector<SimJob> jobs,
                                  ShownGripSource* shown = nullptr);

}  // namespace wholehand::device
