// SPDX-License-Identifier: MIT
#include "core/body.h"

#include <algorithm>

namespace CORE_NS {

Ball ball_between(Vec3 start, Vec3 end, Real start_radius, Real end_radius, Real share) {
  return {start + share * (end - start), start_radius + share * (end_radius - start_radius)};
}

Ball around_bone(Ball start, Ball end) {
  return {Real(0.5) * (start.place + end.place),
          Real(0.5) * glm::length(end.place - start.place) + std::max(start.radius, end.radius)};
}

bool overlap_more(Ball a, Ball b, Real deepest) {
  const Vec3 apart = a.place - b.place;
  const Real reach = std::max(a.radius + b.radius - deepest, Real(0));
  return glm::dot(apart, apart) < reach * reach;
}

Real nearest_share(Real x) {
  if (!(x > 0)) return 0;
  return std::min(x, Real(1));
}

// The shares s and t along the two axes minimize |a + s u - b - t v|: first s on the two lines, then the matching t, and if t leaves its bone, the s
// that matches that end. If the axes are parallel, s is arbitrary, and radii that vary along a bone would make the answer depend on rounding. So the
// ends are evaluated too: the overlap is largest at one of them, unless the least distance of the axes shows that no place can matter.
Real bones_overlap(Vec3 a, Vec3 a_end, Vec2 a_radii, Vec3 b, Vec3 b_end, Vec2 b_radii, Real deepest) {
  const Vec3 u = a_end - a, v = b_end - b, r = a - b;
  const Real uu = glm::dot(u, u), vv = glm::dot(v, v);
  const Real largest = std::max(a_radii.x, a_radii.y) + std::max(b_radii.x, b_radii.y);
  const Real uv = glm::dot(u, v), ur = glm::dot(u, r), vr = glm::dot(v, r);
  const auto along_a = [&](Real t) { return nearest_share((uv * t - ur) / uu); };
  const auto along_b = [&](Real s) { return nearest_share((uv * s + vr) / vv); };
  const auto apart = [&](Real s, Real t) { return glm::length(r + s * u - t * v); };
  const auto radii = [&](Real s, Real t) {
    return a_radii.x + s * (a_radii.y - a_radii.x) + b_radii.x + t * (b_radii.y - b_radii.x);
  };
  Real s = nearest_share((uv * vr - ur * vv) / (uu * vv - uv * uv));
  const Real t_on_line = (uv * s + vr) / vv;
  const Real t = nearest_share(t_on_line);
  if (!(t_on_line == t)) s = along_a(t);
  const Real least = apart(s, t);
  deepest = std::max(deepest, radii(s, t) - least);
  if (!(largest - least > deepest)) return deepest;
  for (const Real end : {Real(0), Real(1)}) {
    const Real beside_a = along_b(end), beside_b = along_a(end);
    deepest = std::max(deepest, radii(end, beside_a) - apart(end, beside_a));
    deepest = std::max(deepest, radii(beside_b, end) - apart(beside_b, end));
  }
  return deepest;
}

}  // namespace CORE_NS
