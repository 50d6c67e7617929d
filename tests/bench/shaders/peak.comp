// SPDX-License-Identifier: MIT
// Multiply-adds and nothing else, in chains that do not wait for each other: as many as a device can do. push.number turns.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "real.glsl"
#include "tests/bench/shaders/peak.h"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_FUSED) const bool FUSED = true;
layout(std430, binding = BINDING_REAL_OUT) writeonly buffer SumBlock { Real sums[]; };

Vec4 stepped(Vec4 x, Real factor, Real term) {
  if (FUSED) return fma(x, Vec4(factor), Vec4(term));
  precise Vec4 product = x * factor;
  precise Vec4 sum = product + term;
  return sum;
}

void main() {
  // what the compiler cannot know, with the fixed point 1: no number becomes too large or too small to be ordinary
  Real term = Real(1) / Real(push.stride), factor = Real(1) - term;
  Real start = Real(INVOCATION) / Real(push.count);
  Vec4 a = Vec4(start) + Vec4(1, 2, 3, 4), b = a + Vec4(4);
  [[dont_unroll]] for (uint turn = 0u; turn < push.number; ++turn) {
    [[unroll]] for (int step = 0; step < PEAK_STEPS; ++step) {
      a = stepped(a, factor, term);
      b = stepped(b, factor, term);
    }
  }
  Vec4 both = a + b;
  sums[INVOCATION] = both.x + both.y + both.z + both.w;
}
