// SPDX-License-Identifier: MIT
#include "core/force.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace CORE_NS {

// (0, 1, 0) x d = (d.z, 0, -d.x). A line along the axis has no such direction: such a grip is degenerate and never gets here.
Vec3 pour_direction(Vec3 direction, Real sense) {
  const Real off_axis = std::sqrt(direction.x * direction.x + direction.z * direction.z);
  return Vec3(direction.z, 0, -direction.x) * (sense / off_axis);
}

// The vessel turns by t towards n, so in its own frame up turns the other way: u = cos t (0, 1, 0) - sin t n.
Vec3 up_direction(Vec3 pour, Real sine_tilt, Real cosine_tilt) { return Vec3(0, cosine_tilt, 0) - sine_tilt * pour; }

Vec3 load_center(Load load, Vec3 pour) { return load.fixed + load.lean * pour + Vec3(0, load.height, 0); }

// Eq. (1) of the paper: tau = m g L sin t, as if the centre of mass were straight above or below the pivot M, at L = |CoM - M|.
Real pendulum_torque(Real mass, Real gravity, Real pivot_length, Real sine_tilt) {
  return mass * gravity * pivot_length * sine_tilt;
}

// The lever arm against gravity: potential m g (CoM - M) . u has the derivative -m g (CoM - M) . (sin t y + cos t n) by the tilt.
Real exact_pendulum_torque(Real mass, Real gravity, Vec3 arm, Vec3 pour, Real sine_tilt, Real cosine_tilt) {
  return mass * gravity * (sine_tilt * arm.y + cosine_tilt * glm::dot(arm, pour));
}

// tau_ref = m g max(L, L_min): without a least lever, a grip at the centre of mass would have no reference.
Real grip_reference(Real mass, Real gravity, Real pivot_length) {
  return mass * gravity * std::max(pivot_length, Real(SMALLEST_PIVOT));
}

// F_n = F_base + F_range tau / tau_ref. Degenerate: tau_ref = 0 leaves F_base.
Real normal_force(Real base, Real range, Real torque, Real reference) {
  return reference > 0 ? base + range * (torque / reference) : base;
}

// F_o = k_open (g_grasp - g): a user who squeezes feels more, one who opens feels less.
Real opening_force(Real k_open, Real squeeze) { return k_open * squeeze; }

// F = clamp(F_n + F_o, 0, F_max).
Real feedback_force(Real normal, Real opening, Real max) { return std::clamp(normal + opening, Real(0), max); }

// A share of the grip's own length and no absolute one: far above what rounding makes of a lever, in either precision.
Real longest_bare_lever(Real pivot_length) { return Real(BARE_LEVER) * std::max(pivot_length, Real(SMALLEST_PIVOT)); }

Real strength_at(Real opening) {
  constexpr Real FROM = Real(OPENING_FROM), STEP = Real(OPENING_STEP), GAIN = Real(OPENING_GAIN), LOSS_1 = Real(OPENING_LOSS_1),
                 LOSS_2 = Real(OPENING_LOSS_2);
  const Real step = (opening - FROM) / STEP;
  return Real(1) - GAIN * (Real(1) - std::clamp(step, Real(0), Real(1))) - LOSS_1 * std::clamp(step - Real(1), Real(0), Real(1)) -
         LOSS_2 * std::clamp(step - Real(2), Real(0), Real(1));
}

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

// F = K (proxy - tip) - B (v . n) n, less what of it points into the surface: nothing sticks.
Vec3 coupling_force(Vec3 tip, Vec3 proxy, Vec3 normal, Vec3 velocity, Real stiffness, Real damping) {
  const Vec3 force = stiffness * (proxy - tip) - damping * glm::dot(velocity, normal) * normal;
  const Real push = glm::dot(force, normal);
  return push < 0 ? force - push * normal : force;
}

}  // namespace CORE_NS
