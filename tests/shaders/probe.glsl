// SPDX-License-Identifier: MIT
// A probe evaluates one leaf function (probe_table.h) per invocation: rows of push.stride numbers in, of push.number numbers out.
#ifndef PROBE_GLSL
#define PROBE_GLSL

#include "real.glsl"
#include "tests/shaders/probe_table.h"

layout(local_size_x = 64) in;
layout(constant_id = CONST_PROBE) const int PROBE = -1;
layout(std430, binding = BINDING_GRIPS) readonly buffer GivenBlock { Real given_values[]; };
layout(std430, binding = BINDING_REAL_OUT) writeonly buffer AnswerBlock { Real answer_values[]; };

uint row() { return gl_GlobalInvocationID.x; }

Real given(int k) { return given_values[row() * push.stride + uint(k)]; }
Vec3 given3(int k) { return Vec3(given(k), given(k + 1), given(k + 2)); }
int given_int(int k) { return int(roundEven(given(k))); }

void answer(int k, Real value) { answer_values[row() * push.number + uint(k)] = value; }
void answer3(int k, Vec3 value) {
  answer(k, value.x);
  answer(k + 1, value.y);
  answer(k + 2, value.z);
}

#endif
