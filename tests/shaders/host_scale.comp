// SPDX-License-Identifier: MIT
#version 450
// out[i] = FACTOR * in[i] + OFFSET, out[stride + i] = index of the item, in the first `count` invocations.
#if REAL_IS_DOUBLE
#define Real double
#else
#define Real float
#endif

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const Real FACTOR = 1;
layout(constant_id = 2) const int OFFSET = 0;
layout(constant_id = 3) const bool NEGATE = false;

layout(push_constant) uniform Push { uint count, stride, first; };
layout(binding = 0) readonly buffer In { Real values_in[]; };
layout(binding = 1) writeonly buffer Out { Real values_out[]; };
layout(binding = 5) buffer Unused { Real unused[]; };

void main() {
  const uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= count) {
    return;
  }
  const Real value = FACTOR * values_in[i] + Real(OFFSET);
  values_out[i] = NEGATE ? -value : value;
  values_out[stride + i] = Real(first + i);
}
