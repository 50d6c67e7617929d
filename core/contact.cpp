// SPDX-License-Identifier: MIT
#include "core/contact.h"

#include <cmath>

namespace CORE_NS {

Real separation_at(const Vessel& vessel, Vec3 p, Real radius) { return signed_distance(vessel, p) - radius; }

// One step lands on the surface where the distance is exact and the nearest feature unique. Degenerate: on the medial axis the
// first feature in outline order is taken, so two evaluations may choose walls a thickness apart.
Vec3 proxy_of(const Vessel& vessel, Vec3 p, Real radius, bool& settled) {
  Vec3 proxy = p;
  settled = false;
  for (int step = 0; step < PROXY_STEPS; ++step) {
    const Real separation = separation_at(vessel, proxy, radius);
    if (std::abs(separation) < vessel.limits.stop_tolerance) {
      settled = true;
      return proxy;
    }
    int element = -1;
    proxy -= separation * distance_gradient(vessel, proxy, element);
  }
  settled = std::abs(separation_at(vessel, proxy, radius)) < vessel.limits.stop_tolerance;
  return proxy;
}

// The lid begins at the mouth's edge, where the wall ends.
bool is_undecided(const Vessel& vessel, Vec3 p, Real separation, Real tolerance) {
  if (std::abs(separation - tolerance) <= Real(CONTACT_MARGIN)) return true;
  if (vessel.lid < 0 || separation > tolerance) return false;
  const Vec2 edge = vessel.outline[vessel.lid].a;
  return p.y > edge.y && std::abs(std::sqrt(p.x * p.x + p.z * p.z) - edge.x) <= Real(CONTACT_MARGIN);
}

}  // namespace CORE_NS
