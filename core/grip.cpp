// SPDX-License-Identifier: MIT
#include "core/grip.h"

#include <algorithm>
#include <cmath>

#include "core/body.h"
#include "core/contact.h"
#include "core/joints.h"
#include "core/table.h"

namespace CORE_NS {

using wholehand::finger_joints;
using wholehand::finger_start;
using wholehand::phalanx_digit;
using wholehand::phalanx_start;

namespace {

// A finger placed in the vessel frame at its grip's scale.
struct PlacedFinger {
  FingerFrame frame;
  Vec3 mcp{};
  Vec3 lengths{};  // L1, L2, L3
  std::array<Real, 5> radius{};
};

PlacedFinger place_finger(const Hand& hand, const Placement& placement, int f) {
  PlacedFinger finger;
  finger.frame = placed_frame(placement, hand.frame[f]);
  finger.mcp = finger.frame.base + (placement.scale * hand.length[f][0]) * finger.frame.forward;
  finger.lengths = placement.scale * Vec3(hand.length[f][1], hand.length[f][2], hand.length[f][3]);
  for (int k = 0; k < 5; ++k) finger.radius[k] = placement.scale * hand.radius[f][k];
  return finger;
}

Vec3 separations_of(const Vessel& vessel, const FingerPoints& points, const PlacedFinger& finger) {
  return Vec3(separation_at(vessel, points.pip, finger.radius[2]), separation_at(vessel, points.dip, finger.radius[3]),
              separation_at(vessel, points.tip, finger.radius[4]));
}

// Sets PIP, DIP and tip of a finger, whose joints begin at `first`.
void put_points(const FingerPoints& points, int first, GripAnswer& answer) {
  answer.posed[first] = points.pip;
  answer.posed[first + 1] = points.dip;
  answer.posed[first + 2] = points.tip;
}

// Sets the three joints beyond an MCP, and which of a finger's five points touched before projection.
void pose_articulated(const Hand& hand, const Vessel& vessel, const PlacedFinger& finger, int f, GripAnswer& answer, int& before) {
  const std::array<Real, 4> radii{finger.radius[1], finger.radius[2], finger.radius[3], finger.radius[4]};
  const RestingFinger resting =
      rest_finger(hand, vessel, {finger.frame, finger.mcp, finger.lengths, radii}, answer.closing.closure);
  const int j = finger_start(f);
  put_points(resting.points, j + 2, answer);
  for (int k = 0; k < 3; ++k) {
    answer.separation[j + 2 + k] = resting.separations[k];
    if (resting.before[k] <= hand.contact_tolerance) before |= 1 << (2 + k);
  }
  answer.advance_steps = std::max(answer.advance_steps, resting.steps);
  if (resting.blocked) answer.status |= 1u << (STATUS_BLOCKED_SHIFT + f);
  if (resting.undecided) answer.status |= STATUS_CONTACT_UNDECIDED;
  if (resting.unsettled) answer.status |= 1u << (STATUS_UNSETTLED_SHIFT + f);
}

void pose_paper(const Hand& hand, const Vessel& vessel, const PlacedFinger& finger, int f, const FingerPoints& rigged,
                PaperAxis axis, GripAnswer& answer, int& before) {
  const int j = finger_start(f);
  const Vec3 separations = separations_of(vessel, rigged, finger);
  const std::array<Vec3, 3> points{rigged.pip, rigged.dip, rigged.tip};
  for (int k = 0; k < 3; ++k) {
    answer.posed[j + 2 + k] = points[k];
    if (separations[k] <= hand.contact_tolerance) {
      before |= 1 << (2 + k);
      continue;
    }
    bool unsettled = false;
    answer.posed[j + 2 + k] =
        project_point(vessel, points[k], finger.radius[2 + k], finger.mcp, axis, hand.paper_max_angle, unsettled);
    if (unsettled) answer.status |= 1u << (STATUS_UNSETTLED_SHIFT + f);
  }
}

// Poses the hand where it closed. The thumb's chain starts at its base, that of another finger at its MCP.
std::array<PlacedFinger, FINGERS> rig_hand(const Hand& hand, PoseKind pose, Wanted wanted, GripAnswer& answer) {
  const Closing& closing = answer.closing;
  const Vec3 thumb_lengths = closing.placement.scale * Vec3(hand.length[0][0], hand.length[0][1], hand.length[0][2]);
  const FingerFrame thumb = placed_frame(closing.placement, hand.frame[0]);
  answer.posed[0] = thumb.base;
  put_points(thumb_points(thumb, thumb_lengths, thumb_angles(hand, closing.closure)), 1, answer);
  const Vec3 angles = finger_angles(hand, closing.closure);
  std::array<PlacedFinger, FINGERS> fingers;
  for (int f = 1; f < FINGERS; ++f) {
    const int j = finger_start(f);
    fingers[f] = place_finger(hand, closing.placement, f);
    answer.posed[j] = fingers[f].frame.base;
    answer.posed[j + 1] = fingers[f].mcp;
    // in pose articulated the last three fingers close on their own: their rigged points are only for display
    if (f == 1 || pose != PoseKind::articulated || wanted.joints)
      put_points(finger_points(fingers[f].frame, fingers[f].mcp, fingers[f].lengths, angles), j + 2, answer);
  }
  return fingers;
}

// Kernel 4 on the posed hand: masks, depths, proxies and bone stretch. A finger's base and MCP do not move, so this also finds whether they touched
// before; an articulated finger came to rest with known separations. Returns the depth that decides plausibility.
Real examine_pose(const Hand& hand, const Vessel& vessel, PoseKind pose, Wanted wanted, Real scale,
                  std::array<int, FINGERS>& before, GripAnswer& answer) {
  Real judged_depth = 0;
  for (int f = 0; f < FINGERS; ++f) {
    for (int k = 0; k < finger_joints(f); ++k) {
      const int j = finger_start(f) + k;
      const Real radius = scale * hand.radius[f][k];
      const bool known = pose == PoseKind::articulated && f >= 2 && k >= 2;
      if (!known) answer.separation[j] = separation_at(vessel, answer.posed[j], radius);
      const Real separation = answer.separation[j];
      if (k < 2 && separation <= hand.contact_tolerance) before[f] |= 1 << k;
      if (j != THUMB_TIP && j != INDEX_TIP && is_undecided(vessel, answer.posed[j], separation, hand.contact_tolerance))
        answer.status |= STATUS_CONTACT_UNDECIDED;
      const Real depth = std::max(Real(0), -separation);
      if (k == 0) {
        answer.palm_depth = std::max(answer.palm_depth, depth);
      } else {
        answer.phalanx_depth = std::max(answer.phalanx_depth, depth);
      }
      // the paper's own projections are the method, not a fault of the pose
      if (f < 2 || pose != PoseKind::paper) judged_depth = std::max(judged_depth, depth);
      if (separation <= hand.contact_tolerance || j == THUMB_TIP || j == INDEX_TIP) {
        answer.touch_mask |= 1u << j;
        answer.used_mask |= 1u << f;
        if (pose != PoseKind::rigged && f >= 2 && k >= 2 && (before[f] & (1 << k)) == 0) {
          const int role = projection_role(k, before[f]);
          if (role == 0) answer.tip_mask |= 1u << j;
          if (role == 1) answer.finger_mask |= 1u << j;
          if (role == 2) answer.inner_mask |= 1u << j;
        }
      }
      if (wanted.proxies) {
        bool settled = true;
        answer.proxies[j] = separation < 0 ? proxy_of(vessel, answer.posed[j], radius, settled) : answer.posed[j];
        if (!settled) answer.status |= STATUS_PROXY_UNSETTLED;
        if (k > 0) {
          const Real bone = scale * hand.length[f][k - 1];
          const Real stretch = std::abs(glm::length(answer.proxies[j] - answer.proxies[j - 1]) - bone);
          answer.bone_stretch = std::max(answer.bone_stretch, stretch);
        }
      }
    }
  }
  return judged_depth;
}

// Kernel 8: the spheres between the joints of the posed hand have depths, like joints. Returns the deciding depth, as above.
Real examine_between(const Hand& hand, const Vessel& vessel, PoseKind pose, Real scale, GripAnswer& answer) {
  Real judged_depth = 0;
  for (int f = 0; f < FINGERS; ++f)
    for (int bone = 0; bone + 1 < finger_joints(f); ++bone) {
      const int j = finger_start(f) + bone;
      for (int k = 1; k <= hand.between; ++k) {
        const Ball ball = ball_between(answer.posed[j], answer.posed[j + 1], scale * hand.radius[f][bone],
                                       scale * hand.radius[f][bone + 1], Real(k) / Real(hand.between + 1));
        const Real separation = separation_at(vessel, ball.place, ball.radius), depth = std::max(Real(0), -separation);
        if (is_undecided(vessel, ball.place, separation, hand.contact_tolerance)) answer.status |= STATUS_CONTACT_UNDECIDED;
        Real& of_part = bone == 0 ? answer.palm_depth : answer.phalanx_depth;
        of_part = std::max(of_part, depth);
        if (f < 2 || pose != PoseKind::paper) judged_depth = std::max(judged_depth, depth);
      }
    }
  return judged_depth;
}

// Kernel 8: how far the posed hand reaches below the top of the table, and the open hand at the same place, from which it closes. The open hand's
// bases, and the MCPs of its fingers, are the posed hand's.
void examine_table(const Hand& hand, const Vessel& vessel, const Placement& placement, GripAnswer& answer) {
  Real depth = -NO_DISTANCE;
  for (int f = 0; f < FINGERS; ++f) {
    const PlacedFinger finger = place_finger(hand, placement, f);
    for (int k = 0; k < finger_joints(f); ++k)
      depth = std::max(depth, depth_in_table(vessel, answer.posed[finger_start(f) + k], finger.radius[k]));
    // the thumb's chain starts at its base, so its first point beyond is point 1; a finger's is point 2
    const int first = f == 0 ? 1 : 2;
    const Vec3 radii(finger.radius[first], finger.radius[first + 1], finger.radius[first + 2]);
    const Vec3 thumb_lengths = placement.scale * Vec3(hand.length[0][0], hand.length[0][1], hand.length[0][2]);
    const FingerPoints open = f == 0 ? thumb_points(finger.frame, thumb_lengths, thumb_angles(hand, Real(0)))
                                     : finger_points(finger.frame, finger.mcp, finger.lengths, finger_angles(hand, Real(0)));
    depth = std::max(depth, finger_in_table(vessel, open, radii));
  }
  answer.table_depth = depth;
  if (depth > 0) answer.status = (answer.status | STATUS_THROUGH_TABLE) & ~std::uint32_t(STATUS_PLAUSIBLE);
}

}  // namespace

// Two phalanges of the thumb and three of each finger make 78 pairs. Most are too far apart to matter, as their enclosing spheres show. More pairs
// can be skipped if the first depth is that of neighboring fingers' adjacent joints: it is an overlap too, and often nearly the largest.
Real digits_overlap(const Hand& hand, const std::array<Vec3, JOINTS>& posed, Real scale) {
  std::array<Ball, JOINTS> chain;
  for (int f = 0; f < FINGERS; ++f)
    for (int k = 0; k < finger_joints(f); ++k) chain[finger_start(f) + k] = {posed[finger_start(f) + k], scale * hand.radius[f][k]};
  std::array<Ball, PHALANGES> around;
  for (int bone = 0; bone < PHALANGES; ++bone)
    around[bone] = around_bone(chain[phalanx_start(bone)], chain[phalanx_start(bone) + 1]);
  Real deepest = -NO_DISTANCE;
  for (int bone = 2; bone + 3 < PHALANGES; ++bone) {
    const Ball mine = chain[phalanx_start(bone) + 1], beside = chain[phalanx_start(bone + 3) + 1];
    deepest = std::max(deepest, mine.radius + beside.radius - glm::length(mine.place - beside.place));
  }
  for (int bone = 0; bone + 3 < PHALANGES; ++bone) {
    const Ball start = chain[phalanx_start(bone)], end = chain[phalanx_start(bone) + 1];
    for (int other = 3 * phalanx_digit(bone) + 2; other < PHALANGES; ++other) {
      if (!overlap_more(around[bone], around[other], deepest)) continue;
      const Ball other_start = chain[phalanx_start(other)], other_end = chain[phalanx_start(other) + 1];
      deepest = bones_overlap(start.place, end.place, {start.radius, end.radius}, other_start.place, other_end.place,
                              {other_start.radius, other_end.radius}, deepest);
    }
  }
  return deepest;
}

void rest_hand(const Hand& hand, const Vessel& vessel, PoseKind pose, const Closing& closing, Real friction, Wanted wanted,
               GripAnswer& answer) {
  answer = GripAnswer{};
  answer.closing = closing;
  if (closing.grazing) answer.status |= STATUS_GRAZING;
  // both contacts within the friction cone
  const Real cone = std::atan(friction);
  if (cone > 0 && closing.thumb_angle <= cone && closing.index_angle <= cone) answer.status |= STATUS_ANTIPODAL;

  const std::array<PlacedFinger, FINGERS> fingers = rig_hand(hand, pose, wanted, answer);
  if (wanted.joints) answer.joints = answer.posed;

  // thumb and index stay; the other three come to rest on the vessel
  std::array<int, FINGERS> before{};
  if (pose != PoseKind::rigged) {
    const PaperAxis axis = pose == PoseKind::paper
                               ? paper_axis(fingers[1].mcp, fingers[4].mcp, answer.posed[INDEX_TIP], answer.posed[THUMB_TIP])
                               : PaperAxis{};
    for (int f = 2; f < FINGERS; ++f) {
      const int j = finger_start(f);
      if (pose == PoseKind::articulated) {
        pose_articulated(hand, vessel, fingers[f], f, answer, before[f]);
      } else {
        const FingerPoints rigged{answer.posed[j + 2], answer.posed[j + 3], answer.posed[j + 4]};
        pose_paper(hand, vessel, fingers[f], f, rigged, axis, answer, before[f]);
      }
    }
  }
  // what the posed hand touches, and how deep
  const Real scale = closing.placement.scale;
  Real judged_depth = examine_pose(hand, vessel, pose, wanted, scale, before, answer);
  if (hand.between > 0) judged_depth = std::max(judged_depth, examine_between(hand, vessel, pose, scale, answer));
  if (judged_depth <= hand.depth_limit) answer.status |= STATUS_PLAUSIBLE;
  if (hand.between > 0) {
    answer.self_depth = digits_overlap(hand, answer.posed, scale);
    if (answer.self_depth > hand.depth_limit)
      answer.status = (answer.status | STATUS_SELF_OVERLAP) & ~std::uint32_t(STATUS_PLAUSIBLE);
  }
  if (vessel.on_table) examine_table(hand, vessel, closing.placement, answer);
}

void evaluate_grip(const Hand& hand, const Vessel& vessel, PoseKind pose, Grip grip, Real friction, Wanted wanted,
                   GripAnswer& answer) {
  const Closing closing = close_fingers(hand, vessel, grip);
  if (closing.reason == REASON_NONE) {
    rest_hand(hand, vessel, pose, closing, friction, wanted, answer);
    if (vessel.arm.azimuths == 0) return;
    answer.wrist = find_wrist(vessel, closing.placement, grip.azimuth);
    if (answer.wrist.share > 1) answer.status = (answer.status | STATUS_BEYOND_WRIST) & ~std::uint32_t(STATUS_PLAUSIBLE);
    return;
  }
  answer = GripAnswer{};
  answer.closing = closing;
  answer.status = static_cast<std::uint32_t>(closing.reason);
}

}  // namespace CORE_NS
