// SPDX-License-Identifier: MIT
// Data passed between the kernels of a grip, in planes that nobody may have requested.
#ifndef PLACED_GLSL
#define PLACED_GLSL

#include "grips.glsl"
#include "hand_table.glsl"

layout(constant_id = CONST_PLACED) const int PLACED = -1;
layout(constant_id = CONST_POSE) const int POSE = POSE_ARTICULATED;

// This invocation's feasible grip, its status and the scale of its hand.
uint grip, status;
Real scale;

int first_joint_of(int finger) { return finger == 0 ? 0 : 5 * finger - 1; }
int points_of(int finger) { return finger == 0 ? 4 : 5; }

Vec3 posed_point(int joint, uint grip) { return kept_vector(PLANE_POSED + 3 * joint, grip); }

Real grip_scale(uint grip) { return HAND_SCALE * grip_axis(AXIS_HAND_SCALE, grip); }

#endif
