// SPDX-License-Identifier: MIT
// Twin of core/force.cpp.
#ifndef FORCE_GLSL
#define FORCE_GLSL

#include "real.glsl"

layout(constant_id = CONST_BARE) const bool BARE = true;
layout(std140, binding = BINDING_STATES) uniform StateBlock { Vec4 states_in[2 * STATES_IN_BLOCK]; };

struct Load {
  Real mass;
  Vec3 fixed_center;  // the vessel's own share of the center of mass
  Real lean, height;
};

Vec3 pour_direction(Vec3 direction, Real sense) {
  Real off_axis = sqrt(direction.x * direction.x + direction.z * direction.z);
  return Vec3(direction.z, Real(0), -direction.x) * (sense / off_axis);
}

Vec3 up_direction(Vec3 pour, Real sine_tilt, Real cosine_tilt) { return Vec3(Real(0), cosine_tilt, Real(0)) - sine_tilt * pour; }
Vec3 load_center(Load load, Vec3 pour) { return load.fixed_center + load.lean * pour + Vec3(Real(0), load.height, Real(0)); }
Real grip_reference(Real mass, Real gravity, Real pivot_length) { return mass * gravity * max(pivot_length, SMALLEST_PIVOT); }

Real normal_force(Real base, Real range, Real torque, Real reference) {
  return reference > Real(0) ? base + range * (torque / reference) : base;
}

Real feedback_force(Real normal, Real opening, Real max) { return clamp(normal + opening, Real(0), max); }
Real longest_bare_lever(Real pivot_length) { return BARE_LEVER * max(pivot_length, SMALLEST_PIVOT); }

Real strength_at(Real opening) {
  Real step = (opening - OPENING_FROM) / OPENING_STEP;
  return Real(1) - OPENING_GAIN * (Real(1) - clamp(step, Real(0), Real(1))) - OPENING_LOSS_1 * clamp(step - Real(1), Real(0), Real(1)) -
         OPENING_LOSS_2 * clamp(step - Real(2), Real(0), Real(1));
}

#endif
