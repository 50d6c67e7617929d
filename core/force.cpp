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

// tau_ref = m g max(L, L_min): without a least lever, a grip at the center of mass would have no reference.
Real grip_reference(Real mass, Real gravity, Real pivot_length) {
  return mass * gravity * std::max(pivot_length, Real(SMALLEST_PIVOT));
}

// F_n = F_base + F_range tau / tau_ref. Degenerate: tau_ref = 0 leaves F_base.
Real normal_force(Real base, Real range, Real torque, Real reference) {
  return reference > 0 ? base + range * (torque / reference) : base;
}

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

}  // namespace CORE_NS
