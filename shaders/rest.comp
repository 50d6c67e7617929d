// SPDX-License-Identifier: MIT
// Kernel 5, one feasible grip per invocation: brings middle, ring and little finger to rest on the vessel.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "contact.glsl"
#include "placed.glsl"
#include "projection.glsl"

void put_finger(int first_joint, FingerPoints points) {
  put_point(PLANE_POSED, first_joint + 2, grip, points.pip);
  put_point(PLANE_POSED, first_joint + 3, grip, points.dip);
  put_point(PLANE_POSED, first_joint + 4, grip, points.tip);
}

// A bit for each of the last three points that touched before it moved.
int touched_before(Vec3 separations) {
  return (separations.x <= HAND_CONTACT_TOLERANCE ? 1 : 0) | (separations.y <= HAND_CONTACT_TOLERANCE ? 2 : 0) |
         (separations.z <= HAND_CONTACT_TOLERANCE ? 4 : 0);
}

int pose_articulated(int f, int first_joint, Mat3 rotation, Real closure) {
  FingerFrame frame = FingerFrame(Vec3(0), rotation * finger_vector(f, 1).xyz, rotation * finger_vector(f, 2).xyz);
  Vec3 lengths = scale * hand_lengths(f, 1);
  Vec4 radii = scale * Vec4(hand_radius(f, 1), hand_radius(f, 2), hand_radius(f, 3), hand_radius(f, 4));
  RestingFinger resting = rest_finger(Finger(frame, posed_point(first_joint + 1, grip), lengths, radii), closure);
  put_finger(first_joint, resting.points);
  if (resting.blocked) status |= 1u << (STATUS_BLOCKED_SHIFT + f);
  if (resting.undecided) status |= STATUS_CONTACT_UNDECIDED;
  if (resting.unsettled) status |= 1u << (STATUS_UNSETTLED_SHIFT + f);
  return touched_before(resting.before);
}

int pose_paper(int f, int first_joint, PaperAxis axis) {
  int before = 0;
  Vec3 mcp = posed_point(first_joint + 1, grip);
  [[dont_unroll]] for (int k = 2; k < 5; ++k) {
    Vec3 p = posed_point(first_joint + k, grip);
    Real radius = scale * hand_radius(f, k);
    bool unsettled = false;
    if (separation_at(p, radius) <= HAND_CONTACT_TOLERANCE) {
      before |= 1 << (k - 2);
    } else {
      put_point(PLANE_POSED, first_joint + k, grip, project_point(p, radius, mcp, axis, HAND_PAPER_MAX_ANGLE, unsettled));
    }
    if (unsettled) status |= 1u << (STATUS_UNSETTLED_SHIFT + f);
  }
  return before;
}

void rest_hand() {
  status = status_of(grip);
  scale = grip_scale(grip);
  Mat3 rotation = Mat3(kept_vector(PLACED, grip), kept_vector(PLACED + 3, grip), kept_vector(PLACED + 6, grip));
  Real closure = kept(PLANE_CLOSURE, 0, grip);
  PaperAxis axis;
  if (POSE == POSE_PAPER) {
    int index = first_joint_of(1);
    axis = paper_axis(posed_point(index + 1, grip), posed_point(first_joint_of(4) + 1, grip), posed_point(INDEX_TIP, grip),
                      posed_point(THUMB_TIP, grip));
  }
  int before = 0;
  [[dont_unroll]] for (int f = 2; f < FINGERS; ++f) {
    int first_joint = first_joint_of(f);
    int touched = POSE == POSE_PAPER ? pose_paper(f, first_joint, axis) : pose_articulated(f, first_joint, rotation, closure);
    before |= touched << (3 * (f - 2));
  }
  put_real(PLACED, PLACED_BEFORE, grip, Real(before));
  if (FEW_STEPS && (status >> STATUS_UNSETTLED_SHIFT & 0x1Fu) != 0u) status |= STATUS_OUT_OF_TURNS;
  put_uint(PLANE_STATUS, grip, status);
}

void main() {
  bool has_grip = take_feasible_grip(grip);
  load_hand();
  load_outline();
  if (has_grip) rest_hand();
}
