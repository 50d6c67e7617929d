// SPDX-License-Identifier: MIT
// The user of the simulated gripper: what a person would do with a scene, one intention after another. It has no physics of the device.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/evaluator.h"
#include "core/people/participant.h"
#include "core/result.h"
#include "device/session/session.h"
#include "device/simulated/pour_path.h"
#include "device/simulated/shown_grip.h"

namespace wholehand::device {

// One task with a vessel, in the world of the right hand.
struct SimJob {
  enum class Kind { show, pour, carry };  // lift and tilt it; pour an amount into the target; carry it to the destination
  Kind kind = Kind::show;
  int vessel = 0;
  GripInput grip;     // where it is taken
  double gap = 0;     // of the hand there, m
  double amount = 0;  // m3 of its liquid that should be in the target
  PourPath path;      // middle of the tips while it pours
};

// A grip that the user would take, and its quality.
struct ChosenGrip {
  GripInput grip;
  GripResult result;
  double score = 0;  // the grip's score; 1 more if it is antipodal, and 1 more if it is plausible
};
// The best roll, with all else of `grip`, among those with the palm away from the user. Nothing if none is feasible.
std::optional<ChosenGrip> best_roll(const Evaluator& evaluator, std::size_t vessel, const GripInput& grip);

// The jobs of a scene: its task, or each vessel shown. A vessel is taken at the height of the guidance point shown at that time, without one where
// the grip scores best, and always with the palm away from the user. Vessels that no such grip holds are left out; throws Error (usage) if none is
// left.
std::vector<SimJob> plan_sim_jobs(const Scene& scene);

// Where the user steers the hand at a moment, and how it grips.
struct SimCommand {
  core_f64::Vec3 middle{};        // of the tips, m
  core_f64::Vec3 velocity{};      // of that, m/s
  double azimuth = 0;             // of the line of the tips about up, off x, rad
  double tilt = 0;                // about the level part of that line, rad; the top goes away from the user
  double obliquity = 0;           // of that line, rad: the index finger is higher
  double roll = 0;                // of the hand about that line, rad
  bool grips_by_force = false;    // holds a force; else moves to a gap
  double force = 0;               // that is held, N
  double gap = 0, gap_speed = 0;  // of the hand, m and m/s; positive opens

  // The gripper's axes, in the world of the right hand.
  core_f64::Mat3 rotation() const noexcept;
};

// What the user sees and feels, one reaction time late.
struct SimSense {
  SessionState state = SessionState::free;
  int vessel = -1;
  double felt = 0;     // at the fingers, N
  double load = 0;     // its increase since the grasp that the fingers did not cause, N
  double weight = 0;   // at the arm, N
  double holding = 0;  // while the vessel slips in the fingers: the grip force that holding it takes, N; else 0
  double gap = 0;      // of the hand, m
  double arrived = 0;  // of the vessel's liquid in the target, m3
  double flow = 0;     // m3/s
};

constexpr double FELT = 0.3;        // N at the fingers: a contact
constexpr double FELT_SLIP = 1e-3;  // m/s: a slower slip is not felt

class SimUser {
 public:
  // `live` must outlive it, and has the person's own hand.
  SimUser(const LiveScene& live, std::vector<SimJob> jobs, const Participant& person);
  // From now on the person looks at the shown grip before closing the hand, and takes it.
  void follow_shown() noexcept { follows_ = true; }
  // What is on the screen now.
  void see(const ShownGrip& shown) noexcept { shown_ = shown; }
  // The command `seconds` later; `seconds` must be short beside a reaction. Neither allocates nor throws.
  SimCommand next(const SimSense& sense, double seconds) noexcept;
  bool is_done() const noexcept { return job_ >= static_cast<int>(jobs_.size()); }
  int vessel() const noexcept { return is_done() ? -1 : jobs_[job_].vessel; }
  int abandoned() const noexcept { return abandoned_; }  // jobs given up after ATTEMPTS lost grips
  // The person's traits in the current grasp, and its number, counted from 0.
  const Traits& traits() const noexcept { return traits_; }
  int grasp() const noexcept { return grasp_; }

 private:
  enum class Phase { reach, look, enter, close, settle, lift, carry, tilt, maintain, upright, back, lower, open, withdraw };
  void begin(Phase phase) noexcept;
  void plan_motion() noexcept;
  void plan_job() noexcept;
  void fail() noexcept;
  void go_on(bool feels) noexcept;
  void next_grasp() noexcept;
  void take_shown_grip() noexcept;
  void follow_load(const SimSense& sense, double seconds) noexcept;
  core_f64::Vec3 on_path(double tilt) const noexcept;
  void move(core_f64::Vec3 to, double seconds) noexcept;
  double lift() const noexcept;
  core_f64::Vec3 set_down_at() const noexcept;
  void pour(const SimSense& sense, double seconds) noexcept;
  const SimJob& job() const noexcept { return jobs_[job_]; }

  const LiveScene& live_;
  std::vector<SimJob> jobs_;
  Participant person_;
  Traits traits_{};
  int grasp_ = -1;
  double weight_ = 0;                 // of the vessel that is taken, N
  double load_ = 0;                   // that the grip force follows, N
  double caught_ = 0, catching_ = 0;  // the least grip force since a slip, and what is squeezed for it beyond the loaded force, N
  double idle_ = 0;                   // s without pouring
  int job_ = 0, attempts_ = 0, abandoned_ = 0;
  bool has_failed_ = false, has_run_ = false;
  bool follows_ = false;
  ShownGrip shown_;
  Phase phase_ = Phase::reach;
  double time_ = 0;  // in the phase, s
  double lasts_ = 0;
  core_f64::Vec3 from_{}, to_{}, home_{};
  double gap_from_ = 0, gap_to_ = 0, tilt_from_ = 0, tilt_to_ = 0, roll_from_ = 0, roll_to_ = 0;
  double azimuth_from_ = 0, azimuth_to_ = 0, obliquity_from_ = 0, obliquity_to_ = 0;
  SimCommand command_;
};

}  // namespace wholehand::device
