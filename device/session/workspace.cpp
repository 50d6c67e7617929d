// SPDX-License-Identifier: MIT
#include "device/session/workspace.h"

#include <algorithm>
#include <cmath>

#include "base/text/error.h"
#include "core/vectors.h"

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec3;

Workspace::Workspace(const Scene& scene, std::array<double, 2> device_gap, std::array<double, 2> hand_gap)
    : origin_(to_vec3(scene.device.origin)),
      scale_(scene.device.workspace_scale),
      mirror_(scene.hand.handedness),
      side_(scene.hand.handedness == Handedness::left ? -1 : 1),
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
  pose.rotation = mirror_(turned);
  const Vec3 place = mirror_(origin_ + scale_ * (axes_ * to_vec3(state.position)));
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
  state.position = to_triple((1 / scale_) * (back * (mirror_(pose.middle) - origin_)));
  state.rotation = to_rotation(back * mirror_(pose.rotation));
  state.gap = device_gap_[0] + (std::clamp(pose.gap, hand_gap_[0], hand_gap_[1]) - hand_gap_[0]) / slope_;
  return state;
}

Triple Workspace::to_device(Vec3 force) const noexcept { return to_triple(glm::transpose(axes_) * mirror_(force)); }

Vec3 Workspace::to_world(const Triple& force) const noexcept { return mirror_(axes_ * to_vec3(force)); }

double coupling_slope(double workspace_scale, double gap_slope) { return std::max(2 * workspace_scale, gap_slope); }

double minimum_jerk(double t) {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

}  // namespace wholehand::device
