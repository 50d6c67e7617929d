// SPDX-License-Identifier: MIT
// Loops whose turns are known, push.first times push.number of one within the other, to see what a driver counts.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "real.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(std430, binding = BINDING_UINT_OUT) buffer TurnBlock { uint turns_out[]; };

void kernel() {
  uint turns = 0u, mixed = INVOCATION;
  for (uint outer = 0u; outer < push.first; ++outer)
    for (uint inner = 0u; inner < push.number; ++inner) {
      mixed = mixed * 1664525u + outer;
      turns += mixed == 0u ? 2u : 1u;
    }
  turns_out[INVOCATION] = turns;
}

#include "meter.glsl"
