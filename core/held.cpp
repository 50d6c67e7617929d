// SPDX-License-Identifier: MIT
#include "core/held.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace CORE_NS {

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
