// SPDX-License-Identifier: MIT
#include "live/workspace.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace wholehand {

using core_f64::Mat3;
using core_f64::Vec3;

Vec3 to_vec3(const Triple& v) { return {v[0], v[1], v[2]}; }
Triple to_triple(Vec3 v) { return {v.x, v.y, v.z}; }
// glm stores columns
Mat3 to_mat3(const Rotation& r) { return Mat3(r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]); }
Rotation to_rotation(const Mat3& m) { return {m[0].x, m[1].x, m[2].x, m[0].y, m[1].y, m[2].y, m[0].z, m[1].z, m[2].z}; }

Workspace::Workspace(const Scene& scene, std::array<double, 2> device_gap, std::array<double, 2> hand_gap)
    : origin_(to_vec3(scene.device.origin)),
      scale_(scene.device.workspace_scale),
      is_mirrored_(scene.hand.handedness == Handedness::left),
      clutch_(scene.device.clutch_button),
      device_gap_(scene.device.has_gap ? scene.device.gap : device_gap),
      hand_gap_(hand_gap) {
  if (!(device_gap_[0] < device_gap_[1])) throw usage_error("the device tells no range of its gap; say it in [device] gap_mm");
  slope_ = (hand_gap_[1] - hand_gap_[0]) / (device_gap_[1] - device_gap_[0]);
  for (int k = 0; k < 3; ++k) {
    const std::string& axis = scene.device.axes[k];
    Vec3 along(0);
    along[axis.back() - 'x'] = axis[0] == '-' ? -1 : 1;
    axes_[k] = along;
  }
}

HandPose Workspace::map(const GripperState& state) noexcept {
  const Mat3 turned = axes_ * to_mat3(state.rotation);
  HandPose pose;
  pose.rotation = across(turned);
  const Vec3 place = across(origin_ + scale_ * (axes_ * to_vec3(state.position)));
  const bool pressed = clutch_ >= 0 && (state.buttons >> clutch_ & 1u) != 0;
  if (pressed && !is_clutched_) held_ = place + offset_;
  if (pressed) offset_ = held_ - place;
  is_clutched_ = pressed;
  pose.middle = place + offset_;
  const double within = std::clamp(state.gap, device_gap_[0], device_gap_[1]);
  pose.gap = std::clamp(hand_gap_[0] + slope_ * (within - device_gap_[0]), hand_gap_[0], hand_gap_[1]);
  return pose;
}

GripperState Workspace::unmap(const HandPose& pose) const noexcept {
  const Mat3 back = glm::transpose(axes_);
  GripperState state;
  state.position = to_triple((1 / scale_) * (back * (across(pose.middle) - origin_)));
  state.rotation = to_rotation(back * across(pose.rotation));
  state.gap = device_gap_[0] + (std::clamp(pose.gap, hand_gap_[0], hand_gap_[1]) - hand_gap_[0]) / slope_;
  return state;
}

Triple Workspace::to_device(Vec3 force) const noexcept { return to_triple(glm::transpose(axes_) * across(force)); }

Vec3 Workspace::to_world(const Triple& force) const noexcept { return across(axes_ * to_vec3(force)); }

Vec3 Workspace::across(Vec3 v) const noexcept { return is_mirrored_ ? Vec3(-v.x, v.y, v.z) : v; }

Mat3 Workspace::across(const Mat3& rotation) const noexcept {
  if (!is_mirrored_) return rotation;
  const Mat3 mirror(-1, 0, 0, 0, 1, 0, 0, 0, 1);
  return mirror * rotation * mirror;
}

double coupling_slope(double workspace_scale, double gap_slope) { return std::max(2 * workspace_scale, gap_slope); }

double minimum_jerk(double t) {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

}  // namespace wholehand
