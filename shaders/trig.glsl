// SPDX-License-Identifier: MIT
// Twin of core/trig.cpp: polynomials, because Vulkan guarantees its own sine only to 2^-11. Arguments are reduced to [-pi/4, pi/4] with pi/2 in three
// parts; the minimax polynomials there were fitted for this project. Errors in units in the last place of 1 (2^-23, 2^-52), float and double
// (tests/shaders/parity_leaf_test.cpp): sine and cosine 1 for |angle| <= 16; arc cosine 3; angle_between 4, apart from its arguments' rounding;
// direction_angle 4.
#ifndef TRIG_GLSL
#define TRIG_GLSL

#include "real.glsl"

void sine_cosine(Real angle, out Real sine_out, out Real cosine_out) {
  precise Real turns = roundEven(angle * (Real(1) / HALF_PI));
#if REAL_IS_DOUBLE
  precise Real r = ((angle - turns * 1.57079632673412561416626lf) - turns * 6.077100506303965976595549e-11lf) -
                   turns * 2.0222662487959507324e-21lf;
  precise Real z = r * r;
  precise Real ps = ((((1.5916726193889337421e-10lf * z - 2.5051112272573243662e-8lf) * z + 2.7557316008171551075e-6lf) * z -
                      1.9841269836575709034e-4lf) * z + 8.3333333333308270041e-3lf) * z - 1.6666666666666664498e-1lf;
  precise Real pc = ((((-1.1381754653662936764e-11lf * z + 2.0876134024090146233e-9lf) * z - 2.7557317212686590119e-7lf) * z +
                      2.4801587298651291568e-5lf) * z - 1.3888888888887321242e-3lf) * z + 4.166666666666666531e-2lf;
#else
  precise Real r = ((angle - turns * 1.5703125) - turns * 4.837512969970703125e-4) - turns * 7.54978995489e-8;
  precise Real z = r * r;
  precise Real ps = (-0.000195853732067 * z + 0.00833273655918) * z - 0.166666646018;
  precise Real pc = (2.45454190784e-5 * z - 0.00138882913006) * z + 0.0416666645988;
#endif
  precise Real s = r + r * (z * ps);
  precise Real c = Real(1) - (Real(0.5) * z - z * z * pc);
  int quarter = int(turns) & 3;
  bool swap = (quarter & 1) != 0;
  Real first = swap ? c : s;
  Real second = swap ? s : c;
  sine_out = (quarter & 2) != 0 ? -first : first;
  cosine_out = ((quarter + 1) & 2) != 0 ? -second : second;
}

// Beyond 1/2 it uses the half angle: acos x = 2 asin sqrt((1 - x) / 2).
Real arc_cosine(Real x) {
  Real size = min(abs(x), Real(1));
  bool steep = size > Real(0.5);
  precise Real z = steep ? Real(0.5) * (Real(1) - size) : size * size;
  Real s = steep ? sqrt(z) : size;
#if REAL_IS_DOUBLE
  precise Real p = ((((0.028187667142318098934lf * z - 0.010773195325585556887lf) * z + 0.016049124584949317838lf) * z +
                     0.0077986264075622330216lf) * z + 0.011876344296279416692lf) * z + 0.013929545950485803228lf;
  p = (((((p * z + 0.017355268563953518903lf) * z + 0.022372047201808885135lf) * z + 0.030381947379559159502lf) * z +
        0.044642857103239559945lf) * z + 0.075000000000208696712lf) * z + 0.16666666666666648529lf;
#else
  precise Real p = (((0.038093962148 * z + 0.0265506629637) * z + 0.0450018940883) * z + 0.0749885296226) * z + 0.166666724277;
#endif
  precise Real arc_sine = s + s * (z * p);
  Real acute = steep ? Real(2) * arc_sine : HALF_PI - arc_sine;
  return x < Real(0) ? Real(2) * HALF_PI - acute : acute;
}

Real angle_between(Vec3 a, Vec3 b) {
  bool acute = dot(a, b) >= Real(0);
  Vec3 chord = acute ? a - b : a + b;
  Real half_chord = min(length(chord) * Real(0.5), Real(1));
  Real angle = Real(2) * (HALF_PI - arc_cosine(half_chord));
  return acute ? angle : Real(2) * HALF_PI - angle;
}

// The arc sine of the triangle's smaller side; that of the larger would lose digits.
Real direction_angle(Real y, Real x) {
  Real size = sqrt(x * x + y * y);
  if (!(size > Real(0))) return Real(0);
  Real arc_sine = HALF_PI - arc_cosine(min(abs(y), abs(x)) / size);
  Real acute = abs(y) > abs(x) ? HALF_PI - arc_sine : arc_sine;
  Real angle = x < Real(0) ? Real(2) * HALF_PI - acute : acute;
  return y < Real(0) ? -angle : angle;
}

Vec3 grip_direction(Real azimuth, Real obliquity) {
  Real sa, ca, sb, cb;
  sine_cosine(azimuth, sa, ca);
  sine_cosine(obliquity, sb, cb);
  return Vec3(cb * ca, sb, -cb * sa);
}

#endif
