// SPDX-License-Identifier: MIT
// Kernels 1 and 3, and the open hand of 8, one grip per invocation: where thumb and index finger close on the vessel, or why they do not, and the
// whole hand as it closes.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "closure.glsl"
#include "placed.glsl"
#include "table.glsl"

void put_closing(uint grip, Closing closing, bool is_feasible) {
  bool reached = is_feasible || closing.reason >= REASON_TOO_WIDE;
  put_real(PLANE_T_INDEX, 0, grip, reached ? closing.t_index : NOT_A_NUMBER);
  put_real(PLANE_T_THUMB, 0, grip, reached ? closing.t_thumb : NOT_A_NUMBER);
  put_real(PLANE_GAP, 0, grip, reached ? closing.gap : NOT_A_NUMBER);
  if (PLANE_MIDPOINT >= 0) put_point(PLANE_MIDPOINT, 0, grip, reached ? closing.midpoint : Vec3(NOT_A_NUMBER));
  put_real(PLANE_CLOSURE, 0, grip, is_feasible ? closing.closure : NOT_A_NUMBER);
  put_real(PLANE_CONTACT_ANGLES, 0, grip, is_feasible ? closing.thumb_angle : NOT_A_NUMBER);
  put_real(PLANE_CONTACT_ANGLES, 1, grip, is_feasible ? closing.index_angle : NOT_A_NUMBER);
}

// What later kernels find; for an infeasible grip they find nothing.
void put_rest(uint grip, bool is_feasible) {
  Real none = is_feasible ? Real(0) : NOT_A_NUMBER;
  put_uint(PLANE_TOUCH_MASK, grip, 0u);
  put_uint(PLANE_TIP_MASK, grip, 0u);
  put_uint(PLANE_FINGER_MASK, grip, 0u);
  put_uint(PLANE_INNER_MASK, grip, 0u);
  put_uint(PLANE_USED_MASK, grip, 0u);
  put_real(PLANE_PHALANX_DEPTH, 0, grip, none);
  put_real(PLANE_PALM_DEPTH, 0, grip, none);
  put_real(PLANE_BONE_STRETCH, 0, grip, none);
  put_real(PLANE_SELF_DEPTH, 0, grip, none);
  put_real(PLANE_WRIST_SHARE, 0, grip, none);
  if (PLANE_PROXIES < 0 && PLANE_SEPARATION < 0) return;
  [[dont_unroll]] for (int j = 0; j < JOINTS; ++j) {
    if (PLANE_PROXIES >= 0) put_point(PLANE_PROXIES, j, grip, Vec3(none));
    put_real(PLANE_SEPARATION, j, grip, none);
  }
}

void put_joint(int joint, uint grip, Vec3 p, bool is_feasible) {
  p = is_feasible ? p : Vec3(NOT_A_NUMBER);
  put_point(PLANE_POSED, joint, grip, p);
  if (PLANE_JOINTS >= 0) put_point(PLANE_JOINTS, joint, grip, p);
}

// The points of a finger from base to tip, and how deep the open finger, from which it closes, reaches into the table: its base, and an MCP other
// than the thumb's, are the same. One loop for both postures, thumb and fingers alike, so that the sines are compiled once.
Real put_finger(int f, uint grip, Placement placement, Real closure, bool is_feasible) {
  Real scale = placement.scale;
  FingerFrame frame = placed_frame(placement, hand_frame(f));
  bool is_thumb = f == 0;
  int first = is_thumb ? 0 : 1, joint = first_joint_of(f);  // segment that the first of the three angles turns
  Vec3 lengths = scale * hand_lengths(f, first);
  Vec3 radii = scale * Vec3(hand_radius(f, first + 1), hand_radius(f, first + 2), hand_radius(f, first + 3));
  Vec3 start = is_thumb ? frame.base : frame.base + (scale * hand_length(f, 0)) * frame.forward;
  put_joint(joint, grip, frame.base, is_feasible);
  if (!is_thumb) put_joint(joint + 1, grip, start, is_feasible);
  Real depth = -NO_DISTANCE;
  [[dont_unroll]] for (int posture = 0; posture < (ON_TABLE ? 2 : 1); ++posture) {
    Real at = posture == 0 ? closure : Real(0);
    Vec3 angles = is_thumb ? thumb_angles(at) : finger_angles(at);
    if (is_thumb) angles = Vec3(angles.x, -angles.y, -angles.z);
    FingerPoints points = finger_points(frame, start, lengths, angles);
    if (posture == 0) {
      put_joint(joint + first + 1, grip, points.pip, is_feasible);
      put_joint(joint + first + 2, grip, points.dip, is_feasible);
      put_joint(joint + first + 3, grip, points.tip, is_feasible);
    } else {
      depth = finger_in_table(points, radii);
    }
  }
  return depth;
}

void main() {
  load_hand();
  uint grip = INVOCATION;
  if (grip >= push.count) return;
  load_outline();
  Closing closing = close_fingers(Grip(grip_axis(AXIS_HEIGHT, grip), grip_axis(AXIS_AZIMUTH, grip), grip_axis(AXIS_OBLIQUITY, grip),
                                       grip_axis(AXIS_ROLL, grip), grip_axis(AXIS_OFFSET, grip), grip_axis(AXIS_HAND_SCALE, grip)));
  bool is_feasible = closing.reason == REASON_NONE;
  uint status = uint(closing.reason);
  if (is_feasible) {
    if (closing.grazing) status |= STATUS_GRAZING;
    bool held = scene.friction_angle > Real(0);
    if (held && closing.thumb_angle <= scene.friction_angle && closing.index_angle <= scene.friction_angle) status |= STATUS_ANTIPODAL;
  }
  if (FEW_STEPS && closing.reason == REASON_NOT_CONVERGED) status |= STATUS_OUT_OF_TURNS;
  put_uint(PLANE_STATUS, grip, status);
  put_closing(grip, closing, is_feasible);
  put_rest(grip, is_feasible);
  UNROLL for (int c = 0; c < 3; ++c) put_point(PLACED, c, grip, closing.placement.rotation[c]);
  if (PLANE_WRIST_SHARE >= 0) put_point(PLACED + PLACED_TRANSLATION, 0, grip, closing.placement.translation);
  Real table_depth = -NO_DISTANCE;
  [[dont_unroll]] for (int f = 0; f < FINGERS; ++f)
    table_depth = max(table_depth, put_finger(f, grip, closing.placement, closing.closure, is_feasible));
  put_real(PLANE_TABLE_DEPTH, 0, grip, is_feasible ? table_depth : NOT_A_NUMBER);
}
