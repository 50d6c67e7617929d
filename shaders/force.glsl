// SPDX-License-Identifier: MIT
// Twin of core/force.cpp.
#ifndef FORCE_GLSL
#define FORCE_GLSL

#include "real.glsl"

struct Load {
  Real mass;
  Vec3 fixed_center;  // the vessel's own share of the centre of mass
  Real lean, height;
};

Vec3 pour_direction(Vec3 direction, Real sense) {
  Real off_axis = sqrt(direction.x * direction.x + direction.z * direction.z);
  return Vec3(direction.z, Real(0), -direction.x) * (sense / off_axis);
}

Vec3 up_direction(Vec3 pour, Real sine_tilt, Real cosine_tilt) { return Vec3(Real(0), cosine_tilt, Real(0)) - sine_tilt * pour; }

Vec3 load_center(Load load, Vec3 pour) { return load.fixed_center + load.lean * pour + Vec3(Real(0), load.height, Real(0)); }

Real pendulum_torque(Real mass, Real gravity, Real pivot_length, Real sine_tilt) {
  return mass * gravity * pivot_length * sine_tilt;
}

Real exact_pendulum_torque(Real mass, Real gravity, Vec3 arm, Vec3 pour, Real sine_tilt, Real cosine_tilt) {
  return mass * gravity * (sine_tilt * arm.y + cosine_tilt * dot(arm, pour));
}

Real grip_reference(Real mass, Real gravity, Real pivot_length) { return mass * gravity * max(pivot_length, SMALLEST_PIVOT); }

Real normal_force(Real base, Real range, Real torque, Real reference) {
  return reference > Real(0) ? base + range * (torque / reference) : base;
}

Real opening_force(Real k_open, Real squeeze) { return k_open * squeeze; }

Real feedback_force(Real normal, Real opening, Real max) { return clamp(normal + opening, Real(0), max); }

Real longest_bare_lever(Real pivot_length) { return BARE_LEVER * max(pivot_length, SMALLEST_PIVOT); }

Real strength_at(Real opening) {
  Real step = (opening - OPENING_FROM) / OPENING_STEP;
  return Real(1) - OPENING_GAIN * (Real(1) - clamp(step, Real(0), Real(1))) - OPENING_LOSS_1 * clamp(step - Real(1), Real(0), Real(1)) -
         OPENING_LOSS_2 * clamp(step - Real(2), Real(0), Real(1));
}

Real hold_force(Real mass, Real gravity, Vec3 arm, Vec3 direction, Vec3 up, Real friction, Real torsion) {
  Real weight = mass * gravity;
  Real along = dot(direction, up);
  Real lever = abs(dot(direction, cross(arm, up)));
  bool bare = !(torsion > Real(0));
  if (bare && weight > Real(0) && lever > longest_bare_lever(length(arm))) return INFINITE;
  Real across_squared = weight * weight * max(Real(0), Real(1) - along * along) * Real(0.25);
  Real twist = bare ? Real(0) : weight * lever / (Real(2) * torsion);
  Real sideways = sqrt(across_squared + twist * twist);
  if (sideways > Real(0) && !(friction > Real(0))) return INFINITE;
  Real held = sideways > Real(0) ? sideways / friction : Real(0);
  return held + weight * abs(along) * Real(0.5);
}

Vec3 coupling_force(Vec3 tip, Vec3 proxy, Vec3 normal, Vec3 velocity, Real stiffness, Real damping) {
  Vec3 force = stiffness * (proxy - tip) - damping * dot(velocity, normal) * normal;
  Real push_out = dot(force, normal);
  return push_out < Real(0) ? force - push_out * normal : force;
}

#endif
