// SPDX-License-Identifier: MIT
// Leaf functions of projection.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "projection.glsl"
#include "probe.glsl"

FingerFrame given_frame(int k) { return FingerFrame(given3(k), given3(k + 3), given3(k + 6)); }

Finger given_finger() { return Finger(given_frame(0), given3(9), given3(12), Vec4(given(15), given(16), given(17), given(18))); }

Place given_place() {
  Finger finger = given_finger();
  return watched_place(finger, bend_finger(finger.lengths, chain_sums(given3(19))), given3(22), given_int(25));
}

void main() {
  load_hand();
  if (row() >= push.count) return;
  load_outline();
  if (PROBE == PROBE_CHAIN_SUMS) answer3(0, chain_sums(given3(0)));
  if (PROBE == PROBE_WATCHED_PLACE) {
    Place place = given_place();
    answer3(0, place.ball.place);
    answer(3, place.ball.radius);
    answer(4, place.velocity.x);
    answer(5, place.velocity.y);
    answer(6, place.acceleration.x);
    answer(7, place.acceleration.y);
    answer(8, place.speed);
    answer(9, place.bend);
    answer(10, place.jerk);
  }
  if (PROBE == PROBE_NEAREST_POINT) answer(0, Real(nearest_point(given3(0), given_int(3))));
  if (PROBE == PROBE_PLACE_STEP) {
    Place place = given_place();
    Support support = support_at(place.ball.place);
    answer(0, place_step(support, support.distance - place.ball.radius, place, given_frame(0)));
  }
  if (PROBE == PROBE_FINGER_MOTION) {
    RestingFinger resting = rest_finger(given_finger(), given(19));
    answer3(0, resting.angles);
    answer(3, Real(resting.blocked));
    answer(4, Real(resting.unsettled));
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
    FingerMotion motion = FingerMotion(given3(0), given3(3), given_int(6), given(7), given(8), given_int(9), given_int(10) != 0,
                                       given_int(11) != 0);
    motion = turn_joint(motion, given_int(12));
    answer3(0, motion.origin);
    answer3(3, motion.rates);
    answer(6, Real(motion.joint));
    answer(7, motion.at);
    answer(8, motion.end);
    answer(9, Real(motion.steps));
    answer(10, Real(motion.blocked));
    answer(11, Real(motion.unsettled));
  }
}
