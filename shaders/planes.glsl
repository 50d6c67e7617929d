// SPDX-License-Identifier: MIT
// Output planes: each field's first plane is a specialization constant, -1 where the field is left out.
#ifndef PLANES_GLSL
#define PLANES_GLSL

#include "real.glsl"

#define DECLARE_PLANE(name, number) layout(constant_id = CONST_PLANE + number) const int PLANE_##name = -1;
REAL_FIELD_LIST(DECLARE_PLANE)
UINT_FIELD_LIST(DECLARE_PLANE)

layout(std430, binding = BINDING_REAL_OUT) buffer RealBlock { Real real_out[]; };
layout(std430, binding = BINDING_UINT_OUT) buffer UintBlock { uint uint_out[]; };

void put_real(int plane, int offset, uint grip, Real value) {
  if (plane >= 0) real_out[uint(plane + offset) * push.stride + grip] = value;
}

Real kept(int plane, int offset, uint grip) { return plane >= 0 ? real_out[uint(plane + offset) * push.stride + grip] : NOT_A_NUMBER; }

Vec3 kept_vector(int plane, uint grip) {
  uint at = uint(plane) * push.stride + grip;
  return Vec3(real_out[at], real_out[at + push.stride], real_out[at + 2u * push.stride]);
}

void put_uint(int plane, uint grip, uint value) {
  if (plane >= 0) uint_out[uint(plane) * push.stride + grip] = value;
}

void put_point(int plane, int point, uint grip, Vec3 value) {
  put_real(plane, 3 * point, grip, value.x);
  put_real(plane, 3 * point + 1, grip, value.y);
  put_real(plane, 3 * point + 2, grip, value.z);
}

#endif
