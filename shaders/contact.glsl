// SPDX-License-Identifier: MIT
// Twin of core/contact.cpp.
#ifndef CONTACT_GLSL
#define CONTACT_GLSL

#include "sdf.glsl"

Real separation_at(Vec3 p, Real radius) { return signed_distance(p) - radius; }

Vec3 proxy_of(Vec3 p, Real radius, out bool settled) {
  Vec3 proxy = p;
  settled = false;
  for (int step = 0; step < PROXY_STEPS; ++step) {
    Real separation = separation_at(proxy, radius);
    if (abs(separation) < STOP_TOLERANCE) {
      settled = true;
      return proxy;
    }
    int element;
    proxy -= separation * distance_gradient(proxy, element);
  }
  settled = abs(separation_at(proxy, radius)) < STOP_TOLERANCE;
  return proxy;
}

bool is_undecided(Vec3 p, Real separation, Real tolerance) {
  bool is_at_edge = p.y > scene.lid_height && abs(sqrt(p.x * p.x + p.z * p.z) - scene.lid_radius) <= CONTACT_MARGIN;
  return abs(separation - tolerance) <= CONTACT_MARGIN || (separation <= tolerance && is_at_edge);
}

#endif
