// SPDX-License-Identifier: MIT
// Efforts for a held vessel at tilts still ahead.
#pragma once

#include <array>
#include <optional>

#include "device/session/hand_view.h"

namespace wholehand::device {

// One tilt, and the least effort there of the whole hand, as shares of its strength (infinite: no force holds the vessel): tilted further over the
// side to which the vessel leans, and over the opposite one.
struct TiltAhead {
  double tilt = 0;  // rad
  double effort = 0, other = 0;
};

constexpr double AHEAD_STEP = radians(10);   // between two tilts
constexpr double MOST_AHEAD = radians(150);  // the last one
constexpr double LEFT_AS_EMPTY = 0.05;       // of the liquid: a vessel with less left counts as empty
constexpr double LEANS_FROM = radians(5);    // a vessel tilted less has no side yet: it takes the one to which the scene pours
constexpr std::size_t TILTS_AHEAD = 16;

// Whole tens of degrees from the present tilt on, up to the first at which at most LEFT_AS_EMPTY of the present liquid is left, or to MOST_AHEAD.
// What pours on the way no longer weighs.
struct TiltsAhead {
  std::array<TiltAhead, TILTS_AHEAD> tilts{};
  std::size_t count = 0;

  // The tilt of the largest effort on the side to which the vessel leans; null if there is none.
  const TiltAhead* hardest() const;
  // The largest effort over the other side.
  double other_worst() const;
};

// For a tick with a held vessel; `hand` is the posture of that tick. Nothing if nothing is held or the scene has no strengths.
std::optional<TiltsAhead> tilts_ahead(const LiveScene& live, const Tick& tick, const std::array<Triple, JOINT_COUNT>& posed);

}  // namespace wholehand::device
