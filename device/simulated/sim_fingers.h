// SPDX-License-Identifier: MIT
// Thumb and index finger of the simulated user on the jaw of the gripper: how they carry out an intention, and how a force moves them.
#pragma once

#include "core/loop.h"
#include "core/people_data.h"

namespace wholehand::device {

// Fingers and jaw are one mass with damping; the fingers' stiffness holds it at a place that the person moves. Places are the closing from the
// device's open gap, m; forces are those of the fingers, positive closes, N.
class SimFingers {
 public:
  // `opening_stiffness`: k_open of the scene, which people who use the gripper have learned, N/m. `range`: how far the gripper closes, m. `most`: the
  // largest force that it renders, N. `period`: s.
  SimFingers(double opening_stiffness, double range, double most, double period);

  // From now on these are the person's fingers: their impedance, and how they follow a load.
  void take(const Traits& traits) noexcept;

  // Moves towards a place, m, at `speed`, m/s, without pressing on purpose.
  void go(double place, double speed) noexcept;

  // Moves towards a force, N. On the first call after go() the force rises from its present value over the person's response time. `felt`: the whole
  // force, and `load`: its part not due to the fingers, both one reaction time ago, N. If force and intention differ after the response, the fingers
  // correct that slowly, but not while the gripper is at a limit of its force.
  void press(double force, double felt, double load) noexcept;

  // One period under the gripper's force, positive opens. `trembling` and `wandering`: random numbers of standard deviation 1, of which the person's
  // share becomes a force.
  void advance(double rendered, double trembling, double wandering) noexcept;

  double place() const noexcept { return motion_.place; }

 private:
  double pressed() const noexcept { return stiffness_ * (held_ - motion_.place); }  // by the muscles, N

  double compliance_, range_, most_, period_;  // of what is pressed on, m/N
  double stiffness_ = 0, damping_ = 0, response_ = 0, correction_ = 0, tremor_ = 0, error_ = 0;
  core_f64::Propagator by_;
  core_f64::Motion motion_;
  double held_ = 0, speed_ = 0;  // where the muscles hold the fingers: their place if nothing pushed; and its speed
  double base_ = 0, from_ = 0;   // of press: the held place of zero force; the force at its start
  double wanted_ = 0;            // N
  double pressing_for_ = -1;     // s; negative: not pressing
};

// The jaw of the paper's gripper.
constexpr double JAW_MASS = 0.05, JAW_DAMPING = 0.5;  // kg, N s/m

}  // namespace wholehand::device
