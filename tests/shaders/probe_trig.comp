// SPDX-License-Identifier: MIT
// Leaf functions of trig.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "trig.glsl"
#include "probe.glsl"

void main() {
  if (row() >= push.count) return;
  if (PROBE == PROBE_SINE_COSINE) {
    Real s, c;
    sine_cosine(given(0), s, c);
    answer(0, s);
    answer(1, c);
  }
  if (PROBE == PROBE_ARC_COSINE) answer(0, arc_cosine(given(0)));
  if (PROBE == PROBE_ANGLE_BETWEEN) answer(0, angle_between(given3(0), given3(3)));
  if (PROBE == PROBE_DIRECTION_ANGLE) answer(0, direction_angle(given(0), given(1)));
}
