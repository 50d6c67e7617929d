// SPDX-License-Identifier: MIT
// A body that nothing touches but the contacts it is made of: each a ball on a slide against a flat wall of its own, in the physics
// engine.
#pragma once

#include <vector>

#include "evidence/trials/held_body.h"

namespace wholehand {

struct RigOptions {
  double mass = 0.3;        // kg; a cube's inertia
  core_f64::Vec3 center{};  // of mass, m
  bool has_springs = true;  // false: each contact presses with its drive, whatever moves
  int most_contacts = 100;
};

// The digits of the contacts are as they are given.
HeldSetup rig_setup(const std::vector<core_f64::ContactPoint>& contacts, const core_f64::HandStrength& hand,
                    const RigOptions& options);

// Presses with these normal forces for 0.4 s while it is pinned, and lets it go under `force` at its center of mass.
void press_and_release(HeldBody& body, const std::vector<double>& normal_forces, const core_f64::Vec3& force);

}  // namespace wholehand
