// SPDX-License-Identifier: MIT
// Leaf functions of projection.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "projection.glsl"
#include "probe.glsl"

FingerFrame given_frame(int k) { return FingerFrame(given3(k), given3(k + 3), given3(k + 6)); }

void main() {
  if (row() >= push.count) return;
  load_outline();
  if (PROBE == PROBE_SEGMENT_RATES) answer3(0, segment_rates(given3(0), given_int(3)));
  if (PROBE == PROBE_QUARTER_TURN) answer3(0, quarter_turn(given_frame(0), given3(9)));
  if (PROBE == PROBE_NEAREST_POINT) answer(0, Real(nearest_point(given3(0), given_int(3))));
  if (PROBE == PROBE_FINGER_STEP) {
    FingerPoints points = finger_points(given_frame(0), given3(9), given3(12), given3(15));
    Watch watch = watch_points(points, given3(18));
    answer(0, finger_step(given_frame(0), given3(9), points, watch, given3(12), given3(21)));
  }
  if (PROBE == PROBE_FINGER_MOTION) {
    FingerMotion motion = start_motion(given(18));
    while (motion.joint < 3) {
      FingerPoints points = finger_points(given_frame(0), given3(9), given3(12), motion.angles);
      motion = advance_finger(motion, given_frame(0), given3(9), points, watch_points(points, given3(15)), given3(12));
    }
    answer3(0, motion.angles);
    answer(3, Real(motion.blocked));
    answer(4, Real(motion.unsettled));
  }
  if (PROBE == PROBE_PAPER_AXIS) {
    PaperAxis axis = paper_axis(given3(0), given3(3), given3(6), given3(9));
    answer3(0, axis.direction);
    answer(3, Real(axis.exists));
  }
  if (PROBE == PROBE_TURNED_POINT) answer3(0, turned_point(given3(0), given3(3), given3(6), given(9)));
  if (PROBE == PROBE_PROJECT_POINT) {
    bool unsettled;
    answer3(0, project_point(given3(0), given(3), given3(4), PaperAxis(given3(7), true), given(10), unsettled));
    answer(3, Real(unsettled));
  }
  if (PROBE == PROBE_PROJECTION_ROLE) answer(0, Real(projection_role(given_int(0), given_int(1))));
  if (PROBE == PROBE_TURN_JOINT) {
    FingerMotion motion = FingerMotion(given3(0), given(3), given(4), given_int(5), given(6), given(7), given(8), given_int(9),
                                       given3(10), given_int(13) != 0, given_int(14) != 0);
    motion = turn_joint(motion, given_int(15));
    answer3(0, motion.angles);
    answer(3, motion.closure);
    answer(4, motion.limit);
    answer(5, Real(motion.joint));
    answer(6, motion.start);
    answer(7, motion.turned);
    answer(8, motion.room);
    answer(9, Real(motion.steps));
    answer3(10, motion.before);
    answer(13, Real(motion.blocked));
    answer(14, Real(motion.unsettled));
  }
}
