// SPDX-License-Identifier: MIT
// Does the driver round a product before it is added, where a shader says `precise`? host/run_once.h asks.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "real.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(std430, binding = BINDING_REAL_OUT) buffer RealBlock { Real real_out[]; };

// Factors and addend come from the buffer: a compiler knows none of them.
void main() {
  if (INVOCATION > 0u) return;
  precise Real sum = real_out[0] * real_out[1] + real_out[2];
  real_out[3] = sum;
}
