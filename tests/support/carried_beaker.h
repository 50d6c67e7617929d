// SPDX-License-Identifier: MIT
// A short session for whatever carries it: a gripper closes on a beaker, lifts it, tilts it and lets go.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene.h"
#include "device/session/tick.h"
#include "tests/support/scenes.h"

namespace wholehand {

// beaker1 at the origin, held by a device whose gap is 0 to 25 mm.
inline Scene carried_scene(double rate) {
  Scene scene = scene_of({beaker1()});
  scene.device.has_gap = true;
  scene.device.gap = {0, 25e-3};
  scene.live.rate = rate;
  scene.live.slip = 3e-3;
  return scene;
}

constexpr double CARRY_LASTS = 3.2;  // s

// Where the gripper is at a time, s: open until 0.4, closed on the glass from 0.8, up by 1.4, tilted by 40 degrees by 2.2, open
// again by 2.8.
// Device frame, the tips' middle at half of the beaker's height.
inline device::GripperState carried_state(double time) {
  const auto part = [time](double from, double to) {
    const double s = std::clamp((time - from) / (to - from), 0.0, 1.0);
    return s * s * (3 - 2 * s);
  };
  constexpr double OPEN = 24e-3, CLOSED = 15e-3;  // of 25 mm: 124 and 82 mm of the hand's gap
  device::GripperState state;
  state.position = {0, 0.055 + 0.06 * part(0.9, 1.4), 0};
  state.gap = OPEN - (OPEN - CLOSED) * (part(0.4, 0.8) - part(2.4, 2.8));
  const double tilt = radians(40) * (part(1.5, 2.2) - part(2.3, 2.8));
  const double c = std::cos(tilt), s = std::sin(tilt);
  state.rotation = {1, 0, 0, 0, c, s, 0, -s, c};
  return state;
}

}  // namespace wholehand
