// SPDX-License-Identifier: MIT
// The hand as kernels read it (layout.h's HAND_* offsets).
#ifndef HAND_TABLE_GLSL
#define HAND_TABLE_GLSL

#include "build.glsl"
#include "real.glsl"

struct FingerFrame {
  Vec3 base, forward, palmward;
};

layout(constant_id = CONST_GAP_TABLE_SIZE) const int GAP_ENTRIES = GAP_TABLE_SIZE;
layout(std140, binding = BINDING_HAND) uniform HandBlock { Vec4 hand_table[HAND_VECTORS]; };

#if SMALL

#define hand_vectors hand_table
void load_hand() {}
Vec4 finger_vector(int finger, int place) { return hand_table[HAND_FINGER_STRIDE * finger + place]; }

#else

// All of it except the table of gaps. `main` loads it outside of loops and branches, before any lane may have returned: only there does lavapipe read
// a constant place once for all lanes; elsewhere it gathers lane by lane.
Vec4 hand_vectors[HAND_TABLE];

void load_hand() {
  [[unroll]] for (int i = 0; i < HAND_TABLE; ++i) hand_vectors[i] = hand_table[i];
}

// Vector `place` of a finger, by selection: a variable index would put the vectors in memory.
Vec4 finger_vector(int finger, int place) {
  Vec4 vector = hand_vectors[place];
  [[unroll]] for (int f = 1; f < FINGERS; ++f) vector = finger == f ? hand_vectors[HAND_FINGER_STRIDE * f + place] : vector;
  return vector;
}

#endif

FingerFrame hand_frame(int finger) {
  return FingerFrame(finger_vector(finger, 0).xyz, finger_vector(finger, 1).xyz, finger_vector(finger, 2).xyz);
}

// L0, L1, L2, L3 and the radii from the metacarpal base to the tip, at scale 1.
Real hand_length(int finger, int segment) {
  return segment == 0   ? finger_vector(finger, 0).w
         : segment == 1 ? finger_vector(finger, 1).w
         : segment == 2 ? finger_vector(finger, 2).w
                        : finger_vector(finger, 4).y;
}

Vec3 hand_lengths(int finger, int first) {
  return Vec3(hand_length(finger, first), hand_length(finger, first + 1), hand_length(finger, first + 2));
}

Real hand_radius(int finger, int point) {
  Vec4 first = finger_vector(finger, 3);
  return point == 0 ? first.x : point == 1 ? first.y : point == 2 ? first.z : point == 3 ? first.w : finger_vector(finger, 4).x;
}

Real gap_table(int entry) { return hand_table[HAND_TABLE + (entry >> 2)][entry & 3]; }

#define HAND_SCALE hand_vectors[HAND_JOINT_LIMIT].w
#define HAND_CONTACT_TOLERANCE hand_vectors[HAND_FINGER_OPEN].w
#define HAND_DEPTH_LIMIT hand_vectors[HAND_FINGER_SWING].w
#define HAND_MAX_ANGLE hand_vectors[HAND_THUMB_OPEN].w
#define HAND_PAPER_MAX_ANGLE hand_vectors[HAND_THUMB_SWING].w
#define HAND_GAP_OPEN hand_vectors[HAND_GAP].x
#define HAND_GAP_CLOSED hand_vectors[HAND_GAP].y

#endif
