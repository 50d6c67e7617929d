// SPDX-License-Identifier: MIT
#include "core/trig.h"

#include <algorithm>
#include <cmath>

namespace CORE_NS {

void sine_cosine(Real angle, Real& sine_out, Real& cosine_out) {
  sine_out = std::sin(angle);
  cosine_out = std::cos(angle);
}

Real arc_cosine(Real x) { return std::acos(std::clamp(x, Real(-1), Real(1))); }

// The chord between unit vectors is 2 sin(angle / 2): no cancellation near 0, and the chord to -b serves near pi.
Real angle_between(Vec3 a, Vec3 b) {
  const bool acute = glm::dot(a, b) >= 0;
  const Vec3 chord = acute ? a - b : a + b;
  const Real half = std::min(glm::length(chord) * Real(0.5), Real(1));
  const Real angle = Real(2) * (HALF_PI - arc_cosine(half));
  return acute ? angle : Real(2) * HALF_PI - angle;
}

Real direction_angle(Real y, Real x) { return std::atan2(y, x); }

Vec3 grip_direction(Real azimuth, Real obliquity) {
  Real sa = 0, ca = 0, sb = 0, cb = 0;
  sine_cosine(azimuth, sa, ca);
  sine_cosine(obliquity, sb, cb);
  return Vec3(cb * ca, sb, -cb * sa);
}

}  // namespace CORE_NS
