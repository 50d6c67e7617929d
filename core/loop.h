// SPDX-License-Identifier: MIT
// One axis of a sampled haptic loop: a device, with the finger on it, against a rendered wall. Positions count into the wall, which begins at 0;
// positive forces push into it.
#pragma once

#include <array>

#include "core/real.h"
#include "core/wall_case.h"

namespace CORE_NS {

using wholehand::LOOP_DELAYS, wholehand::LOOP_STOPS;
using wholehand::LOOP_EXACT, wholehand::LOOP_EULER, wholehand::LOOP_SEMI_IMPLICIT;

// Device and finger combined: mass x'' + damping x' + stiffness x = force, with the finger's spring at rest at 0.
struct Plant {
  Real mass = 0;       // kg, > 0
  Real damping = 0;    // N s/m
  Real stiffness = 0;  // N/m
};

struct Motion {
  Real place = 0;  // m
  Real speed = 0;  // m/s
};

// The exact motion over a time under a constant force: a matrix and a column.
struct Propagator {
  Real place_place = 1, place_speed = 0, place_force = 0;
  Real speed_place = 0, speed_speed = 1, speed_force = 0;
};

// What the controller renders, once a sample.
struct Wall {
  Real stiffness = 0;         // K, N/m
  Real damping = 0;           // B, N s/m, of the backward difference of the readings
  Real period = 0;            // T, s
  Real encoder_step = 0;      // m, from 1e-12; 0: exact
  Real force_limit = 0;       // N; 0: none
  int delay = 0;              // whole samples, 0..LOOP_DELAYS
  bool is_bilateral = false;  // a spring, which also pulls; else a wall, which only pushes out
};

struct LoopState {
  Motion motion;
  Real reading = 0;                         // of the previous sample, m
  std::array<Real, LOOP_DELAYS> waiting{};  // forces computed but not yet applied, oldest first, N
};

// By scaling and squaring of the series: steps of at most 1/8 of the fastest mode, to the tenth order (3e-16 of a step), doubled.
Propagator propagator(Plant plant, Real time);
// The same by Euler's method with equal sub-steps, explicit or semi-implicit (LOOP_*), to show what an integrator does to the plant.
Propagator stepped_propagator(Plant plant, Real time, int integrator, int substeps);
Motion advance(Propagator by, Motion motion, Real force);
// The same with Coulomb friction (N). The motion is followed to where it stops, at most LOOP_STOPS times in `time`. From there it reverses, or stays
// if the other forces do not overcome the friction. Samples must be no longer than the plant's fastest mode, so that it reverses no more often.
// `whole` is the propagator of `time`.
Motion advance_with_friction(Plant plant, Propagator whole, Motion motion, Real force, Real friction, Real time);
// The nearest multiple of the step.
Real read_encoder(Real place, Real step);
// Force of the wall on the device for a reading and its rate, N: at most 0, unless bilateral.
Real wall_force(Wall wall, Real place, Real rate);
// The state after a long rest there: the wall's delayed forces are queued.
LoopState let_go(Wall wall, Real place);
// One sample: read, render, hold for a period. `press`: the user's constant force into the wall, N.
LoopState step_loop(Plant plant, Propagator by, Wall wall, LoopState state, Real press, Real friction);
// Energy of the motion about the point where wall and finger would hold it at rest, J.
Real loop_energy(Plant plant, Wall wall, Motion motion, Real press);

}  // namespace CORE_NS
