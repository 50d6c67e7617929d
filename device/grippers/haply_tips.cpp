// SPDX-License-Identifier: MIT
#include "device/grippers/haply_tips.h"

#include <algorithm>
#include <cmath>

#include "core/vectors.h"

namespace wholehand::device {
namespace {

constexpr double NO_DISTANCE = 1e-6;        // m: less than what an encoder resolves
constexpr double DEGENERATE_SINE = 1e-6;    // of an angle near 0 or 180 degrees
constexpr double DEGENERATE_COSINE = 1e-3;  // 1 + cos of 177.4 degrees

}  // namespace

// Along the great circle: the part of `target` that remains is sin(most) / sin(angle), as in a spherical interpolation.
void ClosingLine::follow(const Triple& between, double seconds) noexcept {
  const double length = norm(between);
  if (!(length > NO_DISTANCE) || !std::isfinite(length)) return;
  const Triple target{between[0] / length, between[1] / length, between[2] / length};
  const double cosine = std::clamp(dot(direction_, target), -1.0, 1.0), angle = std::acos(cosine);
  const double near = std::min(1.0, length / CLEAR), most = TURN * near * near * seconds;
  if (angle <= most) {
    direction_ = target;
    return;
  }
  const double sine = std::sin(angle);
  if (sine < DEGENERATE_SINE) return;
  Triple turned;
  for (std::size_t k = 0; k < 3; ++k) turned[k] = (std::sin(angle - most) * direction_[k] + std::sin(most) * target[k]) / sine;
  const double size = norm(turned);
  for (std::size_t k = 0; k < 3; ++k) direction_[k] = turned[k] / size;
}

// Rodrigues' formula about x × d, whose length is the sine: R = c I + [v] + v v^T / (1 + c) with v = (0, -z, y) and c = x of d = (x, y, z).
Rotation rotation_along(const Triple& direction, const Rotation& previous) noexcept {
  const double x = direction[0], y = direction[1], z = direction[2], scale = 1 + x;
  if (scale < DEGENERATE_COSINE) return previous;
  return {x, -y, -z, y, x + z * z / scale, -y * z / scale, z, -y * z / scale, x + y * y / scale};
}

Triple capped(const Triple& force, double most) noexcept {
  const double size = norm(force);
  if (!(size > most)) return force;
  return {force[0] * most / size, force[1] * most / size, force[2] * most / size};
}

std::array<Triple, 2> tip_forces(const GripperForce& force, const Triple& direction, double most) noexcept {
  std::array<Triple, 2> tips{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double apart = force.grip * direction[k] + force.across[k];
    tips[0][k] = force.arm[k] / 2 - apart;
    tips[1][k] = force.arm[k] / 2 + apart;
  }
  return {capped(tips[0], most), capped(tips[1], most)};
}

}  // namespace wholehand::device
