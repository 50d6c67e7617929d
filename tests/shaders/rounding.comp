// SPDX-License-Identifier: MIT
// The program's kernel of this name, as a driver would compile it that contracts a product and a sum in spite of `precise`: nothing is lost between
// them.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "real.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(std430, binding = BINDING_REAL_OUT) buffer RealBlock { Real real_out[]; };

// (1 + d) (1 + e) - 1 = d + e + d e
void main() {
  if (INVOCATION > 0u) return;
  Real d = real_out[0] - Real(1), e = real_out[1] - Real(1);
  real_out[3] = (d + e + (real_out[2] + Real(1))) + d * e;
}
