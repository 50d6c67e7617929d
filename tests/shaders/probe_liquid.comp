// SPDX-License-Identifier: MIT
// Leaf functions of liquid.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "liquid.glsl"
#include "probe.glsl"

Element given_element() {
  return make_element(Vec2(given(0), given(1)), Vec2(given(2), given(3)), Vec2(given(4), given(5)), given(6), given(7));
}

void answer_slices(Slices slices) {
  answer(0, slices.volume);
  answer(1, slices.lean);
  answer(2, slices.height);
  answer(3, slices.surface);
}

void main() {
  if (row() >= push.count) return;
  if (PROBE == PROBE_SEGMENT_AREA) answer(0, segment_area(given(0), given(1)));
  if (PROBE == PROBE_SEGMENT_MOMENT) answer(0, segment_moment(given(0), given(1)));
  if (PROBE == PROBE_ELEMENT_RADIUS) answer(0, element_radius(given_element(), given(8)));
  if (PROBE == PROBE_PLANE_CROSSINGS) {
    Vec2 heights = plane_crossings(given_element(), given(8), given(9), given(10), given(11));
    answer(0, heights.x);
    answer(1, heights.y);
  }
  if (PROBE == PROBE_PIECE_BELOW) answer_slices(piece_below(given_element(), given(8), given(9), given(10)));
  if (PROBE == PROBE_INTEGRATE_SLICES)
    answer_slices(integrate_slices(given_element(), given(8), given(9), given(10), given(11), given(12)));
  if (PROBE == PROBE_LIQUID_BELOW) answer_slices(liquid_below(given(0), given(1), given(2)));
  if (PROBE == PROBE_LIP_CAPACITY) {
    answer(0, lip_level(given(0), given(1)));
    answer(1, bottom_level(given(0), given(1)));
    answer(2, lip_capacity(given(0), given(1)));
  }
  if (PROBE == PROBE_LIQUID_AT) {
    LiquidState liquid = liquid_at(given(0), given(1), given(2));
    answer(0, liquid.volume);
    answer(1, liquid.lean);
    answer(2, liquid.height);
  }
}
