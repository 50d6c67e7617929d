// SPDX-License-Identifier: MIT
// How a vessel slides between two tips and turns about their line: rigid-body motion with three degrees of freedom under Coulomb friction of two soft
// fingers. Pure mechanics: neither allocates nor throws, and the same input gives the same bits. docs/method.md, "Sliding".
#pragma once

#include "core/real.h"

namespace wholehand::device {

// Plane coordinates (u, v) are across the line of the tips, whose direction is u x v; rotations are positive about it.

// What moves. `lever` leads from the line to the center of mass.
struct SlidingBody {
  double mass = 0;     // kg, > 0
  double inertia = 0;  // kg m2, > 0: about the parallel to the line through the center of mass
  core_f64::Vec2 lever{};
};

// The largest friction of both tips together: (f / force)^2 + (m / moment)^2 <= 1 for a force f across the line with a moment m about it.
struct SlideFriction {
  double force = 0;   // N; 0: none
  double moment = 0;  // N m
};

// Velocity in the hand's frame: of the center of mass, and of the rotation. Zero: the vessel sticks.
struct SlideMotion {
  core_f64::Vec2 velocity{};  // m/s
  double spin = 0;            // rad/s
  bool is_rest() const noexcept { return velocity == core_f64::Vec2(0) && spin == 0; }
};

// What a step moved: the center of mass, and the vessel about it.
struct SlideStep {
  core_f64::Vec2 moved{};  // m
  double turned = 0;       // rad
  // m: the way of the contacts along the surface, where a turn counts at the radius moment / force of the friction. So friction does the work
  // force x slipped.
  double slipped = 0;
};

// Friction of two tips that press with `grip` N each: half of the force `along` their line, N, weighs on one of them and leaves the other that much
// less. `torsion` is the radius gamma of their torsional friction, m; a contact has at least LEAST_TORSION.
SlideFriction slide_friction(double grip, double along, double friction, double torsion) noexcept;

// How much of the friction a force at the center of mass, N, takes of a body at rest: up to 1 it stays at rest; infinite without friction.
double friction_share(const SlidingBody& body, core_f64::Vec2 load, const SlideFriction& friction) noexcept;

// Moves the body by `seconds` under a force at its center of mass, N. Kinetic energy less the work of `load` never grows, for any step; a body that
// friction holds rests exactly.
SlideStep slide_step(const SlidingBody& body, core_f64::Vec2 load, const SlideFriction& friction, double seconds,
                     SlideMotion& motion) noexcept;

constexpr double LEAST_TORSION = 1e-8;     // m: a moment numerically zero beside the force
constexpr double LONGEST_SLIDE = 0.25e-3;  // s: a longer step is divided

}  // namespace wholehand::device
