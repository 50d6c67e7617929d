// SPDX-License-Identifier: MIT
#version 450
// out[i] = weights.x * in[i - 1] + weights.y * in[(i + 1) mod count]: reads what other invocations of the step before wrote.
#if REAL_IS_DOUBLE
#define Real double
#else
#define Real float
#endif

layout(local_size_x = 64) in;

layout(push_constant) uniform Push { uint count; };
layout(binding = 0) readonly buffer In { Real values_in[]; };
layout(binding = 1) writeonly buffer Out { Real values_out[]; };
layout(binding = 3) uniform Weights { vec4 weights; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < count) {
    values_out[i] = Real(weights.x) * values_in[(i + count - 1) % count] + Real(weights.y) * values_in[(i + 1) % count];
  }
}
