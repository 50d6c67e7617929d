// SPDX-License-Identifier: MIT
// As of commit 289a04a, to compare with (tests/bench/former_bench.cpp). Only the names of what layout.h has follow the program.
// Kernels 3, 5 and 4 of one grip an invocation, streamed: points are examined as they come, so that no array of 24 points is held.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "closure.glsl"
#include "contact.glsl"
#include "grips.glsl"
#include "planes.glsl"
#include "projection.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_POSE) const int POSE = POSE_ARTICULATED;

const bool WANTS_PROXIES = PLANE_PROXIES >= 0 || PLANE_BONE_STRETCH >= 0;
const bool WANTS_RIGGED = POSE != POSE_ARTICULATED || PLANE_JOINTS >= 0;

// What examining the points of a grip gathers.
uint grip;
Real scale;
uint status, touch_mask, tip_mask, finger_mask, inner_mask, used_mask;
Real phalanx_depth, palm_depth, judged_depth, bone_stretch;
Vec3 previous_proxy;

// Point k of finger f (joint j) at its posed place. `before`: bits of the finger's points that touched before they were projected.
void examine_point(int f, int k, int j, Vec3 p, Real radius, Real separation, Real bone, inout int before) {
  Real depth = max(Real(0), -separation);
  bool is_base = k == 0;
  palm_depth = is_base ? max(palm_depth, depth) : palm_depth;
  phalanx_depth = is_base ? phalanx_depth : max(phalanx_depth, depth);
  if (f < 2 || POSE != POSE_PAPER) judged_depth = max(judged_depth, depth);
  bool near_enough = separation <= HAND_CONTACT_TOLERANCE;
  if (k < 2 && near_enough) before |= 1 << k;
  bool touching = near_enough || j == THUMB_TIP || j == INDEX_TIP;
  uint bit = touching ? 1u << j : 0u;
  touch_mask |= bit;
  used_mask |= touching ? 1u << f : 0u;
  if (POSE != POSE_RIGGED && f >= 2 && k >= 2) {
    bool projected = touching && (before & (1 << k)) == 0;
    int role = projection_role(k, before);
    tip_mask |= projected && role == 0 ? bit : 0u;
    finger_mask |= projected && role == 1 ? bit : 0u;
    inner_mask |= projected && role == 2 ? bit : 0u;
  }
  if (PLANE_POSED >= 0) put_point(PLANE_POSED, j, grip, p);
  put_real(PLANE_SEPARATION, j, grip, separation);
  if (WANTS_PROXIES) {
    bool settled = true;
    Vec3 proxy = p;
    if (separation < Real(0)) proxy = proxy_of(p, radius, settled);
    if (!settled) status |= STATUS_PROXY_UNSETTLED;
    if (k > 0) bone_stretch = max(bone_stretch, abs(length(proxy - previous_proxy) - bone));
    previous_proxy = proxy;
    if (PLANE_PROXIES >= 0) put_point(PLANE_PROXIES, j, grip, proxy);
  }
}

void main() {
  grip = INVOCATION;
  if (grip >= push.count) return;
  load_outline();
  Closing closing = close_fingers(Grip(grip_axis(AXIS_HEIGHT, grip), grip_axis(AXIS_AZIMUTH, grip), grip_axis(AXIS_OBLIQUITY, grip),
                                       grip_axis(AXIS_ROLL, grip), grip_axis(AXIS_OFFSET, grip), grip_axis(AXIS_HAND_SCALE, grip)));
  status = uint(closing.reason);
  touch_mask = tip_mask = finger_mask = inner_mask = used_mask = 0u;
  bool reached = closing.reason == REASON_NONE || closing.reason >= REASON_TOO_WIDE;
  put_real(PLANE_T_INDEX, 0, grip, reached ? closing.t_index : NOT_A_NUMBER);
  put_real(PLANE_T_THUMB, 0, grip, reached ? closing.t_thumb : NOT_A_NUMBER);
  put_real(PLANE_GAP, 0, grip, reached ? closing.gap : NOT_A_NUMBER);
  if (PLANE_MIDPOINT >= 0) put_point(PLANE_MIDPOINT, 0, grip, reached ? closing.midpoint : Vec3(NOT_A_NUMBER));
  if (closing.reason != REASON_NONE) {
    put_uint(PLANE_STATUS, grip, status);
    put_uint(PLANE_TOUCH_MASK, grip, 0u);
    put_uint(PLANE_TIP_MASK, grip, 0u);
    put_uint(PLANE_FINGER_MASK, grip, 0u);
    put_uint(PLANE_INNER_MASK, grip, 0u);
    put_uint(PLANE_USED_MASK, grip, 0u);
    put_real(PLANE_CLOSURE, 0, grip, NOT_A_NUMBER);
    put_real(PLANE_CONTACT_ANGLES, 0, grip, NOT_A_NUMBER);
    put_real(PLANE_CONTACT_ANGLES, 1, grip, NOT_A_NUMBER);
    put_real(PLANE_PHALANX_DEPTH, 0, grip, NOT_A_NUMBER);
    put_real(PLANE_PALM_DEPTH, 0, grip, NOT_A_NUMBER);
    put_real(PLANE_BONE_STRETCH, 0, grip, NOT_A_NUMBER);
    for (int j = 0; j < JOINTS; ++j) {
      if (PLANE_JOINTS >= 0) put_point(PLANE_JOINTS, j, grip, Vec3(NOT_A_NUMBER));
      if (PLANE_POSED >= 0) put_point(PLANE_POSED, j, grip, Vec3(NOT_A_NUMBER));
      if (PLANE_PROXIES >= 0) put_point(PLANE_PROXIES, j, grip, Vec3(NOT_A_NUMBER));
      put_real(PLANE_SEPARATION, j, grip, NOT_A_NUMBER);
    }
    return;
  }
  if (closing.grazing) status |= STATUS_GRAZING;
  bool held = scene.friction_angle > Real(0);
  if (held && closing.thumb_angle <= scene.friction_angle && closing.index_angle <= scene.friction_angle) status |= STATUS_ANTIPODAL;

  scale = closing.placement.scale;
  phalanx_depth = palm_depth = judged_depth = bone_stretch = Real(0);
  Vec3 rigged_angles = finger_angles(closing.closure);
  PaperAxis axis;
  Vec3 thumb_tip, index_tip, index_mcp;
  // loops over fingers and points, not unrolled: each kernel is compiled once
  [[dont_unroll]] for (int f = 0; f < FINGERS; ++f) {
    int first_joint = f == 0 ? 0 : 5 * f - 1;
    int point_count = f == 0 ? 4 : 5;
    FingerFrame frame = placed_frame(closing.placement, hand_frame(f));
    Vec3 mcp = frame.base + (scale * hand_length(f, 0)) * frame.forward;
    Vec3 lengths = scale * Vec3(hand_length(f, 1), hand_length(f, 2), hand_length(f, 3));
    Vec3 radii = scale * Vec3(hand_radius(f, 2), hand_radius(f, 3), hand_radius(f, 4));
    int before = 0;
    FingerPoints points;
    Vec3 separations = Vec3(0);
    if (f == 0) {
      points = thumb_points(frame, scale * Vec3(hand_length(0, 0), hand_length(0, 1), hand_length(0, 2)), thumb_angles(closing.closure));
      mcp = points.pip;
      points.pip = points.dip;
      points.dip = points.tip;
      thumb_tip = points.tip;
    } else if (f == 1 || WANTS_RIGGED) {
      points = finger_points(frame, mcp, lengths, rigged_angles);
    }
    if (f == 1) {
      index_tip = points.tip;
      index_mcp = mcp;
      if (POSE == POSE_PAPER) {
        FingerFrame little = placed_frame(closing.placement, hand_frame(4));
        axis = paper_axis(index_mcp, little.base + (scale * hand_length(4, 0)) * little.forward, index_tip, thumb_tip);
      }
    }
    if (PLANE_JOINTS >= 0) {
      put_point(PLANE_JOINTS, first_joint, grip, frame.base);
      put_point(PLANE_JOINTS, first_joint + 1, grip, mcp);
      put_point(PLANE_JOINTS, first_joint + 2, grip, points.pip);
      put_point(PLANE_JOINTS, first_joint + 3, grip, points.dip);
      if (f > 0) put_point(PLANE_JOINTS, first_joint + 4, grip, points.tip);
    }
    bool known = POSE == POSE_ARTICULATED && f >= 2;
    if (known) {
      FingerMotion motion = start_motion(closing.closure);
      while (motion.joint < 3) {
        points = finger_points(frame, mcp, lengths, motion.angles);
        Watch watch = watch_points(points, radii);
        separations = watch.separations;
        motion = advance_finger(motion, frame, mcp, points, watch, lengths);
      }
      if (motion.before.x <= HAND_CONTACT_TOLERANCE) before |= 1 << 2;
      if (motion.before.y <= HAND_CONTACT_TOLERANCE) before |= 1 << 3;
      if (motion.before.z <= HAND_CONTACT_TOLERANCE) before |= 1 << 4;
      if (motion.blocked) status |= 1u << (STATUS_BLOCKED_SHIFT + f);
      if (motion.unsettled) status |= 1u << (STATUS_UNSETTLED_SHIFT + f);
    }
    if (POSE == POSE_PAPER && f >= 2) {
      // before any of them is examined: roles are judged on the state before
      [[dont_unroll]] for (int k = 2; k < 5; ++k) {
        Vec3 p = k == 2 ? points.pip : k == 3 ? points.dip : points.tip;
        Real radius = scale * hand_radius(f, k);
        bool unsettled = false;
        if (separation_at(p, radius) <= HAND_CONTACT_TOLERANCE) {
          before |= 1 << k;
        } else {
          p = project_point(p, radius, mcp, axis, HAND_PAPER_MAX_ANGLE, unsettled);
        }
        if (unsettled) status |= 1u << (STATUS_UNSETTLED_SHIFT + f);
        if (k == 2) points.pip = p;
        if (k == 3) points.dip = p;
        if (k == 4) points.tip = p;
      }
    }
    [[dont_unroll]] for (int k = 0; k < point_count; ++k) {
      Vec3 p = k == 0 ? frame.base : k == 1 ? mcp : k == 2 ? points.pip : k == 3 ? points.dip : points.tip;
      Real radius = scale * hand_radius(f, k);
      Real bone = k > 0 ? scale * hand_length(f, k - 1) : Real(0);
      Real separation = k == 2 ? separations.x : k == 3 ? separations.y : separations.z;
      if (!known || k < 2) separation = separation_at(p, radius);
      examine_point(f, k, first_joint + k, p, radius, separation, bone, before);
    }
  }
  if (judged_depth <= HAND_DEPTH_LIMIT) status |= STATUS_PLAUSIBLE;
  put_uint(PLANE_STATUS, grip, status);
  put_uint(PLANE_TOUCH_MASK, grip, touch_mask);
  put_uint(PLANE_TIP_MASK, grip, tip_mask);
  put_uint(PLANE_FINGER_MASK, grip, finger_mask);
  put_uint(PLANE_INNER_MASK, grip, inner_mask);
  put_uint(PLANE_USED_MASK, grip, used_mask);
  put_real(PLANE_CLOSURE, 0, grip, closing.closure);
  put_real(PLANE_CONTACT_ANGLES, 0, grip, closing.thumb_angle);
  put_real(PLANE_CONTACT_ANGLES, 1, grip, closing.index_angle);
  put_real(PLANE_PHALANX_DEPTH, 0, grip, phalanx_depth);
  put_real(PLANE_PALM_DEPTH, 0, grip, palm_depth);
  put_real(PLANE_BONE_STRETCH, 0, grip, bone_stretch);
}
