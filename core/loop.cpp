// SPDX-License-Identifier: MIT
#include "core/loop.h"

#include <algorithm>
#include <cmath>

namespace CORE_NS {
namespace {

constexpr int ORDER = 10;        // of the propagator's series
constexpr int DOUBLINGS = 48;    // of its step: 2e12 of the fastest time constants
constexpr int NEWTON_STEPS = 3;  // to where the motion stops

}  // namespace

// x' = A x + B f with A = [0 1; -k/m -b/m], B = [0; 1/m]:
//   Phi(h) = sum (A h)^n / n!,  Gamma(h) = h sum (A h)^n / (n + 1)! B
//   Phi(2h) = Phi(h)^2,  Gamma(2h) = Gamma(h) + Phi(h) Gamma(h)
Propagator propagator(Plant plant, Real time) {
  Real pull = plant.stiffness / plant.mass, drag = plant.damping / plant.mass;
  Real fastest = std::sqrt(std::abs(pull)) + std::abs(drag);
  Real h = time;
  int doublings = 0;
  while (fastest * h > Real(0.125) && doublings < DOUBLINGS) {
    h *= Real(0.5);
    ++doublings;
  }
  // Horner's scheme for both series: P = I + A h / n P
  Real pp = 1, ps = 0, sp = 0, ss = 1;      // of Phi
  Real gpp = 1, gps = 0, gsp = 0, gss = 1;  // of Gamma
  for (int n = ORDER; n > 0; --n) {
    Real scale = h / Real(n), next = h / Real(n + 1);
    Real a = 1 + scale * sp, b = scale * ss;
    Real c = -scale * (pull * pp + drag * sp), d = 1 - scale * (pull * ps + drag * ss);
    pp = a, ps = b, sp = c, ss = d;
    a = 1 + next * gsp, b = next * gss;
    c = -next * (pull * gpp + drag * gsp), d = 1 - next * (pull * gps + drag * gss);
    gpp = a, gps = b, gsp = c, gss = d;
  }
  Propagator by;
  by.place_place = pp, by.place_speed = ps, by.speed_place = sp, by.speed_speed = ss;
  by.place_force = h * gps / plant.mass;
  by.speed_force = h * gss / plant.mass;
  for (int k = 0; k < doublings; ++k) {
    Propagator once = by;
    by.place_force = once.place_force + once.place_place * once.place_force + once.place_speed * once.speed_force;
    by.speed_force = once.speed_force + once.speed_place * once.place_force + once.speed_speed * once.speed_force;
    by.place_place = once.place_place * once.place_place + once.place_speed * once.speed_place;
    by.place_speed = once.place_place * once.place_speed + once.place_speed * once.speed_speed;
    by.speed_place = once.speed_place * once.place_place + once.speed_speed * once.speed_place;
    by.speed_speed = once.speed_place * once.place_speed + once.speed_speed * once.speed_speed;
  }
  return by;
}

Propagator stepped_propagator(Plant plant, Real time, int integrator, int substeps) {
  if (integrator == LOOP_EXACT) return propagator(plant, time);
  Real h = time / Real(substeps);
  Real pull = plant.stiffness / plant.mass * h, drag = plant.damping / plant.mass * h;
  // explicit: x + h v; semi-implicit: x + h (new v)
  Real lag = integrator == LOOP_SEMI_IMPLICIT ? h : Real(0);
  Propagator once;
  once.place_place = 1 - lag * pull, once.place_speed = h - lag * drag, once.place_force = lag * h / plant.mass;
  once.speed_place = -pull, once.speed_speed = 1 - drag, once.speed_force = h / plant.mass;
  Propagator by;
  for (int step = 0; step < substeps; ++step) {
    Propagator before = by;
    by.place_place = once.place_place * before.place_place + once.place_speed * before.speed_place;
    by.place_speed = once.place_place * before.place_speed + once.place_speed * before.speed_speed;
    by.place_force = once.place_place * before.place_force + once.place_speed * before.speed_force + once.place_force;
    by.speed_place = once.speed_place * before.place_place + once.speed_speed * before.speed_place;
    by.speed_speed = once.speed_place * before.place_speed + once.speed_speed * before.speed_speed;
    by.speed_force = once.speed_place * before.place_force + once.speed_speed * before.speed_force + once.speed_force;
  }
  return by;
}

Motion advance(Propagator by, Motion motion, Real force) {
  Motion next;
  next.place = by.place_place * motion.place + by.place_speed * motion.speed + by.place_force * force;
  next.speed = by.speed_place * motion.place + by.speed_speed * motion.speed + by.speed_force * force;
  return next;
}

Motion advance_with_friction(Plant plant, Propagator whole, Motion motion, Real force, Real friction, Real time) {
  if (!(friction > 0)) return advance(whole, motion, force);
  Real left = time;
  Propagator by = whole;
  for (int stop = 0; stop < LOOP_STOPS; ++stop) {
    Real pull = force - plant.stiffness * motion.place;
    Real heading = motion.speed != 0 ? motion.speed : std::abs(pull) > friction ? pull : Real(0);
    if (heading == 0) return motion;
    Real drive = force - (heading > 0 ? friction : -friction);
    Motion next = advance(by, motion, drive);
    if (heading > 0 ? next.speed >= 0 : next.speed <= 0) return next;
    // where the speed passes 0: Newton from the chord
    Real at = left * motion.speed / (motion.speed - next.speed);
    Motion there = motion;
    for (int k = 0; k < NEWTON_STEPS; ++k) {
      there = advance(propagator(plant, at), motion, drive);
      Real slope = (drive - plant.stiffness * there.place - plant.damping * there.speed) / plant.mass;
      if (slope != 0) at = std::min(std::max(at - there.speed / slope, Real(0)), left);
    }
    motion = advance(propagator(plant, at), motion, drive);
    motion.speed = 0;
    left -= at;
    by = propagator(plant, left);
  }
  return motion;
}

Real read_encoder(Real place, Real step) { return step > 0 ? std::floor(place / step + Real(0.5)) * step : place; }

Real wall_force(Wall wall, Real place, Real rate) {
  Real force = -(wall.stiffness * place + wall.damping * rate);
  if (!wall.is_bilateral) force = place > 0 ? std::min(force, Real(0)) : Real(0);
  if (wall.force_limit > 0) force = std::min(std::max(force, -wall.force_limit), wall.force_limit);
  return force;
}

LoopState let_go(Wall wall, Real place) {
  LoopState state;
  state.motion.place = place;
  state.reading = place;
  for (int k = 0; k < LOOP_DELAYS; ++k) state.waiting[k] = k < wall.delay ? wall_force(wall, place, 0) : Real(0);
  return state;
}

LoopState step_loop(Plant plant, Propagator by, Wall wall, LoopState state, Real press, Real friction) {
  Real reading = read_encoder(state.motion.place, wall.encoder_step);
  Real applied = wall_force(wall, reading, (reading - state.reading) / wall.period);
  LoopState next;
  next.reading = reading;
  // the newest goes in at `delay`, the oldest comes out in front; by fixed indices, which a device keeps in registers
  for (int k = 0; k < LOOP_DELAYS; ++k) {
    Real later = k + 1 < LOOP_DELAYS ? state.waiting[k + 1] : Real(0);
    next.waiting[k] = k == wall.delay - 1 ? applied : later;
  }
  if (wall.delay > 0) applied = state.waiting[0];
  next.motion = advance_with_friction(plant, by, state.motion, applied + press, friction, wall.period);
  return next;
}

Real loop_energy(Plant plant, Wall wall, Motion motion, Real press) {
  Real stiffness = plant.stiffness + wall.stiffness;
  Real away = motion.place - (stiffness > 0 ? press / stiffness : Real(0));
  return Real(0.5) * (plant.mass * motion.speed * motion.speed + stiffness * away * away);
}

}  // namespace CORE_NS
