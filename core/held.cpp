// SPDX-License-Identifier: MIT
#include "core/held.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace CORE_NS {

// Eq. (1) of the paper: tau = m g L sin t, as if the center of mass were straight above or below the pivot M, at L = |CoM - M|.
Real pendulum_torque(Real mass, Real gravity, Real pivot_length, Real sine_tilt) {
  return mass * gravity * pivot_length * sine_tilt;
}

// The lever arm against gravity: potential m g (CoM - M) . u has the derivative -m g (CoM - M) . (sin t y + cos t n) by the tilt.
Real exact_pendulum_torque(Real mass, Real gravity, Vec3 arm, Vec3 pour, Real sine_tilt, Real cosine_tilt) {
  return mass * gravity * (sine_tilt * arm.y + cosine_tilt * glm::dot(arm, pour));
}

// F_o = k_open (g_grasp - g): a user who squeezes feels more, one who opens feels less.
Real opening_force(Real k_open, Real squeeze) { return k_open * squeeze; }

// Limit surface of each of two contacts: (f_t / (mu N))^2 + (tau_n / (mu gamma N))^2 <= 1, with the load across d and the moment
// about d shared; the load along d adds half of itself to one side. With w = d . u, r = CoM - M and tau_d = m g |d . (r x u)|:
//   N = sqrt((m g)^2 (1 - w^2) / 4 + (tau_d / (2 gamma))^2) / mu + m g |w| / 2
// Degenerate: without torsion a lever that counts, and without friction whatever lies across d, needs an infinite force.
Real hold_force(Real mass, Real gravity, Vec3 arm, Vec3 direction, Vec3 up, Real friction, Real torsion) {
  const Real weight = mass * gravity;
  const Real along = glm::dot(direction, up);
  const Real lever = std::abs(glm::dot(direction, glm::cross(arm, up)));
  const bool bare = !(torsion > 0);  // a contact of no extent
  if (bare && weight > 0 && lever > longest_bare_lever(glm::length(arm))) return std::numeric_limits<Real>::infinity();
  const Real across_squared = weight * weight * std::max(Real(0), Real(1) - along * along) * Real(0.25);
  const Real twist = bare ? Real(0) : weight * lever / (Real(2) * torsion);
  const Real sideways = std::sqrt(across_squared + twist * twist);
  if (sideways > 0 && !(friction > 0)) return std::numeric_limits<Real>::infinity();
  const Real held = sideways > 0 ? sideways / friction : Real(0);
  return held + weight * std::abs(along) * Real(0.5);
}

// F = K (proxy - tip) - B (v . n) n, without any part that points into the surface: nothing sticks.
Vec3 coupling_force(Vec3 tip, Vec3 proxy, Vec3 normal, Vec3 velocity, Real stiffness, Real damping) {
  const Vec3 force = stiffness * (proxy - tip) - damping * glm::dot(velocity, normal) * normal;
  const Real push = glm::dot(force, normal);
  return push < 0 ? force - push * normal : force;
}

Load load_with(const Vessel& vessel, Real liquid_mass, Real lean, Real height) {
  Load load;
  load.mass = vessel.mass + liquid_mass;
  const Real share = load.mass > 0 ? liquid_mass / load.mass : Real(0);
  load.fixed = (Real(1) - share) * vessel.center_of_mass;
  load.lean = share * lean;
  load.height = share * height;
  return load;
}

Real object_reference(Load largest, Real gravity, Real base_height, Real mouth_height) {
  const Real center = largest.fixed.y + largest.height;
  return largest.mass * gravity * std::max(center - base_height, mouth_height - center);
}

HeldForces held_forces(const ForceScale& scale, Load load, Load largest, Vec3 direction, Vec3 midpoint, Vec3 pour, Real sine_tilt,
                       Real cosine_tilt, bool antipodal, Real squeeze) {
  HeldForces held;
  held.center = load_center(load, pour);
  const Vec3 arm = held.center - midpoint;
  held.pivot_length = glm::length(arm);
  held.torque = pendulum_torque(load.mass, scale.gravity, held.pivot_length, sine_tilt);
  held.exact_torque = exact_pendulum_torque(load.mass, scale.gravity, arm, pour, sine_tilt, cosine_tilt);
  const Real reference = scale.per_grip
                             ? grip_reference(largest.mass, scale.gravity, glm::length(load_center(largest, pour) - midpoint))
                             : scale.reference;
  const Real torque = scale.exact_torque ? std::abs(held.exact_torque) : held.torque;
  held.normal = normal_force(scale.base, scale.range, torque, reference);
  held.opening = opening_force(scale.k_open, squeeze);
  held.feedback = feedback_force(held.normal, held.opening, scale.max);
  held.hold = antipodal ? hold_force(load.mass, scale.gravity, arm, direction, up_direction(pour, sine_tilt, cosine_tilt),
                                     scale.friction, scale.torsion)
                        : std::numeric_limits<Real>::infinity();
  return held;
}

}  // namespace CORE_NS
