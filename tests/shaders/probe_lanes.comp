// SPDX-License-Identifier: MIT
// A loop whose useful lanes are known, to see whether a device counts them right: a lane takes a turn more than its neighbor, up to push.number,
// and every other turn is useful.
#version 460
#extension GL_GOOGLE_include_directive : require
#define COUNTS_LANES

#include "real.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;

void main() {
  for (uint turn = 0u; turn <= gl_SubgroupInvocationID % push.number; ++turn) COUNT_LANES(turn % 2u == 0u);
}
