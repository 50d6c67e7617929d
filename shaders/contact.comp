// SPDX-License-Identifier: MIT
// Kernels 4, 8 and 9, one feasible grip per invocation: the contacts and depths of the posed hand's points and of the spheres between them. Each
// point is examined at once, so that no array of 24 points is needed.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "body.glsl"
#include "contact.glsl"
#include "placed.glsl"
#include "projection.glsl"
#include "table.glsl"

layout(constant_id = CONST_CONTACTS) const int CONTACTS = -1;

const bool WANTS_PROXIES = PLANE_PROXIES >= 0 || PLANE_BONE_STRETCH >= 0;

// Accumulates the results of examining a grip's points.
uint touch_mask, tip_mask, finger_mask, inner_mask, used_mask;
Real phalanx_depth, palm_depth, judged_depth, bone_stretch, table_depth;
Vec3 previous_proxy;

// A depth in the vessel, of the palm or of the rest of finger f. In pose paper, moved fingers are not judged.
void add_depth(int f, bool is_palm, Real separation) {
  Real depth = max(Real(0), -separation);
  palm_depth = is_palm ? max(palm_depth, depth) : palm_depth;
  phalanx_depth = is_palm ? phalanx_depth : max(phalanx_depth, depth);
  if (f < 2 || POSE != POSE_PAPER) judged_depth = max(judged_depth, depth);
}

// Point k of finger f (joint j). `before`: bits of the finger's points that touched before they were projected.
void examine_point(int f, int k, int j, Ball ball, Real separation, bool touching, inout int before) {
  if (ON_TABLE) table_depth = max(table_depth, depth_in_table(ball.place, ball.radius));
  if (k < 2 && separation <= HAND_CONTACT_TOLERANCE) before |= 1 << k;
  uint bit = touching ? 1u << j : 0u;
  touch_mask |= bit;
  used_mask |= touching ? 1u << f : 0u;
  // projected: it touches now and did not before
  if (POSE != POSE_RIGGED && f >= 2 && k >= 2) {
    bool projected = touching && (before & (1 << k)) == 0;
    int role = projection_role(k, before);
    tip_mask |= projected && role == 0 ? bit : 0u;
    finger_mask |= projected && role == 1 ? bit : 0u;
    inner_mask |= projected && role == 2 ? bit : 0u;
  }
  put_real(PLANE_SEPARATION, j, grip, separation);
  if (WANTS_PROXIES) {
    bool settled = true;
    Vec3 proxy = ball.place;
    if (separation < Real(0)) proxy = proxy_of(ball.place, ball.radius, settled);
    if (!settled) status |= STATUS_PROXY_UNSETTLED;
    if (k > 0) bone_stretch = max(bone_stretch, abs(length(proxy - previous_proxy) - scale * hand_length(f, k - 1)));
    previous_proxy = proxy;
    if (PLANE_PROXIES >= 0) put_point(PLANE_PROXIES, j, grip, proxy);
  }
}

// The points of a finger, and then the spheres between them: depths, and contacts in the slots of joints that do not touch, as in core/contacts.cpp.
// One loop for both, so that the distance is compiled once.
void examine_finger(int f, int before) {
  int first_joint = first_joint_of(f), points = points_of(f), bones = points - 1;
  uint vacant = 0u;
  [[dont_unroll]] for (int i = 0; i < points + bones * BETWEEN; ++i) {
    bool is_joint = i < points;
    int bone = BETWEEN > 0 ? (i - points) / max(BETWEEN, 1) : 0;
    int start = first_joint + (is_joint ? i : bone);
    Ball ball = Ball(posed_point(start, grip), scale * hand_radius(f, start - first_joint));
    if (BETWEEN > 0 && !is_joint) {
      Real share = Real(i - points - bone * BETWEEN + 1) / Real(BETWEEN + 1);
      ball = ball_between(ball.place, posed_point(start + 1, grip), ball.radius, scale * hand_radius(f, bone + 1), share);
      if (i == points) vacant = ~(touch_mask >> first_joint) & ((2u << bones) - 1u);
    }
    Support support;
    if (CONTACTS >= 0) {
      support = support_at(ball.place);
    } else {
      support.distance = signed_distance(ball.place);
    }
    Real separation = support.distance - ball.radius;
    bool is_tip = is_joint && (start == THUMB_TIP || start == INDEX_TIP);
    add_depth(f, is_joint ? i == 0 : bone == 0, separation);
    status |= !is_tip && is_undecided(ball.place, separation, HAND_CONTACT_TOLERANCE) ? STATUS_CONTACT_UNDECIDED : 0u;
    // the tracked tips always touch
    bool touching = separation <= HAND_CONTACT_TOLERANCE || is_tip;
    if (is_joint) examine_point(f, i, start, ball, separation, touching, before);
    if (CONTACTS < 0) continue;
    uint places = vacant & (bone == 0 ? 1u : ~1u);
    touching = touching && (is_joint || places != 0u);
    int joint = is_joint ? start : first_joint + findLSB(places);
    bool presses = touching && support.element != int(scene.lid);
    Vec3 place = Vec3(0), normal = Vec3(0);
    if (presses) {
      Vec3 outward = SDF_KIND == SDF_LATTICE ? lattice_gradient(ball.place) : support.normal;
      place = ball.place - support.distance * outward;
      normal = -outward;
      vacant &= is_joint ? ~0u : ~(1u << (joint - first_joint));
    }
    if (is_joint || presses) {
      put_point(CONTACTS, 2 * joint, grip, place);
      put_point(CONTACTS, 2 * joint + 1, grip, normal);
    }
  }
}

void examine_hand() {
  status = status_of(grip);
  scale = grip_scale(grip);
  touch_mask = tip_mask = finger_mask = inner_mask = used_mask = 0u;
  phalanx_depth = palm_depth = judged_depth = bone_stretch = Real(0);
  table_depth = ON_TABLE ? kept(PLANE_TABLE_DEPTH, 0, grip) : Real(0);  // of the open hand
  int before = POSE != POSE_RIGGED ? int(kept(PLACED, PLACED_BEFORE, grip)) : 0;
  [[dont_unroll]] for (int f = 0; f < FINGERS; ++f) examine_finger(f, f < 2 ? 0 : (before >> (3 * (f - 2)) & 7) << 2);
  if (judged_depth <= HAND_DEPTH_LIMIT) status |= STATUS_PLAUSIBLE;
  if (ON_TABLE && table_depth > Real(0)) status = (status | STATUS_THROUGH_TABLE) & ~STATUS_PLAUSIBLE;
  put_uint(PLANE_STATUS, grip, status);
  put_uint(PLANE_TOUCH_MASK, grip, touch_mask);
  put_uint(PLANE_TIP_MASK, grip, tip_mask);
  put_uint(PLANE_FINGER_MASK, grip, finger_mask);
  put_uint(PLANE_INNER_MASK, grip, inner_mask);
  put_uint(PLANE_USED_MASK, grip, used_mask);
  put_real(PLANE_PHALANX_DEPTH, 0, grip, phalanx_depth);
  put_real(PLANE_PALM_DEPTH, 0, grip, palm_depth);
  put_real(PLANE_BONE_STRETCH, 0, grip, bone_stretch);
  put_real(PLANE_TABLE_DEPTH, 0, grip, table_depth);
}

void main() {
  bool has_grip = take_feasible_grip(grip);
  load_hand();
  load_outline();
  if (has_grip) examine_hand();
}
