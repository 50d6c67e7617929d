// SPDX-License-Identifier: MIT
// Kernel 11: what a grip demands of its holder's wrist and forearm.
#pragma once

#include "core/closure.h"

namespace CORE_NS {

// How an arm reaches its wrist, independent of the elbow's position. Mutually perpendicular unit vectors.
struct ArmReach {
  Vec3 along{};     // from the shoulder to the wrist
  Vec3 low{};       // from that line to the elbow of a hanging arm,
  Vec3 aside{};     // and of one raised to the side
  Real straight{};  // cosine and sine of the angle between the forearm and `along`
  Real bent{};
};

// Angles of a wrist, rad, and the largest used share of a range; above 1: beyond.
struct Wrist {
  Real flexion = 0;    // to the palm; below 0: extension
  Real deviation = 0;  // to the little finger's side (ulnar); below 0: radial
  Real pronation = 0;  // the palm turns down from the thumb-up pose; below 0: supination
  Real share = NO_DISTANCE;
};

// The share of a range that an angle uses: of `most` above 0, of `least` below. rad.
Real range_share(Real angle, Real most, Real least);
// How an arm with its shoulder at `shoulder` reaches, with the elbow raised towards `side` (unit). An arm that is too short is straight, as if the
// holder leaned forward. m.
ArmReach reach_wrist(const Vessel& vessel, Vec3 wrist, Vec3 shoulder, Vec3 side);
// Replaces `best` if the wrist of a hand with the axes `rotation` has a smaller share with the elbow `raised`: 0 low, 1 at the side. A forearm that
// reaches `depth` below the table counts as at least 1 + depth / elbow_radius.
void ease_wrist(const Vessel& vessel, Mat3 rotation, Vec3 wrist, ArmReach reach, Real raised, Wrist& best);
// The whole kernel: the least share over all elbow positions and over the holder's azimuths, which count from the grip's, rad. Only for a vessel with
// an arm.
Wrist find_wrist(const Vessel& vessel, const Placement& placement, Real azimuth);

}  // namespace CORE_NS
