// SPDX-License-Identifier: MIT
// Tests whether the driver rounds a product before it is added if a shader says `precise`; used by host/run_once.h.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "real.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(std430, binding = BINDING_REAL_OUT) buffer RealBlock { Real real_out[]; };

// Factors and addend come from the buffer, so that no compiler knows them.
void main() {
  if (INVOCATION > 0u) return;
  precise Real sum = real_out[0] * real_out[1] + real_out[2];
  real_out[3] = sum;
}
