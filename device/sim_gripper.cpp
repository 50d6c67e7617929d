// SPDX-License-Identifier: MIT
#include "device/sim_gripper.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/loop.h"
#include "core/prepare.h"
#include "core/random_bits.h"
#include "device/sim_user.h"
#include "live/session.h"

namespace wholehand {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

constexpr double TREMOR_TIME = 0.02;        // s: the correlation of a tremor of about 8 Hz
constexpr double COMPENSATION_TIME = 0.15;  // s in which the arm takes over a load that it feels

std::array<double, 2> sim_gap(const Scene& scene, const core_f64::Hand& hand) {
  if (scene.device.has_gap) return scene.device.gap;
  return {hand.scale * hand.gap_closed, hand.scale * hand.gap_open};
}

// Values of some ticks ago.
template <class T>
class Delay {
 public:
  Delay(double seconds, double rate) : ring_(static_cast<std::size_t>(std::lround(seconds * rate)) + 1) {}
  void put(const T& value) noexcept {
    ring_[at_] = value;
    at_ = (at_ + 1) % ring_.size();
  }
  const T& oldest() const noexcept { return ring_[at_]; }

 private:
  std::vector<T> ring_;
  std::size_t at_ = 0;
};

class SimGripper final : public Gripper {
 public:
  SimGripper(const Scene& scene, std::uint64_t seed)
      : live_(scene),
        workspace_(scene, sim_gap(scene, live_.hand),
                   {live_.hand.scale * live_.hand.gap_closed, live_.hand.scale * live_.hand.gap_open}),
        user_(live_, plan_sim_jobs(scene)),
        base_(scene.force.base),
        period_(1 / scene.live.rate),
        arm_{person_.arm_mass, person_.arm_damping, person_.arm_stiffness},
        fingers_{person_.finger_mass, person_.finger_damping, person_.finger_stiffness},
        arm_by_(core_f64::propagator(arm_, period_)),
        fingers_by_(core_f64::propagator(fingers_, period_)),
        seen_(person_.reaction, scene.live.rate),
        random_(seed) {
    limits_.name = "simulated gripper";
    limits_.address = "sim";
    limits_.force = PAPER_FORCE;
    limits_.grip = PAPER_GRIP;
    limits_.gap = workspace_.device_gap();
    limits_.rate = scene.live.rate;
    limits_.is_left_handed = scene.hand.handedness == Handedness::left;
    open_ = live_.hand.scale * live_.hand.gap_open;
    wish_ = user_.next({}, period_);
    for (int k = 0; k < 3; ++k) place_[k].place = wish_.middle[k];
  }

  const GripperLimits& limits() const noexcept override { return limits_; }

  // The motion up to now under the force that was written last, then where that leaves the handle.
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    for (std::int64_t k = last_; k < tick; ++k) advance();
    last_ = tick;
    HandPose pose;
    pose.middle = Vec3(place_[0].place, place_[1].place, place_[2].place);
    const double turn = wish_.roll - wish_.tilt, c = std::cos(turn), s = std::sin(turn);
    pose.rotation = Mat3(1, 0, 0, 0, c, s, 0, -s, c);
    pose.gap = open_ - closing_.place;
    state = workspace_.unmap(pose);
    state.sequence = static_cast<std::uint32_t>(tick) + 1;
    state.time = period_ * static_cast<double>(tick);
    return ReadOutcome::value;
  }

  bool write(const GripperForce& force) noexcept override {
    force_ = force;
    return true;
  }

  void show(const Tick& tick) noexcept override {
    shown_.state = tick.state;
    shown_.vessel = tick.vessel;
    shown_.grip = tick.user_force;
    const int vessel = user_.vessel();
    shown_.arrived = vessel >= 0 ? tick.arrived[vessel] : 0;
    shown_.flow = tick.flow;
  }

  bool is_done() const noexcept override { return user_.is_done(); }

 private:
  // Noise with a correlation time, standard deviation 1.
  double tremble(double& state) noexcept {
    const double keep = std::exp(-period_ / TREMOR_TIME);
    // a uniform number of the same variance: reproducible everywhere, which a library's normal distribution is not
    const double uniform = (unit_interval(random_()) - 0.5) * std::sqrt(12.0);
    state = keep * state + std::sqrt(1 - keep * keep) * uniform;
    return state;
  }

  void advance() noexcept {
    seen_.put(shown_);
    SimSense sense = seen_.oldest();
    sense.gap = open_ - closing_.place;
    wish_ = user_.next(sense, period_);
    const Vec3 pushed = workspace_.to_world(force_.arm);
    for (int k = 0; k < 3; ++k) {
      // the arm takes over what it feels, a little late
      carried_[k] += (pushed[k] - carried_[k]) * (-std::expm1(-period_ / COMPENSATION_TIME));
      const double goal = wish_.middle[k] + person_.arm_tremor * tremble(tremor_[k]);
      const double drive = person_.arm_stiffness * goal + person_.arm_damping * wish_.velocity[k] + pushed[k] - carried_[k];
      place_[k] = core_f64::advance(arm_by_, place_[k], drive);
    }
    squeeze(sense.grip);
  }

  // Fingers: towards a gap, or against the error of the felt force. Closing is positive.
  void squeeze(double felt) noexcept {
    if (wish_.grips_by_force) {
      muscle_ = std::max(0.0, muscle_ + (base_ + person_.excess - felt) * period_ / person_.response);
    } else {
      muscle_ = person_.finger_stiffness * (open_ - wish_.gap) - person_.finger_damping * wish_.gap_speed;
    }
    const double drive = muscle_ + person_.grip_tremor * tremble(tremor_[3]) - force_.grip;
    closing_ = core_f64::advance(fingers_by_, closing_, drive);
  }

  LiveScene live_;
  Workspace workspace_;
  SimPerson person_;
  SimUser user_;
  double base_, period_;
  core_f64::Plant arm_, fingers_;
  core_f64::Propagator arm_by_, fingers_by_;
  Delay<SimSense> seen_;
  std::mt19937_64 random_;
  GripperLimits limits_;
  SimSense shown_;
  SimWish wish_;
  double open_ = 0, muscle_ = 0;
  std::int64_t last_ = -1;
  std::array<core_f64::Motion, 3> place_{};
  core_f64::Motion closing_;
  std::array<double, 3> carried_{};
  std::array<double, 4> tremor_{};
  GripperForce force_;
};

}  // namespace

std::unique_ptr<Gripper> open_sim(const Scene& scene, std::uint64_t seed) { return std::make_unique<SimGripper>(scene, seed); }

}  // namespace wholehand
