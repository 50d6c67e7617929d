// SPDX-License-Identifier: MIT
// Kernel 7: what the fingers feel, and what physics requires.
#pragma once

#include "core/real.h"

namespace CORE_NS {

// The scene's constants, SI (core/scene.h's ForceData with the vessel's own range).
struct ForceScale {
  Real gravity = 0;                   // m/s2
  Real base = 0, range = 0, max = 0;  // N
  bool exact_torque = false;          // which torque enters the normal force
  bool per_grip = false;              // which reference
  Real reference = 0;                 // tau_ref of the vessel, N m (per_object)
  Real k_open = 0;                    // N/m
  Real friction = 0;                  // mu
  Real torsion = 0;                   // gamma, m
};

// The weight of glass and liquid at one fill and tilt: center of mass = fixed + lean n + height y, vessel frame.
struct Load {
  Real mass = 0;              // kg
  Vec3 fixed{};               // the vessel's own share of the center of mass, m
  Real lean = 0, height = 0;  // the liquid's share, m
};

// Horizontal direction in which the vessel pours, away from the palm: (0, 1, 0) x d made unit; `sense` -1: towards the palm.
Vec3 pour_direction(Vec3 direction, Real sense);
// Up in the vessel frame at a tilt.
Vec3 up_direction(Vec3 pour, Real sine_tilt, Real cosine_tilt);
// Center of mass of a load, m.
Vec3 load_center(Load load, Vec3 pour);
// The per-grip torque at which the normal force has grown by its whole range: m g max(L, 5 mm), N m.
Real grip_reference(Real mass, Real gravity, Real pivot_length);
// F_base + F_range tau / tau_ref; F_base if tau_ref is 0. N.
Real normal_force(Real base, Real range, Real torque, Real reference);
// clamp(normal + opening, 0, max), N.
Real feedback_force(Real normal, Real opening, Real max);
// The longest lever that counts as 0 for contacts without torsion, m. `pivot_length`: from their middle to where the load acts, m.
Real longest_bare_lever(Real pivot_length);
// The share of their strength that digits have if thumb and index finger are `opening` apart, m: grip strength over the largest, as measured on
// cylinders of four diameters. Linear between them, constant beyond the first and the last.
Real strength_at(Real opening);

}  // namespace CORE_NS
