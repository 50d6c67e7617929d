// SPDX-License-Identifier: MIT
// Leaf functions of closure.glsl and wrist.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "closure.glsl"
#include "wrist.glsl"
#include "probe.glsl"

Placement given_placement() {
  Real e1_x;
  return place_hand(given(0), grip_direction(given(1), given(2)), given(3), given3(4), given(7), e1_x);
}

void main() {
  load_hand();
  if (row() >= push.count) return;
  load_outline();
  if (PROBE == PROBE_TRACE_TIP) {
    Trace trace = trace_tip(given3(0), grip_direction(given(3), given(4)), given(5), given(6));
    answer(0, trace.t);
    answer(1, Real(trace.reason));
    answer3(2, trace.normal);
    answer(5, Real(trace.element));
  }
  if (PROBE == PROBE_PLACE_HAND) {
    Real e1_x;
    Placement placement = place_hand(given(0), grip_direction(given(1), given(2)), given(3), given3(4), given(7), e1_x);
    for (int k = 0; k < 3; ++k) answer3(3 * k, placement.rotation[k]);
    answer3(9, placement.translation);
    answer(12, e1_x);
    FingerFrame index = placed_frame(placement, hand_frame(1));
    answer3(13, index.base);
    answer3(16, index.forward);
    answer3(19, index.palmward);
  }
  if (PROBE == PROBE_CLOSE_FINGERS) {
    Closing closing = close_fingers(Grip(given(0), given(1), given(2), given(3), given(4), given(5)));
    bool reached = closing.reason == REASON_NONE || closing.reason >= REASON_TOO_WIDE;
    bool closed = closing.reason == REASON_NONE;
    answer(0, Real(closing.reason));
    answer3(1, closing.direction);
    answer(4, reached ? closing.t_index : Real(0));
    answer(5, reached ? closing.t_thumb : Real(0));
    answer(6, reached ? closing.gap : Real(0));
    answer3(7, reached ? closing.midpoint : Vec3(0));
    answer(10, closed ? closing.closure : Real(0));
    answer(11, closed ? closing.thumb_angle : Real(0));
    answer(12, closed ? closing.index_angle : Real(0));
    answer(13, closed ? Real(closing.grazing) : Real(0));
    for (int k = 0; k < 3; ++k) answer3(14 + 3 * k, closed ? closing.placement.rotation[k] : Vec3(0));
    answer3(23, closed ? closing.placement.translation : Vec3(0));
    answer(26, closed ? closing.placement.scale : Real(0));
  }
  if (PROBE == PROBE_REACH_WRIST) {
    ArmReach reach = reach_wrist(given3(0), given3(3), given3(6));
    answer3(0, reach.along);
    answer3(3, reach.low);
    answer3(6, reach.aside);
    answer(9, reach.straight);
    answer(10, reach.bent);
  }
  if (PROBE == PROBE_EASE_WRIST) {
    Placement placement = given_placement();
    Real s, c;
    sine_cosine(given(11), s, c);
    ArmReach reach = reach_wrist(placement.translation, given3(8), Vec3(c, Real(0), s));
    Wrist best = Wrist(Real(0), Real(0), Real(0), NO_DISTANCE);
    ease_wrist(placement.rotation, placement.translation, reach, given(12), best);
    answer(0, best.flexion);
    answer(1, best.deviation);
    answer(2, best.pronation);
    answer(3, best.share);
  }
  if (PROBE == PROBE_FIND_WRIST) answer(0, find_wrist(given_placement(), given(1)).share);
}
