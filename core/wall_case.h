// SPDX-License-Identifier: MIT
// A rendered wall to test: plain numbers, for core and device alike; SI.
#pragma once

#include "shaders/layout.h"

namespace wholehand {

struct WallCase {
  double mass = 0.1, damping = 1, spring = 0;  // the plant: device and finger, kg, N s/m, N/m
  double wall_stiffness = 0, wall_damping = 0, period = 1e-3;
  double encoder_step = 0, force_limit = 0;  // 0: none
  int delay = 0;
  bool is_bilateral = false;
  double press = 0, friction = 0, place = 0;  // N, N, m: pressed in, and released at rest there
  int integrator = LOOP_EXACT, substeps = 1;
};

}  // namespace wholehand
