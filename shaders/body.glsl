// SPDX-License-Identifier: MIT
// Twin of core/body.cpp.
#ifndef BODY_GLSL
#define BODY_GLSL

#include "build.glsl"
#include "real.glsl"

// Spheres on a bone between its joints; with 0, nothing of this kernel is compiled.
layout(constant_id = CONST_BETWEEN) const int BETWEEN = 0;

struct Ball {
  Vec3 place;
  Real radius;
};

Ball ball_between(Vec3 start, Vec3 end, Real start_radius, Real end_radius, Real share) {
  precise Vec3 place = start + share * (end - start);
  return Ball(place, start_radius + share * (end_radius - start_radius));
}

Ball around_bone(Ball start, Ball end) {
  return Ball(Real(0.5) * (start.place + end.place),
              Real(0.5) * length(end.place - start.place) + max(start.radius, end.radius));
}

bool overlap_more(Ball a, Ball b, Real deepest) {
  Vec3 apart = a.place - b.place;
  Real reach = max(a.radius + b.radius - deepest, Real(0));
  return dot(apart, apart) < reach * reach;
}

Real nearest_share(Real x) {
  if (!(x > Real(0))) return Real(0);
  return min(x, Real(1));
}

Real bones_overlap(Vec3 a, Vec3 a_end, Vec2 a_radii, Vec3 b, Vec3 b_end, Vec2 b_radii, Real deepest) {
  Vec3 u = a_end - a, v = b_end - b, r = a - b;
  Real uu = dot(u, u), vv = dot(v, v);
  Real largest = max(a_radii.x, a_radii.y) + max(b_radii.x, b_radii.y);
  Real uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
  Real s = nearest_share((uv * vr - ur * vv) / (uu * vv - uv * uv));
  Real t_on_line = (uv * s + vr) / vv;
  Real t = nearest_share(t_on_line);
  if (!(t_on_line == t)) s = nearest_share((uv * t - ur) / uu);
  Real start = a_radii.x + b_radii.x, a_more = a_radii.y - a_radii.x, b_more = b_radii.y - b_radii.x;
  Real least = length(r + s * u - t * v);
  deepest = max(deepest, start + s * a_more + t * b_more - least);
  [[dont_unroll]] for (int end = largest - least > deepest ? 0 : 2; end < 2; ++end) {
    Real share = Real(end), beside_a = nearest_share((uv * share + vr) / vv), beside_b = nearest_share((uv * share - ur) / uu);
    deepest = max(deepest, start + share * a_more + beside_a * b_more - length(r + share * u - beside_a * v));
    deepest = max(deepest, start + beside_b * a_more + share * b_more - length(r + beside_b * u - share * v));
  }
  return deepest;
}

#endif
