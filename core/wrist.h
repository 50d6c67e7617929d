// SPDX-License-Identifier: MIT
// Kernel 11: what a grip asks of the wrist and the forearm of the person who takes it.
#pragma once

#include "core/closure.h"

namespace CORE_NS {

// How an arm reaches its wrist, wherever its elbow is. Unit vectors, square to each other.
struct ArmReach {
  Vec3 along{};     // from the shoulder to the wrist
  Vec3 low{};       // from that line to the elbow where the arm hangs,
  Vec3 aside{};     // and where it is raised to the side
  Real straight{};  // cosine and sine of the angle between the forearm and `along`
  Real bent{};
};

// Angles of a wrist, rad, and the largest share of its range that one of them takes; above 1: beyond.
struct Wrist {
  Real flexion = 0;    // to the palm; below 0: extension
  Real deviation = 0;  // to the little finger's side (ulnar); below 0: radial
  Real pronation = 0;  // the palm turns down from where the thumb is up; below 0: supination
  Real share = NO_DISTANCE;
};

// The share of a range that an angle takes: of `most` above 0, of `least` below. rad.
Real range_share(Real angle, Real most, Real least);
// How an arm reaches with its shoulder at `shoulder`, whose elbow is raised towards `side` (unit). An arm that is too short is straight, as the
// holder leans. m.
ArmReach reach_wrist(const Vessel& vessel, Vec3 wrist, Vec3 shoulder, Vec3 side);
// Takes the place of `best` if the wrist of a hand with the axes `rotation` has a smaller share where the elbow is `raised`: 0 low, 1 at
// the side. A forearm that reaches `depth` below the table counts as 1 + depth / elbow_radius at least.
void ease_wrist(const Vessel& vessel, Mat3 rotation, Vec3 wrist, ArmReach reach, Real raised, Wrist& best);
// The whole kernel: the least share over all places of the elbow, and over the holder's azimuths, which are counted from that of the grip, rad. Only
// of a vessel with an arm.
Wrist find_wrist(const Vessel& vessel, const Placement& placement, Real azimuth);

}  // namespace CORE_NS
