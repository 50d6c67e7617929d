// SPDX-License-Identifier: MIT
#include "core/wall_run.h"

#include "core/loop.h"

namespace CORE_NS {

double late_energy(const wholehand::WallCase& wall_case, int samples, int late) {
  const Plant plant{Real(wall_case.mass), Real(wall_case.damping), Real(wall_case.spring)};
  Wall wall;
  wall.stiffness = Real(wall_case.wall_stiffness);
  wall.damping = Real(wall_case.wall_damping);
  wall.period = Real(wall_case.period);
  wall.encoder_step = Real(wall_case.encoder_step);
  wall.force_limit = Real(wall_case.force_limit);
  wall.delay = wall_case.delay;
  wall.is_bilateral = wall_case.is_bilateral;
  const Real press = Real(wall_case.press), friction = Real(wall_case.friction);
  const Propagator by = stepped_propagator(plant, wall.period, wall_case.integrator, wall_case.substeps);
  LoopState state = let_go(wall, Real(wall_case.place));
  Real largest = 0;
  for (int step = 0; step < samples; ++step) {
    state = step_loop(plant, by, wall, state, press, friction);
    if (step < samples - late) continue;
    const Real energy = loop_energy(plant, wall, state.motion, press);
    if (!(energy <= largest)) largest = energy;
  }
  return static_cast<double>(largest);
}

}  // namespace CORE_NS
