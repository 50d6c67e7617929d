// SPDX-License-Identifier: MIT
#include "device/simulated/sim_gripper.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "base/numbers/random_bits.h"
#include "core/loop.h"
#include "core/prepare.h"
#include "device/session/session.h"
#include "device/simulated/sim_fingers.h"

namespace wholehand::device {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

constexpr double TREMOR_TIME = 0.15;    // s for which a tremor keeps its phase: a peak of 2 Hz at half its height
constexpr double WANDERING_TIME = 0.1;  // s: half of the power is below 0.7 Hz
constexpr double LONGEST_REACTION = 2;  // s

std::array<double, 2> sim_gap(const Scene& scene, const core_f64::Hand& hand) {
  if (scene.device.has_gap) return scene.device.gap;
  return {hand.scale * hand.gap_closed, hand.scale * hand.gap_open};
}

// Delays what is shown by some ticks.
class Delay {
 public:
  Delay(double longest, double rate) : ring_(static_cast<std::size_t>(std::ceil(longest * rate)) + 1), rate_(rate) {}
  void put(const SimSense& value) noexcept {
    at_ = (at_ + 1) % ring_.size();
    ring_[at_] = value;
  }
  // As far back as the ring goes.
  const SimSense& before(double seconds) const noexcept {
    const auto back = static_cast<std::size_t>(std::clamp(seconds * rate_ + 0.5, 0.0, static_cast<double>(ring_.size() - 1)));
    return ring_[(at_ + ring_.size() - back) % ring_.size()];
  }

 private:
  std::vector<SimSense> ring_;
  double rate_;
  std::size_t at_ = 0;
};

// Variance 1. Reproducible everywhere, which a library's normal distribution is not.
double uniform(std::mt19937_64& random) noexcept { return (unit_interval(random()) - 0.5) * std::sqrt(12.0); }

// Noise about one frequency, of standard deviation 1: a circling number that keeps its phase for a while.
class Tremor {
 public:
  void set(double frequency, double period) noexcept {
    keep_ = std::exp(-period / TREMOR_TIME);
    cosine_ = std::cos(2 * PI * frequency * period);
    sine_ = std::sin(2 * PI * frequency * period);
  }
  double next(std::mt19937_64& random) noexcept {
    const double added = std::sqrt(1 - keep_ * keep_), x = x_, y = y_;
    x_ = keep_ * (cosine_ * x - sine_ * y) + added * uniform(random);
    y_ = keep_ * (sine_ * x + cosine_ * y) + added * uniform(random);
    return x_;
  }

 private:
  double keep_ = 1, cosine_ = 1, sine_ = 0, x_ = 0, y_ = 0;
};

// Slow noise of standard deviation 1, without a jump in its speed: two low passes in a row.
class Wandering {
 public:
  double next(double period, std::mt19937_64& random) noexcept {
    const double keep = std::exp(-period / WANDERING_TIME);
    first_ = keep * first_ + std::sqrt(1 - keep * keep) * uniform(random);
    second_ = keep * second_ + (1 - keep) * first_;
    return std::sqrt(2.0) * second_;
  }

 private:
  double first_ = 0, second_ = 0;
};

class SimGripper final : public Gripper {
 public:
  SimGripper(const Scene& scene, std::uint64_t seed, const Participant& person, std::vector<SimJob> jobs,
             ShownGripSource* shown_grips)
      : live_(scene),
        hand_gap_{live_.hand.scale * live_.hand.gap_closed, live_.hand.scale * live_.hand.gap_open},
        workspace_(scene, sim_gap(scene, live_.hand), hand_gap_),
        user_(live_, std::move(jobs), person),
        shown_grips_(shown_grips),
        period_(1 / scene.live.rate),
        fingers_(scene.force.k_open, workspace_.device_gap()[1] - workspace_.device_gap()[0], std::min(scene.force.max, PAPER_GRIP),
                 period_),
        shown_before_(LONGEST_REACTION, scene.live.rate),
        random_(seed) {
    limits_.name = "simulated gripper";
    limits_.address = "sim";
    limits_.force = PAPER_FORCE;
    limits_.grip = PAPER_GRIP;
    limits_.gap = workspace_.device_gap();
    limits_.rate = scene.live.rate;
    limits_.is_left_handed = scene.hand.handedness == Handedness::left;
    if (shown_grips_) user_.follow_shown();
    command_ = user_.next({}, period_);
    for (int k = 0; k < 3; ++k) place_[k].place = command_.middle[k];
    take();
  }

  const GripperLimits& limits() const noexcept override { return limits_; }

  // The motion up to now under the force that was written last, then where that leaves the handle.
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    for (std::int64_t k = last_; k < tick; ++k) advance();
    last_ = tick;
    HandPose pose;
    for (int k = 0; k < 3; ++k) pose.middle[k] = place_[k].place + trembling_[k];
    pose.rotation = command_.rotation();
    pose.gap = hand_gap();
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
    if (is_held(tick.state) && !is_held(shown_.state)) normal_at_grasp_ = tick.normal_force;
    shown_.state = tick.state;
    shown_.vessel = tick.vessel;
    shown_.felt = tick.written.grip;
    shown_.load = is_held(tick.state) ? tick.feedback - tick.user_force : 0;
    shown_.weight = tick.weight;
    shown_.holding = tick.slip_speed > FELT_SLIP
                         ? still_grip(normal_at_grasp_, tick.opening_force, live_.scene.force.max) - tick.safety_margin
                         : 0;
    const int vessel = user_.vessel();
    shown_.arrived = vessel >= 0 ? tick.arrived[vessel] : 0;
    shown_.flow = tick.flow;
    if (shown_grips_ && shown_grips_->take(tick.number, shown_grip_)) user_.see(shown_grip_);
  }

  bool is_done() const noexcept override { return user_.is_done(); }

 private:
  // Gap of the hand; fingers_ are on the device.
  double hand_gap() const noexcept { return hand_gap_[1] - workspace_.gap_slope() * fingers_.place(); }

  // The person's own numbers in the grasp that begins.
  void take() noexcept {
    const Traits& traits = user_.traits();
    grasp_ = user_.grasp();
    arm_damping_ = traits[Trait::arm_damping];
    arm_stiffness_ = traits[Trait::arm_stiffness];
    arm_by_ = core_f64::propagator({traits[Trait::arm_mass], arm_damping_, arm_stiffness_}, period_);
    fingers_.take(traits);
    for (Tremor& tremor : tremor_) tremor.set(traits[Trait::tremor_rate], period_);
  }

  void advance() noexcept {
    shown_before_.put(shown_);
    SimSense sense = shown_before_.before(user_.traits()[Trait::reaction]);
    sense.gap = hand_gap();
    command_ = user_.next(sense, period_);
    if (user_.grasp() != grasp_) take();
    // the arm takes over what it feels in the time of a response
    const double share = -std::expm1(-period_ / user_.traits()[Trait::response]);
    const Vec3 pushed = workspace_.to_world(force_.arm);
    for (int k = 0; k < 3; ++k) {
      carried_[k] += (pushed[k] - carried_[k]) * share;
      trembling_[k] = user_.traits()[Trait::arm_tremor] * tremor_[k].next(random_);
      const double drive = arm_stiffness_ * command_.middle[k] + arm_damping_ * command_.velocity[k] + pushed[k] - carried_[k];
      place_[k] = core_f64::advance(arm_by_, place_[k], drive);
    }
    if (command_.grips_by_force) {
      fingers_.press(command_.force, sense.felt, sense.load);
    } else {
      const double slope = workspace_.gap_slope();
      fingers_.go((hand_gap_[1] - command_.gap) / slope, -command_.gap_speed / slope);
    }
    fingers_.advance(force_.grip, tremor_[3].next(random_), wandering_.next(period_, random_));
  }

  LiveScene live_;
  std::array<double, 2> hand_gap_;  // closed, open, m
  Workspace workspace_;
  SimUser user_;
  ShownGripSource* shown_grips_;  // null: the person follows none
  ShownGrip shown_grip_;
  double period_;
  SimFingers fingers_;
  Delay shown_before_;
  std::mt19937_64 random_;
  GripperLimits limits_;
  SimSense shown_;
  double normal_at_grasp_ = 0;  // F_n then, N
  SimCommand command_;
  int grasp_ = -1;
  double arm_damping_ = 0, arm_stiffness_ = 0;
  core_f64::Propagator arm_by_;
  std::int64_t last_ = -1;
  std::array<core_f64::Motion, 3> place_{};
  std::array<double, 3> carried_{}, trembling_{};  // N; m
  std::array<Tremor, 4> tremor_{};
  Wandering wandering_;
  GripperForce force_;
};

}  // namespace

std::unique_ptr<Gripper> open_sim(const Scene& scene, std::uint64_t seed, const Participant& person, std::vector<SimJob> jobs,
                                  ShownGripSource* shown) {
  return std::make_unique<SimGripper>(scene, seed, person, std::move(jobs), shown);
}

std::unique_ptr<Gripper> open_sim(const Scene& scene, std::uint64_t seed, const Participant& person, ShownGripSource* shown) {
  return open_sim(scene, seed, person, plan_sim_jobs(scene), shown);
}

std::unique_ptr<Gripper> open_sim(const Scene& scene, std::uint64_t seed, ShownGripSource* shown) {
  return open_sim(scene, seed, Participant(scene.people), shown);
}

}  // namespace wholehand::device
