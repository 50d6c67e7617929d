// SPDX-License-Identifier: MIT
// Leaf functions of loop.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "loop.glsl"
#include "probe.glsl"

Plant given_plant() { return Plant(given(0), given(1), given(2)); }

void answer_motion(Motion motion) {
  answer(0, motion.place);
  answer(1, motion.speed);
}

void main() {
  if (row() >= push.count) return;
  if (PROBE == PROBE_PROPAGATOR) {
    Propagator by = propagator(given_plant(), given(3));
    answer3(0, Vec3(by.place_place, by.place_speed, by.place_force));
    answer3(3, Vec3(by.speed_place, by.speed_speed, by.speed_force));
  }
  if (PROBE == PROBE_STEPPED) {
    Propagator by = stepped_propagator(given_plant(), given(3), given_int(4), given_int(5));
    answer3(0, Vec3(by.place_place, by.place_speed, by.place_force));
    answer3(3, Vec3(by.speed_place, by.speed_speed, by.speed_force));
  }
  if (PROBE == PROBE_LET_GO) {
    Wall wall = Wall(given(0), given(1), given(2), given(3), given(4), given_int(5), given_int(6) != 0);
    LoopState state = let_go(wall, given(7));
    answer_motion(state.motion);
    answer(2, state.reading);
    for (int k = 0; k < LOOP_DELAYS; ++k) answer(3 + k, state.waiting[k]);
  }
  if (PROBE == PROBE_ADVANCE) {
    Plant plant = given_plant();
    Propagator by = propagator(plant, given(7));
    Motion motion = Motion(given(3), given(4));
    answer_motion(given(6) > Real(0) ? advance_with_friction(plant, by, motion, given(5), given(6), given(7))
                                     : advance(by, motion, given(5)));
  }
  if (PROBE == PROBE_WALL_FORCE) {
    Wall wall = Wall(given(0), given(1), given(2), given(3), given(4), 0, given_int(5) != 0);
    Real reading = read_encoder(given(6), wall.encoder_step);
    answer(0, reading);
    answer(1, wall_force(wall, reading, given(7)));
  }
  if (PROBE == PROBE_STEP_LOOP) {
    Plant plant = given_plant();
    Wall wall = Wall(given(3), given(4), given(5), given(6), given(7), given_int(8), given_int(9) != 0);
    LoopState state;
    state.motion = Motion(given(10), given(11));
    state.reading = given(12);
    for (int k = 0; k < LOOP_DELAYS; ++k) state.waiting[k] = given(13 + k);
    state = step_loop(plant, propagator(plant, wall.period), wall, state, given(17), given(18));
    answer_motion(state.motion);
    answer(2, state.reading);
    for (int k = 0; k < LOOP_DELAYS; ++k) answer(3 + k, state.waiting[k]);
  }
  if (PROBE == PROBE_LOOP_ENERGY) {
    Wall wall = Wall(given(3), Real(0), Real(1), Real(0), Real(0), 0, false);
    answer(0, loop_energy(given_plant(), wall, Motion(given(4), given(5)), given(6)));
  }
}
