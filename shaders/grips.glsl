// SPDX-License-Identifier: MIT
// The grips of a dispatch as kernels read and write them: axes in, planes out, and the busy grips of a group.
#ifndef GRIPS_GLSL
#define GRIPS_GLSL

#include "real.glsl"
#include "status.h"

layout(local_size_x_id = CONST_GROUP_SIZE) in;  // before INVOCATION, which would otherwise take groups of one
layout(std430, binding = BINDING_GRIPS) readonly buffer GripBlock { Real grips_in[]; };
layout(std430, binding = BINDING_REAL_OUT) buffer RealBlock { Real real_out[]; };
layout(std430, binding = BINDING_UINT_OUT) buffer UintBlock { uint uint_out[]; };

// Each field's first plane; -1 if the field is left out.
#define DECLARE_PLANE(name, number) layout(constant_id = CONST_PLANE + number) const int PLANE_##name = -1;
REAL_FIELD_LIST(DECLARE_PLANE)
UINT_FIELD_LIST(DECLARE_PLANE)

Real grip_axis(int axis, uint grip) { return grips_in[uint(axis) * push.stride + grip]; }
uint status_of(uint grip) { return uint_out[uint(PLANE_STATUS) * push.stride + grip]; }
Real kept(int plane, int offset, uint grip) { return plane >= 0 ? real_out[uint(plane + offset) * push.stride + grip] : NOT_A_NUMBER; }

Vec3 kept_vector(int plane, uint grip) {
  uint at = uint(plane) * push.stride + grip;
  return Vec3(real_out[at], real_out[at + push.stride], real_out[at + 2u * push.stride]);
}

void put_uint(int plane, uint grip, uint value) {
  if (plane >= 0) uint_out[uint(plane) * push.stride + grip] = value;
}

void put_real(int plane, int offset, uint grip, Real value) {
  if (plane >= 0) real_out[uint(plane + offset) * push.stride + grip] = value;
}

void put_point(int plane, int point, uint grip, Vec3 value) {
  put_real(plane, 3 * point, grip, value.x);
  put_real(plane, 3 * point + 1, grip, value.y);
  put_real(plane, 3 * point + 2, grip, value.z);
}

shared uint busy_grips[GROUP_SIZE];
shared uint busy_count;

// Packs the group's busy grips into its first invocations, because all lanes of a vector run until the slowest is done. True: this invocation has
// one, `grip`. All invocations of the group call it, once.
bool take_grip(bool is_busy, out uint grip) {
  if (gl_LocalInvocationIndex == 0u) busy_count = 0u;
  barrier();
  if (is_busy) busy_grips[atomicAdd(busy_count, 1u)] = INVOCATION;
  barrier();
  bool has_grip = gl_LocalInvocationIndex < busy_count;
  grip = has_grip ? busy_grips[gl_LocalInvocationIndex] : 0u;
  return has_grip;
}

bool take_feasible_grip(out uint grip) { return take_grip(INVOCATION < push.count && is_feasible(status_of(INVOCATION)), grip); }

#endif
