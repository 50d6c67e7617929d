// SPDX-License-Identifier: MIT
// The hand as the kernels read it (layout.h's HAND_* offsets). Uniform, so that constant places cost a broadcast.
#ifndef HAND_TABLE_GLSL
#define HAND_TABLE_GLSL

#include "real.glsl"

struct FingerFrame {
  Vec3 base;
  Vec3 forward;
  Vec3 palmward;
};

layout(constant_id = CONST_GAP_TABLE_SIZE) const int GAP_ENTRIES = GAP_TABLE_SIZE;
layout(std140, binding = BINDING_HAND) uniform HandBlock { Vec4 hand_table[HAND_VECTORS]; };

FingerFrame hand_frame(int finger) {
  int at = HAND_FINGER_STRIDE * finger;
  return FingerFrame(hand_table[at].xyz, hand_table[at + 1].xyz, hand_table[at + 2].xyz);
}

// L0, L1, L2, L3 and the radii from the metacarpal base to the tip, at scale 1.
Real hand_length(int finger, int segment) {
  int at = HAND_FINGER_STRIDE * finger;
  return segment < 3 ? hand_table[at + segment].w : hand_table[at + 4].y;
}

Real hand_radius(int finger, int point) {
  int at = HAND_FINGER_STRIDE * finger + 3;
  return point < 4 ? hand_table[at][point] : hand_table[at + 1].x;
}

Real gap_table(int entry) { return hand_table[HAND_TABLE + (entry >> 2)][entry & 3]; }

#define HAND_SCALE hand_table[HAND_JOINT_LIMIT].w
#define HAND_CONTACT_TOLERANCE hand_table[HAND_FINGER_OPEN].w
#define HAND_DEPTH_LIMIT hand_table[HAND_FINGER_SWING].w
#define HAND_MAX_ANGLE hand_table[HAND_THUMB_OPEN].w
#define HAND_PAPER_MAX_ANGLE hand_table[HAND_THUMB_SWING].w
#define HAND_GAP_OPEN hand_table[HAND_GAP].x
#define HAND_GAP_CLOSED hand_table[HAND_GAP].y

#endif
