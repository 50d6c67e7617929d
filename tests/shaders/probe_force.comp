// SPDX-License-Identifier: MIT
// Leaf functions of force.glsl and score.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "force.glsl"
#include "score.glsl"
#include "probe.glsl"

void main() {
  if (row() >= push.count) return;
  if (PROBE == PROBE_DIRECTIONS) {
    Vec3 pour = pour_direction(given3(0), given(3));
    answer3(0, pour);
    answer3(3, up_direction(pour, given(4), given(5)));
  }
  if (PROBE == PROBE_LOAD_CENTER) answer3(0, load_center(Load(Real(1), given3(0), given(3), given(4)), given3(5)));
  if (PROBE == PROBE_REFERENCE) answer(0, grip_reference(given(0), given(1), given(2)));
  if (PROBE == PROBE_FORCES) {
    Real normal = normal_force(given(0), given(1), given(2), given(3));
    answer(0, normal);
    answer(1, feedback_force(normal, given(4), given(5)));
  }
  if (PROBE == PROBE_STRENGTH_AT) answer(0, strength_at(given(0)));
  if (PROBE == PROBE_SCORE) {
    answer(0, fingers_term(given_int(0)));
    answer(1, contacts_term(given_int(1)));
    answer(2, depth_term(given(2), given(3)));
    answer(3, posture_term(given(4)));
    answer(4, force_term(given(5), given(6)));
    answer(5, hold_term(given(7), given(8)));
    answer(6, wrist_term(posture_term(given(4)), given(9)));
  }
}
