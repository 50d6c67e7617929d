// SPDX-License-Identifier: MIT
// What the lip holds back, once per vessel: one invocation per tilt, first the whole degrees 0..180, then the scene's tilts.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "liquid.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(std430, binding = BINDING_TILTS) readonly buffer TiltBlock { Real tilts_in[]; };
layout(std430, binding = BINDING_CAPACITY) writeonly buffer CapacityBlock { Real capacity_out[]; };

void main() {
  uint i = INVOCATION;
  if (i >= push.count) return;
  Real s, c;
  if (i < WHOLE_DEGREES) {
    sine_cosine(Real(i) * (HALF_PI / Real(90)), s, c);
  } else {
    uint tilt = i - WHOLE_DEGREES;
    s = tilts_in[3u * tilt];
    c = tilts_in[3u * tilt + 1u];
  }
  capacity_out[i] = lip_capacity(s, c);
}
