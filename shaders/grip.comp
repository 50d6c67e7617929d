// SPDX-License-Identifier: MIT
// Kernels 3, 5, 4, 8 and 11 of one grip an invocation, streamed: points are examined as they come, so that no array of 24 points is held.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "body.glsl"
#include "closure.glsl"
#include "contact.glsl"
#include "grips.glsl"
#include "planes.glsl"
#include "projection.glsl"
#include "table.glsl"
#include "wrist.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_CONTACTS) const int CONTACTS = -1;
layout(constant_id = CONST_POSE) const int POSE = POSE_ARTICULATED;
layout(constant_id = CONST_FEW_STEPS) const bool FEW_STEPS = false;

const bool WANTS_PROXIES = PLANE_PROXIES >= 0 || PLANE_BONE_STRETCH >= 0;
const bool WANTS_RIGGED = POSE != POSE_ARTICULATED || PLANE_JOINTS >= 0;

// What examining the points of a grip gathers.
uint grip;
Real scale;
uint status, touch_mask, tip_mask, finger_mask, inner_mask, used_mask;
Real phalanx_depth, palm_depth, judged_depth, bone_stretch, table_depth, self_depth, wrist_share;
Ball chain[JOINTS];  // the posed hand, where it has spheres between its joints
Vec3 previous_proxy;

// Kernel 9, for the efforts. Whether the point presses.
bool put_contact(int j, Vec3 p, bool touching) {
  Vec3 place, normal;
  bool presses = presses_at(p, place, normal) && touching;
  put_point(CONTACTS, 2 * j, grip, presses ? place : Vec3(0));
  put_point(CONTACTS, 2 * j + 1, grip, presses ? normal : Vec3(0));
  return presses;
}

// A depth in the vessel, of the palm or of the rest of finger f. In pose paper the fingers that it moves are not judged.
void add_depth(int f, bool is_palm, Real separation) {
  Real depth = max(Real(0), -separation);
  palm_depth = is_palm ? max(palm_depth, depth) : palm_depth;
  phalanx_depth = is_palm ? phalanx_depth : max(phalanx_depth, depth);
  if (f < 2 || POSE != POSE_PAPER) judged_depth = max(judged_depth, depth);
}

// Point k of finger f (joint j) at its posed place. `before`: bits of the finger's points that touched before they were projected.
void examine_point(int f, int k, int j, Vec3 p, Real radius, Real separation, Real bone, inout int before) {
  add_depth(f, k == 0, separation);
  if (ON_TABLE) table_depth = max(table_depth, depth_in_table(p, radius));
  // touching: the tracked tips always do
  bool is_tip = j == THUMB_TIP || j == INDEX_TIP;
  status |= !is_tip && is_undecided(p, separation, HAND_CONTACT_TOLERANCE) ? STATUS_CONTACT_UNDECIDED : 0u;
  bool near_enough = separation <= HAND_CONTACT_TOLERANCE;
  if (k < 2 && near_enough) before |= 1 << k;
  bool touching = near_enough || is_tip;
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
  if (CONTACTS >= 0) put_contact(j, p, touching);
  // what is kept of the point; its proxy only where it is inside
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

void put_closing(Closing closing) {
  bool reached = closing.reason == REASON_NONE || closing.reason >= REASON_TOO_WIDE;
  put_real(PLANE_T_INDEX, 0, grip, reached ? closing.t_index : NOT_A_NUMBER);
  put_real(PLANE_T_THUMB, 0, grip, reached ? closing.t_thumb : NOT_A_NUMBER);
  put_real(PLANE_GAP, 0, grip, reached ? closing.gap : NOT_A_NUMBER);
  if (PLANE_MIDPOINT >= 0) put_point(PLANE_MIDPOINT, 0, grip, reached ? closing.midpoint : Vec3(NOT_A_NUMBER));
}

void put_masks() {
  bool is_unsettled = (status & STATUS_REASON_MASK) == REASON_NOT_CONVERGED || (status >> STATUS_UNSETTLED_SHIFT & 0x1Fu) != 0u;
  if (FEW_STEPS && is_unsettled) status |= STATUS_OUT_OF_TURNS;
  put_uint(PLANE_STATUS, grip, status);
  put_uint(PLANE_TOUCH_MASK, grip, touch_mask);
  put_uint(PLANE_TIP_MASK, grip, tip_mask);
  put_uint(PLANE_FINGER_MASK, grip, finger_mask);
  put_uint(PLANE_INNER_MASK, grip, inner_mask);
  put_uint(PLANE_USED_MASK, grip, used_mask);
}

void put_whole(Real closure, Real thumb_angle, Real index_angle) {
  put_real(PLANE_CLOSURE, 0, grip, closure);
  put_real(PLANE_CONTACT_ANGLES, 0, grip, thumb_angle);
  put_real(PLANE_CONTACT_ANGLES, 1, grip, index_angle);
  put_real(PLANE_PHALANX_DEPTH, 0, grip, phalanx_depth);
  put_real(PLANE_PALM_DEPTH, 0, grip, palm_depth);
  put_real(PLANE_BONE_STRETCH, 0, grip, bone_stretch);
  put_real(PLANE_TABLE_DEPTH, 0, grip, table_depth);
  put_real(PLANE_SELF_DEPTH, 0, grip, self_depth);
  put_real(PLANE_WRIST_SHARE, 0, grip, wrist_share);
}

// What a grip that is infeasible has not.
void put_nothing() {
  phalanx_depth = palm_depth = bone_stretch = table_depth = self_depth = wrist_share = NOT_A_NUMBER;
  put_whole(NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER);
  for (int j = 0; j < JOINTS; ++j) {
    if (PLANE_JOINTS >= 0) put_point(PLANE_JOINTS, j, grip, Vec3(NOT_A_NUMBER));
    if (PLANE_POSED >= 0) put_point(PLANE_POSED, j, grip, Vec3(NOT_A_NUMBER));
    if (PLANE_PROXIES >= 0) put_point(PLANE_PROXIES, j, grip, Vec3(NOT_A_NUMBER));
    put_real(PLANE_SEPARATION, j, grip, NOT_A_NUMBER);
  }
}

// A finger placed in the vessel frame at its grip's scale; its points as they are posed so far, of the thumb the last three.
struct PlacedFinger {
  FingerFrame frame;
  Vec3 mcp, lengths, radii;
  FingerPoints points;
  Vec3 separations;
  int before;  // see examine_point
};

PlacedFinger place_finger(int f, Closing closing, Vec3 rigged_angles) {
  PlacedFinger finger;
  finger.frame = placed_frame(closing.placement, hand_frame(f));
  finger.mcp = finger.frame.base + (scale * hand_length(f, 0)) * finger.frame.forward;
  finger.lengths = scale * Vec3(hand_length(f, 1), hand_length(f, 2), hand_length(f, 3));
  finger.radii = scale * Vec3(hand_radius(f, 2), hand_radius(f, 3), hand_radius(f, 4));
  finger.before = 0;
  finger.separations = Vec3(0);
  if (f == 0) {
    Vec3 lengths = scale * Vec3(hand_length(0, 0), hand_length(0, 1), hand_length(0, 2));
    finger.points = thumb_points(finger.frame, lengths, thumb_angles(closing.closure));
    finger.mcp = finger.points.pip;
    finger.points.pip = finger.points.dip;
    finger.points.dip = finger.points.tip;
  } else if (f == 1 || WANTS_RIGGED) {
    finger.points = finger_points(finger.frame, finger.mcp, finger.lengths, rigged_angles);
  }
  return finger;
}

void put_rigged(int f, int first_joint, PlacedFinger finger) {
  put_point(PLANE_JOINTS, first_joint, grip, finger.frame.base);
  put_point(PLANE_JOINTS, first_joint + 1, grip, finger.mcp);
  put_point(PLANE_JOINTS, first_joint + 2, grip, finger.points.pip);
  put_point(PLANE_JOINTS, first_joint + 3, grip, finger.points.dip);
  if (f > 0) put_point(PLANE_JOINTS, first_joint + 4, grip, finger.points.tip);
}

void pose_articulated(int f, Real closure, inout PlacedFinger finger) {
  RestingFinger resting =
      rest_finger(Finger(finger.frame, finger.mcp, finger.lengths, Vec4(scale * hand_radius(f, 1), finger.radii)), closure);
  finger.points = resting.points;
  finger.separations = resting.separations;
  if (resting.before.x <= HAND_CONTACT_TOLERANCE) finger.before |= 1 << 2;
  if (resting.before.y <= HAND_CONTACT_TOLERANCE) finger.before |= 1 << 3;
  if (resting.before.z <= HAND_CONTACT_TOLERANCE) finger.before |= 1 << 4;
  if (resting.blocked) status |= 1u << (STATUS_BLOCKED_SHIFT + f);
  if (resting.undecided) status |= STATUS_CONTACT_UNDECIDED;
  if (resting.unsettled) status |= 1u << (STATUS_UNSETTLED_SHIFT + f);
}

// Before any of the points is examined: roles are judged on the state before.
void pose_paper(int f, PaperAxis axis, inout PlacedFinger finger) {
  [[dont_unroll]] for (int k = 2; k < 5; ++k) {
    Vec3 p = k == 2 ? finger.points.pip : k == 3 ? finger.points.dip : finger.points.tip;
    Real radius = scale * hand_radius(f, k);
    bool unsettled = false;
    if (separation_at(p, radius) <= HAND_CONTACT_TOLERANCE) {
      finger.before |= 1 << k;
    } else {
      p = project_point(p, radius, finger.mcp, axis, HAND_PAPER_MAX_ANGLE, unsettled);
    }
    if (unsettled) status |= 1u << (STATUS_UNSETTLED_SHIFT + f);
    if (k == 2) finger.points.pip = p;
    if (k == 3) finger.points.dip = p;
    if (k == 4) finger.points.tip = p;
  }
}

// Point k of a finger, from its base to its tip.
Vec3 point_of(PlacedFinger finger, int k) {
  return k == 0   ? finger.frame.base
         : k == 1 ? finger.mcp
         : k == 2 ? finger.points.pip
         : k == 3 ? finger.points.dip
                  : finger.points.tip;
}

// `known`: the finger came to rest with the separations of its last three points.
void examine_finger(int f, int first_joint, bool known, inout PlacedFinger finger) {
  int point_count = f == 0 ? 4 : 5;
  [[dont_unroll]] for (int k = 0; k < point_count; ++k) {
    Vec3 p = point_of(finger, k);
    Real radius = scale * hand_radius(f, k);
    Real bone = k > 0 ? scale * hand_length(f, k - 1) : Real(0);
    Real separation = k == 2 ? finger.separations.x : k == 3 ? finger.separations.y : finger.separations.z;
    if (!known || k < 2) separation = separation_at(p, radius);
    examine_point(f, k, first_joint + k, p, radius, separation, bone, finger.before);
  }
}

// The spheres between the joints of a finger whose joints are examined: depths, and contacts in the places of joints that do not touch, as
// core/contacts.cpp has it.
void examine_between(int f, int first_joint, PlacedFinger finger) {
  int bones = f == 0 ? 3 : 4;
  uint vacant = ~(touch_mask >> first_joint) & ((2u << bones) - 1u);
  [[dont_unroll]] for (int i = 0; i < bones * BETWEEN; ++i) {
    int bone = i / BETWEEN;
    Real share = Real(i - bone * BETWEEN + 1) / Real(BETWEEN + 1);
    Ball ball = ball_between(point_of(finger, bone), point_of(finger, bone + 1), scale * hand_radius(f, bone),
                             scale * hand_radius(f, bone + 1), share);
    Real separation = separation_at(ball.place, ball.radius);
    add_depth(f, bone == 0, separation);
    status |= is_undecided(ball.place, separation, HAND_CONTACT_TOLERANCE) ? STATUS_CONTACT_UNDECIDED : 0u;
    uint places = vacant & (bone == 0 ? 1u : ~1u);
    bool touching = CONTACTS >= 0 && separation <= HAND_CONTACT_TOLERANCE && places != 0u;
    // a driver skips a loop of one turn that no lane takes
    [[dont_unroll]] for (bool once = touching; once; once = false) {
      int place = findLSB(places);
      if (put_contact(first_joint + place, ball.place, true)) vacant &= ~(1u << place);
    }
  }
}

void keep_chain(int f, int first_joint, PlacedFinger finger) {
  int point_count = f == 0 ? 4 : 5;
  [[dont_unroll]] for (int k = 0; k < point_count; ++k) chain[first_joint + k] = Ball(point_of(finger, k), scale * hand_radius(f, k));
}

// As core/joints.h has them.
int phalanx_digit(int phalanx) { return (phalanx + 1) / 3; }
int phalanx_start(int phalanx) { return phalanx + 1 + 2 * phalanx_digit(phalanx); }

// As core/grip.cpp has it. Places that are constants are read for all lanes at once, others lane by lane: so a first pass finds which
// of the other bones are near, and only these are evaluated.
Real digits_overlap() {
  Ball around[PHALANGES];
  [[unroll]] for (int bone = 0; bone < PHALANGES; ++bone) around[bone] = around_bone(chain[phalanx_start(bone)], chain[phalanx_start(bone) + 1]);
  Real deepest = -NO_DISTANCE;
  [[unroll]] for (int bone = 2; bone + 3 < PHALANGES; ++bone) {
    Ball mine = chain[phalanx_start(bone) + 1], beside = chain[phalanx_start(bone + 3) + 1];
    deepest = max(deepest, mine.radius + beside.radius - length(mine.place - beside.place));
  }
  [[dont_unroll]] for (int bone = 0; bone + 3 < PHALANGES; ++bone) {
    Ball mine = around[bone], start = chain[phalanx_start(bone)], end = chain[phalanx_start(bone) + 1];
    uint near = 0u;
    [[unroll]] for (int other = 2; other < PHALANGES; ++other) near |= overlap_more(mine, around[other], deepest) ? 1u << other : 0u;
    near &= ~0u << (3 * phalanx_digit(bone) + 2);
    [[dont_unroll]] while (near != 0u) {
      int other = findLSB(near);
      near &= near - 1u;
      Ball other_start = chain[phalanx_start(other)], other_end = chain[phalanx_start(other) + 1];
      deepest = bones_overlap(start.place, end.place, Vec2(start.radius, end.radius), other_start.place, other_end.place,
                              Vec2(other_start.radius, other_end.radius), deepest);
    }
  }
  return deepest;
}

// The finger open at the same place, which it has to come from: its base, and an MCP other than the thumb's, are the posed finger's.
void examine_open_finger(int f, PlacedFinger finger) {
  FingerPoints open;
  Vec3 radii = finger.radii;
  if (f == 0) {
    Vec3 lengths = scale * Vec3(hand_length(0, 0), hand_length(0, 1), hand_length(0, 2));
    open = thumb_points(finger.frame, lengths, thumb_angles(Real(0)));
    radii = scale * Vec3(hand_radius(0, 1), hand_radius(0, 2), hand_radius(0, 3));
  } else {
    open = finger_points(finger.frame, finger.mcp, finger.lengths, finger_angles(Real(0)));
  }
  table_depth = max(table_depth, finger_in_table(open, radii));
}

// A loop over fingers, not unrolled: each kernel is compiled once.
void rest_hand(Closing closing) {
  Vec3 rigged_angles = finger_angles(closing.closure);
  PaperAxis axis;
  Vec3 thumb_tip;
  [[dont_unroll]] for (int f = 0; f < FINGERS; ++f) {
    int first_joint = f == 0 ? 0 : 5 * f - 1;
    // where the closed hand has it
    PlacedFinger finger = place_finger(f, closing, rigged_angles);
    if (f == 0) thumb_tip = finger.points.tip;
    // the axis of pose paper needs thumb, index and little finger: they are known before the middle finger moves
    if (f == 1 && POSE == POSE_PAPER) {
      FingerFrame little = placed_frame(closing.placement, hand_frame(4));
      Vec3 little_mcp = little.base + (scale * hand_length(4, 0)) * little.forward;
      axis = paper_axis(finger.mcp, little_mcp, finger.points.tip, thumb_tip);
    }
    // rigged points are kept before the pose moves them; then the finger comes to rest and is examined
    if (PLANE_JOINTS >= 0) put_rigged(f, first_joint, finger);
    bool known = POSE == POSE_ARTICULATED && f >= 2;
    if (known) pose_articulated(f, closing.closure, finger);
    if (POSE == POSE_PAPER && f >= 2) pose_paper(f, axis, finger);
    examine_finger(f, first_joint, known, finger);
    if (BETWEEN > 0) {
      examine_between(f, first_joint, finger);
      keep_chain(f, first_joint, finger);
    }
    if (ON_TABLE) examine_open_finger(f, finger);
  }
}

void main() {
  load_hand();
  grip = INVOCATION;
  if (grip >= push.count) return;
  // kernel 3: where the hand closes, or why it does not
  load_outline();
  Closing closing = close_fingers(Grip(grip_axis(AXIS_HEIGHT, grip), grip_axis(AXIS_AZIMUTH, grip), grip_axis(AXIS_OBLIQUITY, grip),
                                       grip_axis(AXIS_ROLL, grip), grip_axis(AXIS_OFFSET, grip), grip_axis(AXIS_HAND_SCALE, grip)));
  status = uint(closing.reason);
  touch_mask = tip_mask = finger_mask = inner_mask = used_mask = 0u;
  put_closing(closing);
  // infeasible: the reason, and NaN for the rest
  if (closing.reason != REASON_NONE) {
    put_masks();
    put_nothing();
    return;
  }
  // the contacts of the two tips
  if (closing.grazing) status |= STATUS_GRAZING;
  bool held = scene.friction_angle > Real(0);
  if (held && closing.thumb_angle <= scene.friction_angle && closing.index_angle <= scene.friction_angle) status |= STATUS_ANTIPODAL;
  // kernels 5, 4 and 8: the other fingers rest, all points are examined
  scale = closing.placement.scale;
  phalanx_depth = palm_depth = judged_depth = bone_stretch = Real(0);
  table_depth = -NO_DISTANCE;
  rest_hand(closing);
  if (judged_depth <= HAND_DEPTH_LIMIT) status |= STATUS_PLAUSIBLE;
  self_depth = BETWEEN > 0 ? digits_overlap() : Real(0);
  if (BETWEEN > 0 && self_depth > HAND_DEPTH_LIMIT) status = (status | STATUS_SELF_OVERLAP) & ~STATUS_PLAUSIBLE;
  if (ON_TABLE && table_depth > Real(0)) status = (status | STATUS_THROUGH_TABLE) & ~STATUS_PLAUSIBLE;
  wrist_share = HOLDER_AZIMUTHS > 0 ? find_wrist(closing.placement, grip_axis(AXIS_AZIMUTH, grip)).share : Real(0);
  if (HOLDER_AZIMUTHS > 0 && wrist_share > Real(1)) status = (status | STATUS_BEYOND_WRIST) & ~STATUS_PLAUSIBLE;
  put_masks();
  put_whole(closing.closure, closing.thumb_angle, closing.index_angle);
}
