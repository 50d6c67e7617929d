// SPDX-License-Identifier: MIT
#include "device/session/live_hand.h"

#include <algorithm>

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec3;

namespace {

Vec3 normalized_or(Vec3 v, Vec3 otherwise) {
  const double length = glm::length(v);
  return length > 1e-12 ? v / length : otherwise;
}

}  // namespace

// Like place_hand, with the axes given instead of line and roll: at roll 0 the little finger's side is opposite to the gripper's second axis.
core_f64::Placement place_live_hand(const core_f64::Hand& hand, double closure, const Mat3& rotation, Vec3 middle, double scale,
                                    double& e1_x) {
  Vec3 slope{};
  const Vec3 apart = core_f64::tip_to_tip(hand, closure, slope);
  const Vec3 e1 = apart / glm::length(apart);
  e1_x = e1.x;
  const Vec3 e2 = normalized_or(Vec3(1, 0, 0) - e1.x * e1, Vec3(0, 1, 0));
  const Mat3 hand_axes(e1, e2, glm::cross(e1, e2)), gripper_axes(rotation[0], -rotation[1], -rotation[2]);
  core_f64::Placement placement;
  placement.scale = scale;
  placement.rotation = gripper_axes * glm::transpose(hand_axes);
  const Vec3 lengths(hand.length[0][0], hand.length[0][1], hand.length[0][2]);
  const Vec3 thumb = core_f64::thumb_points(hand.frame[0], lengths, core_f64::thumb_angles(hand, closure)).tip;
  placement.translation = middle - placement.rotation * (scale * (thumb + 0.5 * apart));
  return placement;
}

core_f64::Closing close_live_hand(const core_f64::Hand& hand, const std::array<Vec3, 2>& contacts, Vec3 place, const Mat3& rotation,
                                  double& e1_x) {
  const Vec3 apart = contacts[1] - contacts[0];
  core_f64::Closing closing;
  closing.gap = glm::length(apart);
  closing.direction = closing.gap > 1e-12 ? apart / closing.gap : rotation[0];
  closing.midpoint = 0.5 * (contacts[0] + contacts[1]) - place;
  const double gap = std::clamp(closing.gap / hand.scale, hand.gap_closed, hand.gap_open);
  closing.closure = core_f64::closure_of_gap(hand, gap, hand.limits.stop_tolerance / hand.scale);
  const Vec3 up = normalized_or(rotation[1] - glm::dot(rotation[1], closing.direction) * closing.direction, rotation[2]);
  closing.placement = place_live_hand(hand, closing.closure, Mat3(closing.direction, up, glm::cross(closing.direction, up)),
                                      closing.midpoint, hand.scale, e1_x);
  return closing;
}

}  // namespace wholehand::device
