// SPDX-License-Identifier: MIT
// Basic arithmetic of Triples, and conversion of Triples and Rotations to and from the kernels' vectors and matrices.
#pragma once

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/scene.h"

namespace wholehand {

inline double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double norm(const Triple& v) { return std::hypot(v[0], v[1], v[2]); }
inline double distance(const Triple& a, const Triple& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }
// The point at t on the line that is a at t = 0 and b at t = 1.
inline Triple point_between(const Triple& a, const Triple& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}
// Rounds differently from point_between(a, b, 0.5).
inline Triple midpoint(const Triple& a, const Triple& b) { return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])}; }

template <class Real = double>
glm::vec<3, Real> to_vec3(const Triple& t) {
  return {static_cast<Real>(t[0]), static_cast<Real>(t[1]), static_cast<Real>(t[2])};
}
template <class Real>
Triple to_triple(const glm::vec<3, Real>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// Unit columns at right angles, to the tolerance, and the third is the product of the first two.
inline bool is_rotation(const Rotation& r, double tolerance) {
  const auto dot = [&r](int a, int b) { return r[a] * r[b] + r[3 + a] * r[3 + b] + r[6 + a] * r[6 + b]; };
  bool holds = true;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) holds = holds && std::abs(dot(a, b) - (a == b ? 1 : 0)) <= tolerance;
  const double volume =
      r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) + r[2] * (r[3] * r[7] - r[4] * r[6]);
  return holds && volume > 0;
}

// glm stores columns.
inline glm::dmat3 to_mat3(const Rotation& r) { return {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]}; }
inline Rotation to_rotation(const glm::dmat3& m) {
  return {m[0].x, m[1].x, m[2].x, m[0].y, m[1].y, m[2].y, m[0].z, m[1].z, m[2].z};
}

}  // namespace wholehand
