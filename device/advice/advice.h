// SPDX-License-Identifier: MIT
// Advice to a hand in a session: how it would hold the vessel from its present place, and which grip within reach would be better.
#pragma once

#include <cstdint>
#include <optional>

#include "core/result.h"
#include "device/session/tilts_ahead.h"

namespace wholehand::device {

// A grip of a vessel with its present liquid, over all tilts until it is poured. Rated by the core in double precision, whatever found it.
struct RatedGrip {
  GripInput grip;            // vessel frame, in the world of the scene
  bool is_possible = false;  // feasible, and if advised also plausible; else the members below have no meaning
  double effort = 0;         // the worst, as a share of the hand's strength; infinite: at some tilt no force holds it
  double tilt = 0;           // tilt of the worst effort, rad
};

struct Advice {
  std::int64_t tick = 0;  // of the moment in question
  int vessel = -1;        // -1: no vessel is near, and the other members have no meaning
  bool is_held = false;
  Handedness handedness = Handedness::right;  // of the hand
  Rotation rotation{NO_ROTATION};             // of the vessel, to the world
  double volume = 0;                          // m3 of liquid in it when the grips were rated
  RatedGrip present;                          // the grip that the hand would have, or has
  std::optional<RatedGrip> best;              // absent: no grip within reach is possible
  GripResult posed;                           // of the best one, vessel frame
  bool is_better = false;           // the best one takes clearly less effort than the present one, or the latter is not possible
  std::optional<TiltsAhead> ahead;  // of a held vessel
  std::uint64_t grips = 0;          // that were asked for
};

}  // namespace wholehand::device
