// SPDX-License-Identifier: MIT
// Leaf functions of gauge.glsl: what a contact can do along a direction.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "gauge.glsl"
#include "probe.glsl"

void main() {
  if (row() >= push.count) return;
  if (PROBE == PROBE_PRESS) {
    Six direction = Six(given3(8), given3(11));
    answer(0, press(given3(0), given3(3), given(6), given(7), direction));
    Six wrench = pressed(given3(0), given3(3), given(6), given(7), direction);
    answer3(1, wrench.first);
    answer3(4, wrench.second);
  }
}
