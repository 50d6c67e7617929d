// SPDX-License-Identifier: MIT
// Twin of core/body.cpp.
#ifndef BODY_GLSL
#define BODY_GLSL

#include "real.glsl"

// Spheres on a bone between its joints; 0: nothing of this kernel is compiled.
layout(constant_id = CONST_BETWEEN) const int BETWEEN = 0;

struct Ball {
  Vec3 place;
  Real radius;
};

Ball ball_between(Vec3 start, Vec3 end, Real start_radius, Real end_radius, Real share) {
  precise Vec3 place = start + share * (end - start);
  return Ball(place, start_radius + share * (end_radius - start_radius));
}

Real nearest_share(Real x) {
  if (!(x > Real(0))) return Real(0);
  return min(x, Real(1));
}

Real bones_overlap(Vec3 a, Vec3 a_end, Vec2 a_radii, Vec3 b, Vec3 b_end, Vec2 b_radii) {
  Vec3 u = a_end - a, v = b_end - b, r = a - b;
  Real uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
  Real s = nearest_share((uv * vr - ur * vv) / (uu * vv - uv * uv));
  Real t_on_line = (uv * s + vr) / vv;
  Real t = nearest_share(t_on_line);
  if (!(t_on_line == t)) s = nearest_share((uv * t - ur) / uu);
  Real apart = length(r + s * u - t * v);
  Real a_radius = a_radii.x + s * (a_radii.y - a_radii.x);
  Real b_radius = b_radii.x + t * (b_radii.y - b_radii.x);
  return a_radius + b_radius - apart;
}

#endif
