// SPDX-License-Identifier: MIT
// Twin of core/loop.cpp.
#ifndef LOOP_GLSL
#define LOOP_GLSL

#include "real.glsl"

struct Plant {
  Real mass, damping, stiffness;
};

struct Motion {
  Real place, speed;
};

struct Propagator {
  Real place_place, place_speed, place_force;
  Real speed_place, speed_speed, speed_force;
};

struct Wall {
  Real stiffness, damping, period, encoder_step, force_limit;
  int delay;
  bool is_bilateral;
};

struct LoopState {
  Motion motion;
  Real reading;
  Real waiting[LOOP_DELAYS];
};

Propagator propagator(Plant plant, Real time) {
  Real pull = plant.stiffness / plant.mass, drag = plant.damping / plant.mass;
  Real fastest = sqrt(abs(pull)) + abs(drag);
  Real h = time;
  int doublings = 0;
  while (fastest * h > Real(0.125) && doublings < LOOP_DOUBLINGS) {
    h *= Real(0.5);
    ++doublings;
  }
  Real pp = Real(1), ps = Real(0), sp = Real(0), ss = Real(1);
  Real gpp = Real(1), gps = Real(0), gsp = Real(0), gss = Real(1);
  for (int n = LOOP_ORDER; n > 0; --n) {
    Real scale = h / Real(n), next = h / Real(n + 1);
    Real a = Real(1) + scale * sp, b = scale * ss;
    Real c = -scale * (pull * pp + drag * sp), d = Real(1) - scale * (pull * ps + drag * ss);
    pp = a;
    ps = b;
    sp = c;
    ss = d;
    a = Real(1) + next * gsp;
    b = next * gss;
    c = -next * (pull * gpp + drag * gsp);
    d = Real(1) - next * (pull * gps + drag * gss);
    gpp = a;
    gps = b;
    gsp = c;
    gss = d;
  }
  Propagator by = Propagator(pp, ps, h * gps / plant.mass, sp, ss, h * gss / plant.mass);
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
  Real lag = integrator == LOOP_SEMI_IMPLICIT ? h : Real(0);
  Propagator once = Propagator(Real(1) - lag * pull, h - lag * drag, lag * h / plant.mass, -pull, Real(1) - drag, h / plant.mass);
  Propagator by = Propagator(Real(1), Real(0), Real(0), Real(0), Real(1), Real(0));
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
  return Motion(by.place_place * motion.place + by.place_speed * motion.speed + by.place_force * force,
                by.speed_place * motion.place + by.speed_speed * motion.speed + by.speed_force * force);
}

Motion advance_with_friction(Plant plant, Propagator whole, Motion motion, Real force, Real friction, Real time) {
  if (!(friction > Real(0))) return advance(whole, motion, force);
  Real left = time;
  Propagator by = whole;
  for (int stop = 0; stop < LOOP_STOPS; ++stop) {
    Real pull = force - plant.stiffness * motion.place;
    Real heading = motion.speed != Real(0) ? motion.speed : abs(pull) > friction ? pull : Real(0);
    if (heading == Real(0)) return motion;
    Real drive = force - (heading > Real(0) ? friction : -friction);
    Motion next = advance(by, motion, drive);
    if (heading > Real(0) ? next.speed >= Real(0) : next.speed <= Real(0)) return next;
    Real at = left * motion.speed / (motion.speed - next.speed);
    Motion there = motion;
    for (int k = 0; k < LOOP_NEWTON; ++k) {
      there = advance(propagator(plant, at), motion, drive);
      Real slope = (drive - plant.stiffness * there.place - plant.damping * there.speed) / plant.mass;
      if (slope != Real(0)) at = min(max(at - there.speed / slope, Real(0)), left);
    }
    motion = advance(propagator(plant, at), motion, drive);
    motion.speed = Real(0);
    left -= at;
    by = propagator(plant, left);
  }
  return motion;
}

Real read_encoder(Real place, Real step) { return step > Real(0) ? floor(place / step + Real(0.5)) * step : place; }

Real wall_force(Wall wall, Real place, Real rate) {
  Real force = -(wall.stiffness * place + wall.damping * rate);
  if (!wall.is_bilateral) force = place > Real(0) ? min(force, Real(0)) : Real(0);
  if (wall.force_limit > Real(0)) force = min(max(force, -wall.force_limit), wall.force_limit);
  return force;
}

LoopState let_go(Wall wall, Real place) {
  LoopState state;
  state.motion = Motion(place, Real(0));
  state.reading = place;
  for (int k = 0; k < LOOP_DELAYS; ++k) state.waiting[k] = k < wall.delay ? wall_force(wall, place, Real(0)) : Real(0);
  return state;
}

LoopState step_loop(Plant plant, Propagator by, Wall wall, LoopState state, Real press, Real friction) {
  Real reading = read_encoder(state.motion.place, wall.encoder_step);
  Real applied = wall_force(wall, reading, (reading - state.reading) / wall.period);
  LoopState next;
  next.reading = reading;
  for (int k = 0; k < LOOP_DELAYS; ++k) {
    Real later = k + 1 < LOOP_DELAYS ? state.waiting[min(k + 1, LOOP_DELAYS - 1)] : Real(0);
    next.waiting[k] = k == wall.delay - 1 ? applied : later;
  }
  if (wall.delay > 0) applied = state.waiting[0];
  next.motion = advance_with_friction(plant, by, state.motion, applied + press, friction, wall.period);
  return next;
}

Real loop_energy(Plant plant, Wall wall, Motion motion, Real press) {
  Real stiffness = plant.stiffness + wall.stiffness;
  Real away = motion.place - (stiffness > Real(0) ? press / stiffness : Real(0));
  return Real(0.5) * (plant.mass * motion.speed * motion.speed + stiffness * away * away);
}

#endif
