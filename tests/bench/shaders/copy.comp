// SPDX-License-Identifier: MIT
// A copy of push.count pieces of 16 bytes, one an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "real.glsl"
#include "tests/bench/shaders/peak.h"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(std430, binding = BINDING_GRIPS) readonly buffer FromBlock { uvec4 from[]; };
layout(std430, binding = BINDING_REAL_OUT) writeonly buffer ToBlock { uvec4 to[]; };

void main() {
  if (INVOCATION < push.count) to[INVOCATION] = from[INVOCATION];
}
