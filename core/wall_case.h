// SPDX-License-Identifier: MIT
// A rendered wall to test: plain numbers, SI.
#pragma once

namespace wholehand {

constexpr int LOOP_DELAYS = 4;  // largest delay of a haptic loop, in whole samples
constexpr int LOOP_STOPS = 4;   // reversals within a sample for which friction is followed

// How the motion between two samples is integrated.
constexpr int LOOP_EXACT = 0;
constexpr int LOOP_EULER = 1;          // explicit, at equal sub-steps
constexpr int LOOP_SEMI_IMPLICIT = 2;  // the place by the new speed

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
