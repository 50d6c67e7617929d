// SPDX-License-Identifier: MIT
// The kernels' number type. `core/` is compiled once per precision: REAL and CORE_NS come from the build
// (double/core_f64 for the product, float/core_f32 and long double/core_ld for comparisons).
#pragma once

#ifndef REAL
#define REAL double
#define CORE_NS core_f64
#endif

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <limits>

#include "shaders/layout.h"

namespace CORE_NS {

using Real = REAL;
using Vec2 = glm::vec<2, Real>;
using Vec3 = glm::vec<3, Real>;
using Mat3 = glm::mat<3, 3, Real>;

// Named tolerances of layout.h at this precision.
constexpr bool SINGLE = sizeof(Real) == sizeof(float);
constexpr Real STOP_TOLERANCE = SINGLE ? Real(STOP_TOLERANCE_F32) : Real(STOP_TOLERANCE_F64);
constexpr Real DEGENERATE_SINE = SINGLE ? Real(DEGENERATE_SINE_F32) : Real(DEGENERATE_SINE_F64);
constexpr Real HALF_PI = Real(1.5707963267948966192313216916397514L);
constexpr Real NO_DISTANCE = std::numeric_limits<Real>::max();

// Where iterations end: the named values, or others that measure their cost.
struct Limits {
  Real stop_tolerance = STOP_TOLERANCE;  // m
  int trace_steps = TRACE_STEPS;
  int advance_steps = ADVANCE_STEPS;
  int gap_steps = GAP_STEPS;
};

}  // namespace CORE_NS
