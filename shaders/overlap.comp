// SPDX-License-Identifier: MIT
// Kernels 8 and 11, one feasible grip per invocation: whether the hand reaches into itself, and whether an arm reaches it.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "body.glsl"
#include "placed.glsl"
#include "wrist.glsl"

// As core/joints.h has them.
int phalanx_digit(int phalanx) { return (phalanx + 1) / 3; }
int phalanx_start(int phalanx) { return phalanx + 1 + 2 * phalanx_digit(phalanx); }

Ball read_ball(int joint) {
  int finger = joint < 4 ? 0 : (joint + 1) / 5;
  return Ball(posed_point(joint, grip), scale * hand_radius(finger, joint - first_joint_of(finger)));
}

#if SMALL
void load_chain() {}
Ball chain(int joint) { return read_ball(joint); }
Ball around(int phalanx) { return around_bone(chain(phalanx_start(phalanx)), chain(phalanx_start(phalanx) + 1)); }
#else
Ball chain_copy[JOINTS], around_copy[PHALANGES];
void load_chain() {
  UNROLL for (int j = 0; j < JOINTS; ++j) chain_copy[j] = read_ball(j);
  UNROLL for (int k = 0; k < PHALANGES; ++k) around_copy[k] = around_bone(chain_copy[phalanx_start(k)], chain_copy[phalanx_start(k) + 1]);
}
Ball chain(int joint) { return chain_copy[joint]; }
Ball around(int phalanx) { return around_copy[phalanx]; }
#endif

// As in core/grip.cpp. Constant places are read once for all lanes, others lane by lane, so a first pass finds which of the other bones are near, and
// only these are evaluated.
Real digits_overlap() {
  load_chain();
  Real deepest = -NO_DISTANCE;
  UNROLL for (int bone = 2; bone + 3 < PHALANGES; ++bone) {
    Ball mine = chain(phalanx_start(bone) + 1), beside = chain(phalanx_start(bone + 3) + 1);
    deepest = max(deepest, mine.radius + beside.radius - length(mine.place - beside.place));
  }
  [[dont_unroll]] for (int bone = 0; bone + 3 < PHALANGES; ++bone) {
    Ball mine = around(bone), start = chain(phalanx_start(bone)), end = chain(phalanx_start(bone) + 1);
    uint near = 0u;
    UNROLL for (int other = 2; other < PHALANGES; ++other) near |= overlap_more(mine, around(other), deepest) ? 1u << other : 0u;
    near &= ~0u << (3 * phalanx_digit(bone) + 2);
    [[dont_unroll]] while (near != 0u) {
      int other = findLSB(near);
      near &= near - 1u;
      Ball other_start = chain(phalanx_start(other)), other_end = chain(phalanx_start(other) + 1);
      deepest = bones_overlap(start.place, end.place, Vec2(start.radius, end.radius), other_start.place, other_end.place,
                              Vec2(other_start.radius, other_end.radius), deepest);
    }
  }
  return deepest;
}

void judge_hand() {
  status = status_of(grip);
  scale = grip_scale(grip);
  if (BETWEEN > 0) {
    Real self_depth = digits_overlap();
    put_real(PLANE_SELF_DEPTH, 0, grip, self_depth);
    if (self_depth > HAND_DEPTH_LIMIT) status = (status | STATUS_SELF_OVERLAP) & ~STATUS_PLAUSIBLE;
  }
  if (HOLDER_AZIMUTHS > 0) {
    Mat3 rotation = Mat3(kept_vector(PLACED, grip), kept_vector(PLACED + 3, grip), kept_vector(PLACED + 6, grip));
    Placement placement = Placement(rotation, kept_vector(PLACED + PLACED_TRANSLATION, grip), scale);
    Real wrist_share = find_wrist(placement, grip_axis(AXIS_AZIMUTH, grip)).share;
    put_real(PLANE_WRIST_SHARE, 0, grip, wrist_share);
    if (wrist_share > Real(1)) status = (status | STATUS_BEYOND_WRIST) & ~STATUS_PLAUSIBLE;
  }
  put_uint(PLANE_STATUS, grip, status);
}

void main() {
  bool has_grip = take_feasible_grip(grip);
  load_hand();
  if (has_grip) judge_hand();
}
