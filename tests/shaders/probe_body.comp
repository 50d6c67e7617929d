// SPDX-License-Identifier: MIT
// Leaf functions of body.glsl and table.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "body.glsl"
#include "table.glsl"
#include "probe.glsl"

Vec2 given2(int k) { return Vec2(given(k), given(k + 1)); }

Ball given_ball(int k) { return Ball(given3(k), given(k + 3)); }

void main() {
  load_hand();
  if (row() >= push.count) return;
  if (PROBE == PROBE_BALL_BETWEEN) {
    Ball ball = ball_between(given3(0), given3(3), given(6), given(7), given(8));
    answer3(0, ball.place);
    answer(3, ball.radius);
  }
  if (PROBE == PROBE_AROUND_BONE) {
    Ball ball = around_bone(given_ball(0), given_ball(4));
    answer3(0, ball.place);
    answer(3, ball.radius);
  }
  if (PROBE == PROBE_OVERLAP_MORE) answer(0, overlap_more(given_ball(0), given_ball(4), given(8)) ? Real(1) : Real(0));
  if (PROBE == PROBE_NEAREST_SHARE) answer(0, nearest_share(given(0)));
  if (PROBE == PROBE_BONES_OVERLAP)
    answer(0, bones_overlap(given3(0), given3(3), given2(6), given3(8), given3(11), given2(14), given(16)));
  if (PROBE == PROBE_DEPTH_IN_TABLE) answer(0, depth_in_table(given3(0), given(3)));
  if (PROBE == PROBE_FINGER_IN_TABLE)
    answer(0, finger_in_table(FingerPoints(given3(0), given3(3), given3(6)), given3(9)));
}
