// SPDX-License-Identifier: MIT
// Twin of core/wrist.cpp.
#ifndef WRIST_GLSL
#define WRIST_GLSL

#include "table.glsl"
#include "trig.glsl"

// Without azimuths the scene has no arm, and nothing of this kernel is compiled.
layout(constant_id = CONST_ARM) const int HOLDER_AZIMUTHS = 0;

struct ArmReach {
  Vec3 along, low, aside;
  Real straight, bent;
};

struct Wrist {
  Real flexion, deviation, pronation, share;
};

Real range_share(Real angle, Real most, Real least) { return angle >= Real(0) ? angle / most : -angle / least; }

ArmReach reach_wrist(Vec3 wrist, Vec3 shoulder, Vec3 side) {
  Vec3 line = wrist - shoulder;
  Real distance = length(line);
  ArmReach reach;
  reach.along = distance > DEGENERATE_SINE ? line / distance : Vec3(0, -1, 0);
  Vec3 aside_raw = side - dot(side, reach.along) * reach.along;
  Real off = length(aside_raw);
  reach.aside = off > DEGENERATE_SINE ? aside_raw / off : Vec3(-reach.along.z, Real(0), reach.along.x);
  reach.low = cross(reach.along, reach.aside);
  Real apart = max(distance, DEGENERATE_SINE);
  Real cosine_raw =
      (apart * apart + scene.forearm * scene.forearm - scene.upper_arm * scene.upper_arm) / (Real(2) * apart * scene.forearm);
  reach.straight = clamp(cosine_raw, Real(-1), Real(1));
  reach.bent = sqrt(Real(1) - reach.straight * reach.straight);
  return reach;
}

void ease_wrist(Mat3 rotation, Vec3 wrist, ArmReach reach, Real raised, inout Wrist best) {
  Vec3 bend_raw = (Real(1) - raised) * reach.low + raised * reach.aside;
  Vec3 bend = bend_raw / length(bend_raw);
  Vec3 forearm = reach.straight * reach.along - reach.bent * bend;
  Wrist found = Wrist(Real(0), Real(0), Real(0), Real(0));
  if (ON_TABLE) {
    Vec3 elbow = wrist - scene.forearm * forearm;
    Real depth = max(depth_in_table(wrist, scene.wrist_radius), depth_in_table(elbow, scene.elbow_radius));
    if (depth > Real(0)) found.share = Real(1) + depth / scene.elbow_radius;
    if (!(found.share < best.share)) return;
  }
  found.deviation = HALF_PI - arc_cosine(-dot(rotation[0], forearm));
  found.share = max(found.share, range_share(found.deviation, scene.ulnar, scene.radial));
  if (!(found.share < best.share)) return;
  Vec3 below = reach.bent * reach.along + reach.straight * bend, hinge = cross(reach.along, bend);
  found.flexion = direction_angle(dot(rotation[1], forearm), -dot(rotation[2], forearm));
  found.pronation = direction_angle(-dot(rotation[0], hinge), dot(rotation[0], below));
  found.share = max(found.share, range_share(found.flexion, scene.flexion, scene.extension));
  found.share = max(found.share, range_share(found.pronation, scene.pronation, scene.supination));
  if (found.share < best.share) best = found;
}

Wrist find_wrist(Placement placement, Real azimuth) {
  Real from = HOLDER_AZIMUTHS > 1 ? azimuth : Real(0);
  Wrist best = Wrist(Real(0), Real(0), Real(0), NO_DISTANCE);
  [[dont_unroll]] for (int k = 0; k < HOLDER_AZIMUTHS; ++k) {
    Real s, c;
    sine_cosine(Real(4) * HALF_PI * Real(k) / Real(HOLDER_AZIMUTHS) - from, s, c);
    Vec3 shoulder =
        Vec3(c * scene.shoulder_x - s * scene.shoulder_z, scene.shoulder_y, s * scene.shoulder_x + c * scene.shoulder_z);
    ArmReach reach = reach_wrist(placement.translation, shoulder, Vec3(c, Real(0), s));
    [[dont_unroll]] for (int i = 0; i < ARM_RAISES; ++i)
      ease_wrist(placement.rotation, placement.translation, reach, Real(i) / Real(ARM_RAISES - 1), best);
  }
  return best;
}

#endif
