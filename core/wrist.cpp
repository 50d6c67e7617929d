// SPDX-License-Identifier: MIT
#include "core/wrist.h"

#include <algorithm>
#include <cmath>

#include "core/table.h"
#include "core/trig.h"

namespace CORE_NS {

Real range_share(Real angle, Real most, Real least) { return angle >= 0 ? angle / most : -angle / least; }

// Upper arm, forearm and the line from shoulder to wrist are a triangle, and the elbow lies on a circle about the line. With the lengths D of
// the line, U of the upper arm and F of the forearm, the forearm is at the angle a to the line: cos a = (D^2 + F^2 - U^2) / (2 D F).
// Degenerate: a wrist at the shoulder hangs from it, and an arm that points along `side` has its elbow in front.
ArmReach reach_wrist(const Vessel& vessel, Vec3 wrist, Vec3 shoulder, Vec3 side) {
  const Arm& arm = vessel.arm;
  const Vec3 line = wrist - shoulder;
  const Real distance = glm::length(line);
  ArmReach reach;
  reach.along = distance > DEGENERATE_SINE ? line / distance : Vec3(0, -1, 0);
  const Vec3 aside_raw = side - glm::dot(side, reach.along) * reach.along;
  const Real off = glm::length(aside_raw);
  reach.aside = off > DEGENERATE_SINE ? aside_raw / off : Vec3(-reach.along.z, 0, reach.along.x);
  reach.low = glm::cross(reach.along, reach.aside);
  const Real apart = std::max(distance, Real(DEGENERATE_SINE));
  const Real cosine_raw =
      (apart * apart + arm.forearm * arm.forearm - arm.upper_arm * arm.upper_arm) / (Real(2) * apart * arm.forearm);
  reach.straight = std::clamp(cosine_raw, Real(-1), Real(1));
  reach.bent = std::sqrt(Real(1) - reach.straight * reach.straight);
  return reach;
}

// The forearm's own frame is `forearm`, `below` and `hinge`: with the thumb up the little finger's side is below, in the plane of the
// elbow. The forearm seen from the hand is (sin b, cos b sin a, -cos b cos a) with the flexion a and the ulnar deviation -b, and the
// hand's x axis less its part along the forearm is where the pronation has turned `below` to.
void ease_wrist(const Vessel& vessel, Mat3 rotation, Vec3 wrist, ArmReach reach, Real raised, Wrist& best) {
  const Arm& arm = vessel.arm;
  const Vec3 bend_raw = (Real(1) - raised) * reach.low + raised * reach.aside;
  const Vec3 bend = bend_raw / glm::length(bend_raw);
  const Vec3 forearm = reach.straight * reach.along - reach.bent * bend;
  Wrist found;
  found.share = 0;
  if (vessel.on_table) {
    const Vec3 elbow = wrist - arm.forearm * forearm;
    const Real depth = std::max(depth_in_table(vessel, wrist, arm.wrist_radius), depth_in_table(vessel, elbow, arm.elbow_radius));
    if (depth > 0) found.share = Real(1) + depth / arm.elbow_radius;
    if (!(found.share < best.share)) return;
  }
  found.deviation = HALF_PI - arc_cosine(-glm::dot(rotation[0], forearm));
  found.share = std::max(found.share, range_share(found.deviation, arm.ulnar, arm.radial));
  if (!(found.share < best.share)) return;
  const Vec3 below = reach.bent * reach.along + reach.straight * bend, hinge = glm::cross(reach.along, bend);
  found.flexion = direction_angle(glm::dot(rotation[1], forearm), -glm::dot(rotation[2], forearm));
  found.pronation = direction_angle(-glm::dot(rotation[0], hinge), glm::dot(rotation[0], below));
  found.share = std::max(found.share, range_share(found.flexion, arm.flexion, arm.extension));
  found.share = std::max(found.share, range_share(found.pronation, arm.pronation, arm.supination));
  if (found.share < best.share) best = found;
}

// Taking a body of revolution from another side equals turning the holder about its axis. Turns count from the grip's azimuth, so that this changes
// nothing for such a body.
Wrist find_wrist(const Vessel& vessel, const Placement& placement, Real azimuth) {
  const Arm& arm = vessel.arm;
  const Real from = arm.azimuths > 1 ? azimuth : Real(0);
  Wrist best;
  for (int k = 0; k < arm.azimuths; ++k) {
    Real s = 0, c = 0;
    sine_cosine(Real(4) * HALF_PI * Real(k) / Real(arm.azimuths) - from, s, c);
    const Vec3 shoulder(c * arm.shoulder.x - s * arm.shoulder.z, arm.shoulder.y, s * arm.shoulder.x + c * arm.shoulder.z);
    const ArmReach reach = reach_wrist(vessel, placement.translation, shoulder, Vec3(c, 0, s));
    for (int i = 0; i < ARM_RAISES; ++i)
      ease_wrist(vessel, placement.rotation, placement.translation, reach, Real(i) / Real(ARM_RAISES - 1), best);
  }
  return best;
}

}  // namespace CORE_NS
