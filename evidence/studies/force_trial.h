// SPDX-License-Identifier: MIT
// One trial of the paper's preliminary experiment (its Table 2): a person grips, lifts, tilts and maintains under a choice of
// forces.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/people/participant.h"
#include "core/scene.h"
#include "device/session/tick.h"
#include "device/simulated/sim_user.h"

namespace wholehand {

// F_base and F_range, N, and how many of the paper's ten people lost the grip often.
struct ForceChoice {
  double base = 0, range = 0;
  int paper_lost = 0;
};
constexpr std::size_t FORCE_CHOICES = 15;
extern const std::array<ForceChoice, FORCE_CHOICES> PAPER_CHOICES;
constexpr std::size_t FORCE_PEOPLE = 10;  // of the paper

// "0.8" and "0.8-3.8": F_base alone, and F_base to F_base + F_range.
std::string choice_name(const ForceChoice& choice);

constexpr int FORCE_ATTEMPTS = 3;    // of a person, until one succeeds
constexpr int OFTEN = 2;             // losses of these
constexpr double HELD_STILL = 0.8;   // s of a maintained tilt, after which an attempt has succeeded
constexpr double SETTLED = 1;        // s after the grasp, from when on a grip can oscillate
constexpr double SWING_WINDOW = 1;   // s in which an oscillating grip crosses its mean
constexpr int SWINGS = 4;            // this often,
constexpr double SWING_SHARE = 0.1;  // by more than this share of the mean
constexpr double LEAST_SWING = 0.1;  // and than this, N: the paper counts a smaller difference as none

struct ForceOutcome {
  bool has_gripped = false;  // else the members below have no meaning: the person reached no grasp
  bool oscillates = false;   // in an attempt, while nothing turned
  int losses = 0;            // attempts that ended without success
  double opening = 0;        // largest opening of the gripper beyond a grasp, m

  bool has_succeeded = false;  // an attempt was maintained

  bool is_lost() const { return losses >= OFTEN; }
  bool is_held() const { return has_succeeded && !is_lost() && !oscillates; }
};

// Follows the ticks of a trial.
class ForceWatch {
 public:
  explicit ForceWatch(double rate) : rate_(rate) {}
  // False: it is over. Later ticks do not count.
  bool take(const device::Tick& tick);
  const ForceOutcome& outcome() const { return outcome_; }

 private:
  void begin(const device::Tick& tick);
  void watch_swings(double force);

  double rate_;
  ForceOutcome outcome_;
  bool was_held_ = false, is_over_ = false;
  std::int64_t since_ = 0;      // the tick of the grasp
  std::int64_t still_ = 0;      // ticks of the maintained tilt
  double gap_ = 0;              // of the device at the grasp, m
  double most_ = 0;             // force of the grasp, N
  std::vector<double> window_;  // forces at rest, N
};

// The scene of the trials: one vessel of `scene`, at its place there, with the single task of showing it.
Scene force_scene(const Scene& scene, std::size_t vessel);

// `scene`: of force_scene, with the person's own hand; `jobs`: its jobs.
ForceOutcome try_forces(Scene scene, const std::vector<device::SimJob>& jobs, const Participant& person, const ForceChoice& choice,
                        std::uint64_t seed, const std::atomic<bool>& stop);

}  // namespace wholehand
