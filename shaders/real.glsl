// SPDX-License-Identifier: MIT
// The shaders' number type: every kernel is compiled with float and with double (REAL_IS_DOUBLE comes from the build).
#ifndef REAL_GLSL
#define REAL_GLSL

#if REAL_IS_DOUBLE
#define Real double
#define Vec2 dvec2
#define Vec3 dvec3
#define Vec4 dvec4
#define Mat3 dmat3
#define NAMED_STOP_TOLERANCE Real(STOP_TOLERANCE_F64)
#define DEGENERATE_SINE Real(DEGENERATE_SINE_F64)
#define HALF_PI 1.5707963267948966192lf
#define NO_DISTANCE 1.7976931348623157e308lf
#define NOT_A_NUMBER packDouble2x32(uvec2(0u, 0x7ff80000u))
#define INFINITE packDouble2x32(uvec2(0u, 0x7ff00000u))
#else
#define Real float
#define Vec2 vec2
#define Vec3 vec3
#define Vec4 vec4
#define Mat3 mat3
#define NAMED_STOP_TOLERANCE STOP_TOLERANCE_F32
#define DEGENERATE_SINE DEGENERATE_SINE_F32
#define HALF_PI 1.5707963267948966192
#define NO_DISTANCE 3.402823466e38
#define NOT_A_NUMBER uintBitsToFloat(0x7fc00000u)
#define INFINITE uintBitsToFloat(0x7f800000u)
#endif

#include "layout.h"

// Where iterations end, as in core/real.h's Limits.
layout(constant_id = CONST_STOP_TOLERANCE) const Real STOP_TOLERANCE = NAMED_STOP_TOLERANCE;
layout(constant_id = CONST_TRACE_STEPS) const int LIMIT_TRACE_STEPS = TRACE_STEPS;
layout(constant_id = CONST_ADVANCE_STEPS) const int LIMIT_ADVANCE_STEPS = ADVANCE_STEPS;
layout(constant_id = CONST_GAP_STEPS) const int LIMIT_GAP_STEPS = GAP_STEPS;
layout(constant_id = CONST_FEW_STEPS) const bool FEW_STEPS = false;

// For numbers that are not NaN. A driver's min and max handle NaN, at three times the cost.
Real smaller(Real a, Real b) { return b < a ? b : a; }
Real larger(Real a, Real b) { return a < b ? b : a; }

// By its bits, because a driver without SignedZeroInfNanPreserve may assume that comparisons have no NaN. It may also assume that all numbers are
// finite, so the kernels test finiteness by `< NO_DISTANCE`.
bool is_no_number(Real a) {
#if REAL_IS_DOUBLE
  return (unpackDouble2x32(a).y & 0x7fffffffu) > 0x7ff00000u;
#else
  return (floatBitsToUint(a) & 0x7fffffffu) > 0x7f800000u;
#endif
}

// Index of this invocation if groups run along x and then along y, as the host dispatches them.
#define INVOCATION ((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x)

layout(std140, binding = BINDING_PARAMETERS) uniform ParameterBlock { Parameters scene; };
layout(push_constant) uniform PushBlock { uint count, stride, first, number, floor_low, floor_high, flag; } push;  // as Push of layout.h

Real push_floor() {
#if REAL_IS_DOUBLE
  return packDouble2x32(uvec2(push.floor_low, push.floor_high));
#else
  return uintBitsToFloat(push.floor_low);
#endif
}

// Counts how many lanes of a vector do useful work, for a benchmark that compiles the kernels with COUNTS_LANES. The program's own kernels have none
// of it.
#ifdef COUNTS_LANES
#extension GL_KHR_shader_subgroup_ballot : require

layout(std430, binding = BINDING_LANES) buffer LaneBlock { uint useful_lanes, all_lanes; };

// On each visit of a subgroup, adds its active useful lanes, and all its lanes.
void count_lanes(bool is_useful) {
  uint useful = subgroupBallotBitCount(subgroupBallot(is_useful));
  if (subgroupElect()) {
    atomicAdd(useful_lanes, useful);
    atomicAdd(all_lanes, gl_SubgroupSize);
  }
}
#define COUNT_LANES(is_useful) count_lanes(is_useful)
#else
#define COUNT_LANES(is_useful)
#endif

#endif
