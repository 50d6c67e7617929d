// SPDX-License-Identifier: MIT
// A loop whose useful lanes are known, to see whether a device counts them right.
#version 460
#extension GL_GOOGLE_include_directive : require
#define COUNTS_LANES

#include "real.glsl"
#include "tests/bench/shaders/peak.h"

layout(local_size_x_id = CONST_GROUP_SIZE) in;

void main() {
  for (uint turn = 0u; turn <= gl_SubgroupInvocationID % PROBE_TURNS; ++turn) COUNT_LANES(turn % 2u == 0u);
}
