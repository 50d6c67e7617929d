// SPDX-License-Identifier: MIT
// Sine, cosine and arc cosine, here from the standard library. The twin shaders/trig.glsl has polynomials, because Vulkan guarantees its own sine
// only to 2^-11. So this pair alone among the twins has the same functions with different mathematics.
#pragma once

#include <cmath>

#include "core/real.h"

namespace CORE_NS {

// Sine and cosine of an angle in rad, |angle| <= 16 (the shaders' range; every angle of a hand or grip is far inside).
inline Real sine(Real angle) { return std::sin(angle); }
inline Real cosine(Real angle) { return std::cos(angle); }
void sine_cosine(Real angle, Real& sine_out, Real& cosine_out);
// Arc cosine in [0, pi]; arguments beyond [-1, 1] are clamped.
Real arc_cosine(Real x);
// Angle between two unit vectors in [0, pi], rad; accurate near 0 and pi, where the arc cosine of their product is not.
Real angle_between(Vec3 a, Vec3 b);
// Angle of (x, y) from the x axis, in [-pi, pi]; 0 for (0, 0).
Real direction_angle(Real y, Real x);
// Thumb-to-index direction Ry(azimuth) Rz(obliquity) (1, 0, 0).
Vec3 grip_direction(Real azimuth, Real obliquity);

}  // namespace CORE_NS
