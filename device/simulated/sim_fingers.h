// SPDX-License-Identifier: MIT
// Thumb and index finger of the simulated user on the jaw of the gripper: what they do with an intention, and what a force does to
// them.
#pragma once

#include "core/loop.h"
#include "core/people_data.h"

namespace wholehand {

// Fingers and jaw are one mass with damping; the fingers' stiffness holds it at a place that the person moves. Places are the
// closing of the device from its open gap, m; forces are of the fingers, positive closes, N.
class SimFingers {
 public:
  // `opening_stiffness`: k_open of the scene, which people who use the gripper have learnt, N/m. `range`: how far the gripper
  // closes, m. `most`: the largest force that it renders, N. `period`: s.
  SimFingers(double opening_stiffness, double range, double most, double period);

  // From now on these are the person's fingers: their impedance, and how they follow a load.
  void take(const Traits& traits) noexcept;

  // Towards a place, m, which moves with `speed`, m/s. Nothing is pressed on purpose.
  void go(double place, double speed) noexcept;

  // Towards a force, N. On the first call after go() the force rises from what is pressed then, over the person's response time.
  // `felt`: the whole force and `load`: its part that the fingers do not make, both a reaction time ago, N. Where force and
  // intention differ after the response, the fingers correct that slowly, but not while the gripper can render no more or no less.
  void press(double force, double felt, double load) noexcept;

  // One period under the force of the gripper, positive opens. `trembling` and `wandering`: numbers of standard deviation 1, of
  // which the person's share becomes a force.
  void advance(double rendered, double trembling, double wandering) noexcept;

  double place() const noexcept { return motion_.place; }

 private:
  double pressed() const noexcept { return stiffness_ * (held_ - motion_.place); }  // by the muscles, N

  double compliance_, range_, most_, period_;  // of what is pressed on, m/N
  double stiffness_ = 0, damping_ = 0, response_ = 0, correction_ = 0, tremor_ = 0, error_ = 0;
  core_f64::Propagator by_;
  core_f64::Motion motion_;
  double held_ = 0, speed_ = 0;  // where the muscles hold the fingers: where those were if nothing pushed; and its speed
  double base_ = 0, from_ = 0;   // of press: the held place of no force; the force that it began with
  double wanted_ = 0;            // N
  double pressing_for_ = -1;     // s; negative: it does not press
};

// The jaw of the paper's gripper.
constexpr double JAW_MASS = 0.05, JAW_DAMPING = 0.5;  // kg, N s/m

}  // namespace wholehand
