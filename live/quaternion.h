// SPDX-License-Identifier: MIT
// Turns as four numbers, for those that take no matrix.
#pragma once

#include <array>
#include <glm/gtc/quaternion.hpp>

#include "live/workspace.h"

namespace wholehand {

using Quaternion = std::array<double, 4>;  // x, y, z, w, as glTF orders it; unit

// Unit, of what is a rotation but for rounding.
inline glm::dquat to_quat(const core_f64::Mat3& rotation) { return glm::normalize(glm::quat_cast(rotation)); }
inline Quaternion quaternion_of(const core_f64::Mat3& rotation) {
  const glm::dquat q = to_quat(rotation);
  return {q.x, q.y, q.z, q.w};
}
inline Quaternion quaternion_of(const Rotation& rotation) { return quaternion_of(to_mat3(rotation)); }

}  // namespace wholehand
