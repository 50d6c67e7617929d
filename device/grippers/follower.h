// SPDX-License-Identifier: MIT
// Follows a jumping goal smoothly: turns a mouse's sixty steps a second into motion at the rate of a force loop.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/real.h"

namespace wholehand::device {

// How fast something follows.
struct Pace {
  double rate = 60;  // r, 1/s: the follower lags 2 / r behind a goal in uniform motion
  double speed = 1;  // largest speed, units per second
};

// The move of the next `seconds` towards a goal that rests meanwhile, from `offset` = place - goal; `velocity` goes with it. A critically damped
// spring, x'' = -2 r x' - r^2 x, solved exactly, so that an offset does not overshoot and any number of steps ends where one does:
//   x(t) = (x + (v + r x) t) e^(-rt),   v(t) = (v - r (v + r x) t) e^(-rt).
// The offset counts for 2 speed / r at most. With |v| <= speed before, it is so at any time after: the two terms of v(t) are at most
// e^(-s) (|1 - s| + 2 s) speed, s = rt, and that factor is never above 1. So no move is longer than speed * seconds either.
template <class V>
V follow(V offset, V& velocity, const Pace& pace, double seconds) noexcept {
  const double far = glm::length(offset), most = 2 * pace.speed / pace.rate;
  const V from = far > most ? (most / far) * offset : offset;
  const double s = pace.rate * seconds, kept = std::exp(-s);
  const V push = velocity + pace.rate * from;
  const V move = std::expm1(-s) * from + (kept * seconds) * push;
  velocity = kept * (velocity - s * push);
  return move;
}

}  // namespace wholehand::device
