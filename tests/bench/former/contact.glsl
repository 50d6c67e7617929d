// SPDX-License-Identifier: MIT
// As of commit 289a04a, a twin of core/contact.cpp.
#ifndef CONTACT_GLSL
#define CONTACT_GLSL

#include "sdf.glsl"

struct Contact {
  Real separation;
  Vec3 proxy;
  bool settled;
};

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

Contact contact_at(Vec3 p, Real radius) {
  Contact contact;
  contact.separation = separation_at(p, radius);
  contact.proxy = p;
  contact.settled = true;
  if (contact.separation < Real(0)) contact.proxy = proxy_of(p, radius, contact.settled);
  return contact;
}

#endif
