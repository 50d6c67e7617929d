// SPDX-License-Identifier: MIT
// The sampled haptic loop: its plant against closed forms, its limits against theory and published figures.
// sanitizers: address
#include "core/loop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "device/loop/wall.h"

namespace wholehand {
namespace {

using namespace core_f64;

// ---- the plant ----

// A free mass with drag: v = v0 exp(-b t / m), x = x0 + v0 (m / b) (1 - exp(-b t / m)); under a force, towards f / b.
TEST(Loop, DragIsAnExponential) {
  for (const double damping : {1e-6, 0.1, 1.0, 50.0, 5e4}) {
    const Plant plant{0.1, damping, 0};
    for (const double time : {1e-4, 1e-3, 0.1, 2.0}) {
      const double decay = std::exp(-damping * time / 0.1), travel = -0.1 / damping * std::expm1(-damping * time / 0.1);
      const Motion free = advance(propagator(plant, time), {0.02, 0.3}, 0);
      EXPECT_NEAR(free.speed, 0.3 * decay, 1e-13) << damping << " " << time;  // a hundred roundings of the largest term
      EXPECT_NEAR(free.place, 0.02 + 0.3 * travel, 1e-13 * (1 + 0.3 * time));
      const Motion pressed = advance(propagator(plant, time), {0, 0}, 2);
      EXPECT_NEAR(pressed.speed, 2 / damping * -std::expm1(-damping * time / 0.1), 1e-12 * std::max(1.0, 2 * time / 0.1));
    }
  }
}

// An undamped spring: x = x0 cos w t + v0 / w sin w t.
TEST(Loop, SpringIsACosine) {
  const Plant plant{0.2, 0, 500};
  const double w = std::sqrt(500 / 0.2);
  for (const double time : {1e-4, 1e-3, 0.02, 1.0}) {
    const Motion motion = advance(propagator(plant, time), {0.01, 0.4}, 0);
    EXPECT_NEAR(motion.place, 0.01 * std::cos(w * time) + 0.4 / w * std::sin(w * time), 1e-13);
    EXPECT_NEAR(motion.speed, 0.4 * std::cos(w * time) - 0.01 * w * std::sin(w * time), 1e-12);
  }
}

TEST(Loop, TwoHalvesAreTheWhole) {
  const Plant plant{0.05, 3, 800};
  const Motion start{0.01, -0.2};
  const Motion whole = advance(propagator(plant, 0.01), start, 1.5);
  const Propagator half = propagator(plant, 0.005);
  const Motion halves = advance(half, advance(half, start, 1.5), 1.5);
  EXPECT_NEAR(whole.place, halves.place, 1e-16 * 100);
  EXPECT_NEAR(whole.speed, halves.speed, 1e-15 * 100);
}

// Sliding to a stop: after t = m v / f at x = m v^2 / 2 f, and there it stays.
TEST(Loop, FrictionStopsAndHolds) {
  const Plant plant{0.1, 0, 0};
  const double period = 1e-3, friction = 0.5;
  const Propagator by = propagator(plant, period);
  Motion motion{0, 0.0123};
  for (int sample = 0; sample < 10; ++sample) motion = advance_with_friction(plant, by, motion, 0, friction, period);
  EXPECT_EQ(motion.speed, 0);
  EXPECT_NEAR(motion.place, 0.1 * 0.0123 * 0.0123 / 2 / friction, 1e-16);
  const Motion held = advance_with_friction(plant, by, motion, 0.49, friction, period);
  EXPECT_EQ(held.place, motion.place);
  EXPECT_GT(advance_with_friction(plant, by, motion, 0.51, friction, period).speed, 0);
  // turned round within one sample: against the friction to the stop, then back with what is left of the force
  const double long_period = 0.1, force = -2;
  const Motion turned = advance_with_friction(plant, propagator(plant, long_period), {0, 0.05}, force, friction, long_period);
  const double stop = 0.1 * 0.05 / 2.5, back = long_period - stop;
  EXPECT_NEAR(turned.speed, -1.5 / 0.1 * back, 1e-14);
  EXPECT_NEAR(turned.place, 0.05 * stop / 2 - 0.5 * 15 * back * back, 1e-14);
}

// ---- the controller ----

TEST(Loop, EncoderReadsTheNearestStep) {
  EXPECT_EQ(read_encoder(0.0123, 0), 0.0123);
  EXPECT_DOUBLE_EQ(read_encoder(0.0123, 0.001), 0.012);
  EXPECT_DOUBLE_EQ(read_encoder(-0.0016, 0.001), -0.002);
}

TEST(Loop, WallOnlyPushesOut) {
  Wall wall;
  wall.stiffness = 1000;
  wall.damping = 5;
  wall.period = 1e-3;
  EXPECT_EQ(wall_force(wall, 0.001, 0), -1);
  EXPECT_EQ(wall_force(wall, -0.001, 0), 0) << "in the air";
  EXPECT_EQ(wall_force(wall, 0.001, -1), 0) << "leaving faster than it pushes: no pull";
  EXPECT_EQ(wall_force(wall, 0.001, 0.1), -1.5);
  wall.is_bilateral = true;
  EXPECT_EQ(wall_force(wall, -0.001, 0), 1);
  EXPECT_EQ(wall_force(wall, 0.001, -1), 4);
  wall.force_limit = 2;
  EXPECT_EQ(wall_force(wall, 0.001, -1), 2);
  EXPECT_EQ(wall_force(wall, 1, 0), -2);
}

TEST(Loop, DelayIsWholeSamples) {
  const Plant plant{1, 0, 0};
  for (int delay = 0; delay <= LOOP_DELAYS; ++delay) {
    Wall wall;
    wall.stiffness = 100;
    wall.period = 1e-3;
    wall.delay = delay;
    const Propagator by = propagator(plant, wall.period);
    LoopState state;
    state.motion.place = 0.01;  // 1 N out of the wall, felt after `delay` samples
    for (int sample = 0; sample < delay; ++sample) {
      state = step_loop(plant, by, wall, state, 0, 0);
      EXPECT_EQ(state.motion.speed, 0) << delay << " " << sample;
    }
    state = step_loop(plant, by, wall, state, 0, 0);
    EXPECT_NEAR(state.motion.speed, -1e-3, 1e-12) << delay;
  }
}

// ---- limits ----

struct Row {
  double mass, damping, period, wall_damping;
  int delay;
  double passive, limit;
};

// Published limits of a wall on a free mass: the last but one row's device with a delay has no passive figure.
const std::vector<Row> TABLE{{.1, 1, 1e-3, 0, 0, 2000, 2003.3},  {.1, .1, 1e-3, 0, 0, 200, 200.0},
                             {.22, 2, 1e-3, 0, 0, 4000, 4006.1}, {.1, 1, .25e-3, 0, 0, 8000, 8003.3},
                             {.1, 1, 1e-3, 0, 1, 0, 668.5},      {.1, 1, 1e-3, .5, 0, 1000, 2990.1},
                             {.02, 1, 1e-3, 0, 0, 2000, 2016.8}};

device::WallDevice device_of(const Row& row) {
  device::WallDevice device;
  device.mass = row.mass;
  device.damping = row.damping;
  device.rate = 1 / row.period;
  device.wall_damping = row.wall_damping;
  device.delay = row.delay;
  return device;
}

TEST(Loop, LimitsAreThoseOfTheTable) {
  for (const Row& row : TABLE) {
    const device::WallLimits limits = device::wall_limits(device_of(row));
    EXPECT_NEAR(limits.linear, row.limit, 0.05 + 5e-5 * row.limit) << "to the digits given";
    EXPECT_NEAR(limits.simulated, row.limit, 0.01 * row.limit)
        << row.mass << " kg, " << row.damping << " N s/m, delay " << row.delay;
    if (row.delay == 0) {
      EXPECT_DOUBLE_EQ(limits.passive, row.passive);
      EXPECT_LE(limits.passive, limits.simulated);
    }
  }
}

// Whatever is passive settles: masses, rates and dampings far apart, and with friction and an encoder within Abbott and Okamura's
// limit.
TEST(Loop, PassiveWallsSettle) {
  for (const double mass : {0.005, 0.1, 2.0})
    for (const double damping : {0.05, 1.0, 20.0})
      for (const double rate : {250.0, 1000.0, 8000.0})
        for (const double share : {0.0, 0.4, -0.4})
          for (const double of_limit : {0.05, 0.5, 0.98}) {
            device::WallDevice device;
            device.mass = mass;
            device.damping = damping;
            device.rate = rate;
            device.wall_damping = share * damping;
            const double passive = 2 * (damping - std::abs(device.wall_damping)) * rate;
            EXPECT_TRUE(device::settles(device, of_limit * passive))
                << mass << " " << damping << " " << rate << " " << share << " " << of_limit;
          }
  device::WallDevice device;
  device.encoder_step = 20e-6;
  device.coulomb = 0.015;
  EXPECT_DOUBLE_EQ(device::wall_limits(device).coulomb, 1500);
  EXPECT_TRUE(device::settles(device, 0.98 * 1500));
}

// A passive spring never gains: the energy about its rest at the samples of one and the same phase falls, so its largest over a
// period does.
TEST(Loop, EnergyNeverGrowsWhereItIsPassive) {
  const Plant plant{0.1, 1, 0};
  Wall wall;
  wall.stiffness = 1500;
  wall.period = 1e-3;
  wall.is_bilateral = true;
  const Propagator by = propagator(plant, wall.period);
  LoopState state;
  state.motion = {0.01, 0};
  state.reading = 0.01;
  const int samples = 52;  // a period of 2 pi sqrt(m / K) is 51.3 ms
  double before = 1e300;
  for (int window = 0; window < 40; ++window) {
    double largest = 0;
    for (int k = 0; k < samples; ++k) {
      state = step_loop(plant, by, wall, state, 0, 0);
      largest = std::max(largest, loop_energy(plant, wall, state.motion, 0));
    }
    EXPECT_LT(largest, before) << window;
    before = largest;
  }
}

// Thrown against a wall stiffer than passive, a mass comes back faster than it went in, once, and never again; held by a spring of
// that stiffness it swings ever wider.
TEST(Loop, WallAndSpringAreToldApart) {
  const Plant plant{0.1, 1, 0};
  for (const bool is_spring : {false, true}) {
    Wall wall;
    wall.stiffness = 20000;
    wall.period = 1e-3;
    wall.is_bilateral = is_spring;
    const Propagator by = propagator(plant, wall.period);
    LoopState state;
    state.motion = {-1e-4, 0.1};
    state.reading = -1e-4;
    double fastest = 0;
    for (int sample = 0; sample < 100; ++sample) {
      state = step_loop(plant, by, wall, state, 0, 0);
      fastest = std::max(fastest, std::abs(state.motion.speed));
    }
    if (is_spring) {
      device::WallDevice device;
      EXPECT_GT(fastest, 0.1 * std::pow(device::spectral_radius(device, wall.stiffness), 100) / 3)
          << "the phase of the swing is any";
      EXPECT_GT(fastest, 1.0);
    } else {
      EXPECT_GT(fastest, 0.1) << "the wall gave energy";
      EXPECT_LT(fastest, 1.0);
      EXPECT_LT(state.motion.place, 0) << "and lets go";
    }
  }
}

TEST(Loop, SpectralRadiusOfADeviceInTheAir) {
  device::WallDevice device;  // x stays where it is: an eigenvalue of 1; the speed decays
  EXPECT_NEAR(device::spectral_radius(device, 0), 1, 1e-7);
  device.finger_stiffness = 300;  // held: what is left decays with exp(-b t / 2 m)
  EXPECT_NEAR(device::spectral_radius(device, 0), std::exp(-1 * 1e-3 / 0.2), 1e-7);
}

// Both converge to the exact propagator to first order in the sub-step.
TEST(Loop, EulerConvergesToTheExactPropagator) {
  const Plant plant{0.1, 2, 300};
  const Propagator exact = propagator(plant, 4e-3);
  for (const int integrator : {LOOP_EULER, LOOP_SEMI_IMPLICIT}) {
    double before = 0;
    for (const int substeps : {8, 16, 32, 64}) {
      const Propagator by = stepped_propagator(plant, 4e-3, integrator, substeps);
      const double error = std::abs(by.speed_place - exact.speed_place) + std::abs(by.speed_speed - exact.speed_speed);
      if (before > 0) {
        EXPECT_NEAR(before / error, 2, 0.1) << integrator << " " << substeps;
      }
      before = error;
    }
  }
  EXPECT_EQ(stepped_propagator(plant, 4e-3, LOOP_EXACT, 3).speed_place, exact.speed_place);
}

// One explicit step per sample adds the energy that it does not see: a free mass on an undamped spring gains (1 + k h^2 / m) a
// step, the semi-implicit one gains nothing.
TEST(Loop, ExplicitEulerGainsWhatItsFormulaSays) {
  const Plant plant{0.2, 0, 500};
  const double h = 1e-3;
  const Propagator explicit_step = stepped_propagator(plant, h, LOOP_EULER, 1);
  const Propagator semi = stepped_propagator(plant, h, LOOP_SEMI_IMPLICIT, 1);
  const auto determinant = [](const Propagator& by) { return by.place_place * by.speed_speed - by.place_speed * by.speed_place; };
  EXPECT_NEAR(determinant(explicit_step), 1 + 500 / 0.2 * h * h, 1e-15);
  EXPECT_NEAR(determinant(semi), 1, 1e-15);
  EXPECT_NEAR(determinant(propagator(plant, h)), 1, 1e-15);
}

// Over what the command takes: a passive wall without delay is stable, so the linear limit is not below the passive one.
TEST(Loop, LinearLimitIsNotBelowThePassiveOne) {
  for (const double mass : {1e-6, 1e-3, 0.1, 10.0, 1000.0})
    for (const double damping : {1e-2, 1.0, 1e3})
      for (const double rate : {1.0, 1e3, 1e5}) {
        device::WallDevice device;
        device.mass = mass;
        device.damping = damping;
        device.rate = rate;
        const device::WallLimits limits = device::wall_theory(device);
        EXPECT_GE(limits.linear, limits.passive * (1 - 1e-5)) << mass << " kg, " << damping << " N s/m, " << rate << " Hz";
      }
}

// A coarse encoder without friction buzzes by more than two steps below the linear limit.
TEST(Loop, SimulationSeesTheEncoder) {
  device::WallDevice device;
  device.encoder_step = 1e-3;
  EXPECT_LT(device::wall_limits(device).simulated, 0.95 * wall_theory(device).linear);
  device.encoder_step = 1e-6;
  device.coulomb = 0.2;
  EXPECT_GT(device::wall_limits(device).simulated, 0.95 * wall_theory(device).linear);
}

// Beyond the linear limit a wall may hold a cycle that is no larger than it began: that is no stable wall.
TEST(Loop, CyclesAreNotStable) {
  device::WallDevice device;
  for (const double wall_damping : {300.0, -1.0, -2.0}) {
    device.wall_damping = wall_damping;
    EXPECT_EQ(device::wall_limits(device).simulated, 0) << wall_damping;
  }
}

}  // namespace
}  // namespace wholehand
