// SPDX-License-Identifier: MIT
// What a measurement must be. In a session with a loop the guard checks that it is finite and its rotation one; a caller that steps a session by itself
// checks its reach too.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "device/session/tick.h"

namespace wholehand::device {

constexpr std::int64_t LAST_TICK = std::int64_t{1} << 53;  // a time is this number over the rate, as a double
// m: the limit of a scene's points. No arm reaches further, and differences lose their digits there.
constexpr double FURTHEST_POSITION = 25;
constexpr double WIDEST_GAP = 10;  // m, either way
// A tenth of a degree of skew: far more than the rounding of a float, so it means a broken sensor or no rotation at all.
constexpr double ROTATION_TOLERANCE = 1e-3;

// Whether every number in it is finite.
inline bool is_finite(const GripperState& state) {
  const auto is_number = [](double x) { return std::isfinite(x); };
  return std::all_of(state.position.begin(), state.position.end(), is_number) &&
         std::all_of(state.rotation.begin(), state.rotation.end(), is_number) && std::isfinite(state.gap) &&
         std::isfinite(state.time);
}

// Whether a finite measurement is within reach.
inline bool is_in_reach(const GripperState& state) noexcept {
  for (const double x : state.position)
    if (std::abs(x) > FURTHEST_POSITION) return false;
  return std::abs(state.gap) <= WIDEST_GAP;
}

}  // namespace wholehand::device
