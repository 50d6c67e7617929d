// SPDX-License-Identifier: MIT
#include "core/body.h"

#include <algorithm>

namespace CORE_NS {

Ball ball_between(Vec3 start, Vec3 end, Real start_radius, Real end_radius, Real share) {
  return {start + share * (end - start), start_radius + share * (end_radius - start_radius)};
}

Real nearest_share(Real x) {
  if (!(x > 0)) return 0;
  return std::min(x, Real(1));
}

// The shares s and t of the way along either axis make |a + s u - b - t v| least: first s on the two lines, then the t that belongs to it,
// and where t leaves its bone, the s that belongs to that end. Where axes are parallel, s may be any, and radii that differ along a bone
// would make the answer a matter of rounding: the ends are looked at too, and the overlap is largest at one of them.
Real bones_overlap(Vec3 a, Vec3 a_end, Vec2 a_radii, Vec3 b, Vec3 b_end, Vec2 b_radii) {
  const Vec3 u = a_end - a, v = b_end - b, r = a - b;
  const Real uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v), ur = glm::dot(u, r), vr = glm::dot(v, r);
  const auto overlap = [&](Real s, Real t) {
    return a_radii.x + s * (a_radii.y - a_radii.x) + b_radii.x + t * (b_radii.y - b_radii.x) - glm::length(r + s * u - t * v);
  };
  const auto along_a = [&](Real t) { return nearest_share((uv * t - ur) / uu); };
  const auto along_b = [&](Real s) { return nearest_share((uv * s + vr) / vv); };
  Real s = nearest_share((uv * vr - ur * vv) / (uu * vv - uv * uv));
  const Real t_on_line = (uv * s + vr) / vv;
  const Real t = nearest_share(t_on_line);
  if (!(t_on_line == t)) s = along_a(t);
  const Real of_a_ends = std::max(overlap(0, along_b(0)), overlap(1, along_b(1)));
  const Real of_b_ends = std::max(overlap(along_a(0), 0), overlap(along_a(1), 1));
  return std::max(overlap(s, t), std::max(of_a_ends, of_b_ends));
}

}  // namespace CORE_NS
