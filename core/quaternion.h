// SPDX-License-Identifier: MIT
// Rotations as quaternions, for interfaces that take no matrix.
#pragma once

#include <array>
#include <glm/gtc/quaternion.hpp>

#include "core/vectors.h"

namespace wholehand {

using Quaternion = std::array<double, 4>;  // x, y, z, w, as glTF orders it; unit

// Unit quaternion of a matrix that is a rotation up to rounding.
inline glm::dquat to_quat(const glm::dmat3& rotation) { return glm::normalize(glm::quat_cast(rotation)); }
inline glm::dquat to_quat(const Quaternion& q) { return glm::dquat(q[3], q[0], q[1], q[2]); }  // glm takes w first
inline Quaternion to_quaternion(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }
inline Quaternion quaternion_of(const glm::dmat3& rotation) { return to_quaternion(to_quat(rotation)); }
inline Quaternion quaternion_of(const Rotation& rotation) { return quaternion_of(to_mat3(rotation)); }

}  // namespace wholehand
