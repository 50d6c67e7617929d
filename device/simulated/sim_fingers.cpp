// SPDX-License-Identifier: MIT
#include "device/simulated/sim_fingers.h"

#include <algorithm>

#include "device/session/workspace.h"

namespace wholehand::device {
namespace {

constexpr double SOFTEST = 100;          // N/m: what is softer is not pressed as far as a force would ask
constexpr double CORRECTION_TIME = 0.5;  // s in which most of an error of the force goes away,
constexpr double REACTIONS = 3;          // or so many reactions: what is corrected faster than it is felt would swing

}  // namespace

SimFingers::SimFingers(double opening_stiffness, double range, double most, double period)
    : compliance_(1 / std::max(opening_stiffness, SOFTEST)), range_(range), most_(most), period_(period) {}

void SimFingers::take(const Traits& traits) noexcept {
  stiffness_ = traits[Trait::finger_stiffness];
  damping_ = traits[Trait::finger_damping];
  response_ = traits[Trait::response];
  correction_ = std::max(CORRECTION_TIME, REACTIONS * traits[Trait::reaction]);
  tremor_ = traits[Trait::grip_tremor];
  error_ = traits[Trait::grip_error];
  by_ = core_f64::propagator({traits[Trait::finger_mass] + JAW_MASS, damping_ + JAW_DAMPING, stiffness_}, period_);
}

void SimFingers::go(double place, double speed) noexcept {
  held_ = place;
  speed_ = speed;
  pressing_for_ = -1;
  wanted_ = 0;
}

// In rest the gripper pushes with F_base + load + k_open (place - grasp), so that F needs the held place
//     base + F (1 / stiffness + 1 / k_open) - load / k_open.
void SimFingers::press(double force, double felt, double load) noexcept {
  const double way = 1 / stiffness_ + compliance_;  // of the held place for each newton
  if (pressing_for_ < 0) {
    pressing_for_ = 0;
    from_ = std::max(0.0, pressed());
    base_ = held_ - from_ * way + load * compliance_;
  }
  pressing_for_ += period_;
  wanted_ = from_ + minimum_jerk(pressing_for_ / response_) * (force - from_);
  const bool is_felt = felt > 0 && felt < most_;
  if (pressing_for_ > 2 * response_ && is_felt) base_ += (wanted_ - felt) * way * period_ / correction_;
  const double before = held_;
  // no further than a closed gripper asks for
  held_ = std::min(base_ + wanted_ * way - load * compliance_, range_ + wanted_ / stiffness_);
  speed_ = (held_ - before) / period_;
}

void SimFingers::advance(double rendered, double trembling, double wandering) noexcept {
  const double noise = wanted_ * (tremor_ * trembling + error_ * wandering);
  const double drive = stiffness_ * held_ + damping_ * speed_ + noise - rendered;
  motion_ = core_f64::advance(by_, motion_, drive);
}

}  // namespace wholehand::device
