// SPDX-License-Identifier: MIT
#include "device/session/grip_of_tips.h"

#include <algorithm>
#include <cmath>

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec3;

// Inverse of kernels 2 and 3's frame (core/closure.cpp): the line is nearest to the axis at the grip's height, and at roll 0 the
// little finger's side, which is against the gripper's second axis, is below it.
std::optional<GripInput> grip_of_tips(const std::array<Vec3, 2>& tips, const Mat3& axes) {
  const Vec3 apart = tips[1] - tips[0];
  const double gap = glm::length(apart);
  const Vec3 d = gap > 1e-9 ? apart / gap : axes[0];
  const double level = std::hypot(d.x, d.z);
  if (level < DEGENERATE_SINE_F64) return std::nullopt;
  const Vec3 middle = 0.5 * (tips[0] + tips[1]);
  const Vec3 nearest = middle - ((middle.x * d.x + middle.z * d.z) / (level * level)) * d;
  GripInput grip;
  grip.height = nearest.y;
  grip.azimuth = std::atan2(-d.z, d.x);
  grip.obliquity = std::asin(std::clamp(d.y, -1.0, 1.0));
  grip.offset = (-d.z * nearest.x + d.x * nearest.z) / level;
  const Vec3 down = (Vec3(0, -1, 0) + d.y * d) / level;
  grip.roll = std::atan2(glm::dot(-axes[1], glm::cross(d, down)), glm::dot(-axes[1], down));
  return grip;
}

}  // namespace wholehand::device
