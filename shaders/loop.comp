// SPDX-License-Identifier: MIT
// The rendered wall, one invocation per case: push.number samples, continuing the last dispatch or from the start (push.first). Dispatches are short,
// because drivers end an invocation's loops after so many iterations; the moving state is kept between dispatches. push.flag: these samples are late
// ones, whose largest energy is the answer.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "loop.glsl"

layout(local_size_x_id = CONST_GROUP_SIZE) in;
layout(constant_id = CONST_FRICTION) const bool HAS_FRICTION = true;
layout(std430, binding = BINDING_GRIPS) readonly buffer CaseBlock { Real case_in[]; };
layout(std430, binding = BINDING_REAL_OUT) buffer StateBlock { Real state_io[]; };

void main() {
  uint i = INVOCATION;
  if (i >= push.count) return;
#define GIVEN(plane) case_in[uint(plane) * push.stride + i]
#define KEPT(plane) state_io[uint(plane) * push.stride + i]
  Plant plant = Plant(GIVEN(CASE_MASS), GIVEN(CASE_DAMPING), GIVEN(CASE_SPRING));
  Wall wall = Wall(GIVEN(CASE_WALL_STIFFNESS), GIVEN(CASE_WALL_DAMPING), GIVEN(CASE_PERIOD), GIVEN(CASE_ENCODER),
                   GIVEN(CASE_FORCE_LIMIT), int(GIVEN(CASE_DELAY)), GIVEN(CASE_BILATERAL) != Real(0));
  Real press = GIVEN(CASE_PRESS), friction = HAS_FRICTION ? GIVEN(CASE_FRICTION) : Real(0);
  Propagator by = stepped_propagator(plant, wall.period, int(GIVEN(CASE_INTEGRATOR)), int(GIVEN(CASE_SUBSTEPS)));
  LoopState state;
  Real late;
  if (push.first != 0u) {
    state = let_go(wall, GIVEN(CASE_PLACE));
    late = Real(0);
  } else {
    state.motion = Motion(KEPT(0), KEPT(1));
    state.reading = KEPT(2);
    late = KEPT(3);
    for (int k = 0; k < LOOP_DELAYS; ++k) state.waiting[k] = KEPT(4 + k);
  }
  for (uint step = 0u; step < push.number; ++step) {
    state = step_loop(plant, by, wall, state, press, friction);
    if (push.flag != 0u) {
      Real energy = loop_energy(plant, wall, state.motion, press);
      if (is_no_number(energy) || energy > late) late = energy;
    }
  }
  KEPT(0) = state.motion.place;
  KEPT(1) = state.motion.speed;
  KEPT(2) = state.reading;
  KEPT(3) = late;
  for (int k = 0; k < LOOP_DELAYS; ++k) KEPT(4 + k) = state.waiting[k];
}
