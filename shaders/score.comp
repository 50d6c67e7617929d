// SPDX-License-Identifier: MIT
// Scores, one grip per invocation, from the planes of the earlier kernels. With push.flag, before efforts are known: an upper bound of the score for
// any effort.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "grips.glsl"
#include "score.glsl"

void main() {
  uint grip = INVOCATION;
  if (grip >= push.count) return;
  uint status = status_of(grip);
  Real terms[6] = Real[](Real(0), Real(0), Real(0), Real(0), Real(0), Real(0));
  Real score = Real(0);
  if (is_feasible(status)) {
    terms[0] = fingers_term(bitCount(uint_out[uint(PLANE_USED_MASK) * push.stride + grip]));
    terms[1] = contacts_term(bitCount(uint_out[uint(PLANE_TOUCH_MASK) * push.stride + grip]));
    terms[2] = depth_term(real_out[uint(PLANE_PHALANX_DEPTH) * push.stride + grip], real_out[uint(PLANE_PALM_DEPTH) * push.stride + grip]);
    terms[3] = posture_term(real_out[uint(PLANE_CLOSURE) * push.stride + grip]);
    if (PLANE_WRIST_SHARE >= 0) terms[3] = wrist_term(terms[3], real_out[uint(PLANE_WRIST_SHARE) * push.stride + grip]);
    if (PLANE_PEAK_FORCE >= 0) {
      Real largest_feedback = Real(0), largest_hold = Real(0);
      for (uint fill = 0u; fill < scene.fills; ++fill) {
        largest_feedback = max(largest_feedback, real_out[(uint(PLANE_PEAK_FORCE) + fill) * push.stride + grip]);
        if (PLANE_WORST_EFFORT < 0) largest_hold = max(largest_hold, real_out[(uint(PLANE_LARGEST_HOLD) + fill) * push.stride + grip]);
      }
      terms[4] = force_term(largest_feedback, scene.force_max);
      terms[5] = hold_term(largest_hold, scene.grip_strength);
      // that of an implausible grip is 0
      if (PLANE_WORST_EFFORT >= 0) {
        Real worst = push.flag != 0u ? Real(0) : real_out[uint(PLANE_WORST_EFFORT) * push.stride + grip];
        terms[5] = is_judged(status) ? effort_term(worst) : Real(0);
        if (is_judged(status) && !effort_holds(worst)) status |= STATUS_NOT_HELD;
        put_uint(PLANE_STATUS, grip, status);
      }
    }
    precise Real sum = scene.weight_fingers * terms[0];
    sum += scene.weight_contacts * terms[1];
    sum += scene.weight_depth * terms[2];
    sum += scene.weight_posture * terms[3];
    sum += scene.weight_force * terms[4];
    sum += scene.weight_hold * terms[5];
    score = is_eligible(status) ? sum : Real(0);
  }
  put_real(PLANE_SCORE, 0, grip, score);
  if (PLANE_TERMS >= 0)
    for (int k = 0; k < 6; ++k) put_real(PLANE_TERMS, k, grip, terms[k]);
}
