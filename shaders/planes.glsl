// SPDX-License-Identifier: MIT
// Output planes: each field's first plane is a specialization constant, -1 where the field is left out.
#ifndef PLANES_GLSL
#define PLANES_GLSL

#include "real.glsl"

layout(constant_id = CONST_PLANE + FIELD_T_INDEX) const int PLANE_T_INDEX = -1;
layout(constant_id = CONST_PLANE + FIELD_T_THUMB) const int PLANE_T_THUMB = -1;
layout(constant_id = CONST_PLANE + FIELD_GAP) const int PLANE_GAP = -1;
layout(constant_id = CONST_PLANE + FIELD_MIDPOINT) const int PLANE_MIDPOINT = -1;
layout(constant_id = CONST_PLANE + FIELD_CLOSURE) const int PLANE_CLOSURE = -1;
layout(constant_id = CONST_PLANE + FIELD_CONTACT_ANGLES) const int PLANE_CONTACT_ANGLES = -1;
layout(constant_id = CONST_PLANE + FIELD_PHALANX_DEPTH) const int PLANE_PHALANX_DEPTH = -1;
layout(constant_id = CONST_PLANE + FIELD_PALM_DEPTH) const int PLANE_PALM_DEPTH = -1;
layout(constant_id = CONST_PLANE + FIELD_BONE_STRETCH) const int PLANE_BONE_STRETCH = -1;
layout(constant_id = CONST_PLANE + FIELD_JOINTS) const int PLANE_JOINTS = -1;
layout(constant_id = CONST_PLANE + FIELD_POSED) const int PLANE_POSED = -1;
layout(constant_id = CONST_PLANE + FIELD_PROXIES) const int PLANE_PROXIES = -1;
layout(constant_id = CONST_PLANE + FIELD_SEPARATION) const int PLANE_SEPARATION = -1;
layout(constant_id = CONST_PLANE + FIELD_PEAK_FORCE) const int PLANE_PEAK_FORCE = -1;
layout(constant_id = CONST_PLANE + FIELD_PEAK_TILT) const int PLANE_PEAK_TILT = -1;
layout(constant_id = CONST_PLANE + FIELD_LARGEST_HOLD) const int PLANE_LARGEST_HOLD = -1;
layout(constant_id = CONST_PLANE + FIELD_SAFE_TILT) const int PLANE_SAFE_TILT = -1;
layout(constant_id = CONST_PLANE + FIELD_SCORE) const int PLANE_SCORE = -1;
layout(constant_id = CONST_PLANE + FIELD_TERMS) const int PLANE_TERMS = -1;
layout(constant_id = CONST_PLANE + FIELD_PIVOT_LENGTH) const int PLANE_PIVOT_LENGTH = -1;
layout(constant_id = CONST_PLANE + FIELD_TORQUE) const int PLANE_TORQUE = -1;
layout(constant_id = CONST_PLANE + FIELD_EXACT_TORQUE) const int PLANE_EXACT_TORQUE = -1;
layout(constant_id = CONST_PLANE + FIELD_NORMAL_FORCE) const int PLANE_NORMAL_FORCE = -1;
layout(constant_id = CONST_PLANE + FIELD_FEEDBACK_FORCE) const int PLANE_FEEDBACK_FORCE = -1;
layout(constant_id = CONST_PLANE + FIELD_HOLD_FORCE) const int PLANE_HOLD_FORCE = -1;
layout(constant_id = CONST_PLANE + FIELD_STATUS) const int PLANE_STATUS = -1;
layout(constant_id = CONST_PLANE + FIELD_TOUCH_MASK) const int PLANE_TOUCH_MASK = -1;
layout(constant_id = CONST_PLANE + FIELD_TIP_MASK) const int PLANE_TIP_MASK = -1;
layout(constant_id = CONST_PLANE + FIELD_FINGER_MASK) const int PLANE_FINGER_MASK = -1;
layout(constant_id = CONST_PLANE + FIELD_INNER_MASK) const int PLANE_INNER_MASK = -1;
layout(constant_id = CONST_PLANE + FIELD_USED_MASK) const int PLANE_USED_MASK = -1;

layout(std430, binding = BINDING_REAL_OUT) buffer RealBlock { Real real_out[]; };
layout(std430, binding = BINDING_UINT_OUT) buffer UintBlock { uint uint_out[]; };

void put_real(int plane, int offset, uint grip, Real value) {
  if (plane >= 0) real_out[uint(plane + offset) * push.stride + grip] = value;
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
