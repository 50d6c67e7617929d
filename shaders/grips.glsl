// SPDX-License-Identifier: MIT
// Grips as the kernels read them, axis by axis.
#ifndef GRIPS_GLSL
#define GRIPS_GLSL

#include "real.glsl"

layout(std430, binding = BINDING_GRIPS) readonly buffer GripBlock { Real grips_in[]; };

Real grip_axis(int axis, uint grip) { return grips_in[uint(axis) * push.stride + grip]; }

#endif
