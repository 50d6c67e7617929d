// SPDX-License-Identifier: MIT
// Leaf functions of hand.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "hand.glsl"
#include "probe.glsl"

FingerFrame given_frame(int k) { return FingerFrame(given3(k), given3(k + 3), given3(k + 6)); }

void answer_points(FingerPoints points) {
  answer3(0, points.pip);
  answer3(3, points.dip);
  answer3(6, points.tip);
}

void main() {
  load_hand();
  if (row() >= push.count) return;
  if (PROBE == PROBE_TRAJECTORY) {
    answer3(0, thumb_angles(given(0)));
    answer3(3, finger_angles(given(0)));
  }
  if (PROBE == PROBE_FINGER_POINTS) answer_points(finger_points(given_frame(0), given3(9), given3(12), given3(15)));
  if (PROBE == PROBE_THUMB_POINTS) answer_points(thumb_points(given_frame(0), given3(9), given3(12)));
  if (PROBE == PROBE_SEGMENT_END) answer3(0, segment_end(given_frame(0), given3(9), given(12), given(13)));
  if (PROBE == PROBE_TIP_TO_TIP) {
    Vec3 slope;
    Vec3 way = tip_to_tip(given(0), slope);
    answer3(0, way);
    answer3(3, slope);
    answer(6, length(way));
  }
  if (PROBE == PROBE_CLOSURE_OF_GAP) answer(0, closure_of_gap(given(0), STOP_TOLERANCE));
}
