// SPDX-License-Identifier: MIT
// Who holds the simulated gripper: what a person would do with a scene, one intention after the other. No physics of the device here.
#pragma once

#include <vector>

#include "core/result.h"
#include "device/pour_path.h"
#include "live/session.h"

namespace wholehand {

// One thing to do with a vessel, in the world of the right hand.
struct SimJob {
  enum class Kind { show, pour, carry };  // lift and tilt it; pour an amount into the target; carry it to the destination
  Kind kind = Kind::show;
  int vessel = 0;
  GripInput grip;     // where it is taken
  double gap = 0;     // of the hand there, m
  double amount = 0;  // m3 of its liquid that are to be in the target
  PourPath path;      // where the tips' middle is while it pours
};

// What there is to do in a scene: its task, or each vessel shown. A vessel is taken at the height of the guidance point that is shown then,
// without one where the grip scores best, always with the palm away from the user. Vessels that no such grip holds are left out; throws Error
// (usage) where none is left.
std::vector<SimJob> plan_sim_jobs(const Scene& scene);

// What the user wants at a moment.
struct SimWish {
  core_f64::Vec3 middle{};        // of the tips, m
  core_f64::Vec3 velocity{};      // of that, m/s
  double tilt = 0;                // of the gripper, about the line of the tips, rad
  double roll = 0;                // of the hand about it, rad
  bool grips_by_force = false;    // holds a force; else goes to a gap
  double gap = 0, gap_speed = 0;  // of the hand, m and m/s; positive opens
};

// What the user sees and feels, a reaction time late.
struct SimSense {
  SessionState state = SessionState::free;
  int vessel = -1;
  double grip = 0;     // felt force, N
  double gap = 0;      // of the hand, m
  double arrived = 0;  // of the vessel's liquid in the target, m3
  double flow = 0;     // m3/s
};

class SimUser {
 public:
  // `live` must outlive it.
  SimUser(const LiveScene& live, std::vector<SimJob> jobs);
  // The wish after another `seconds`, which may not be long beside a reaction. Neither allocates nor throws.
  SimWish next(const SimSense& sense, double seconds) noexcept;
  bool is_done() const noexcept { return job_ >= static_cast<int>(jobs_.size()); }
  int vessel() const noexcept { return is_done() ? -1 : jobs_[job_].vessel; }
  int abandoned() const noexcept { return abandoned_; }  // jobs given up after ATTEMPTS lost grips

 private:
  enum class Phase { reach, enter, close, settle, lift, carry, tilt, maintain, upright, back, lower, open, withdraw };
  void begin(Phase phase) noexcept;
  void plan_motion() noexcept;
  void fail() noexcept;
  void go_on(bool feels) noexcept;
  void move(core_f64::Vec3 to, double seconds) noexcept;
  double lift() const noexcept;
  core_f64::Vec3 set_down_at() const noexcept;
  core_f64::Vec3 in_hand_world(const Triple& place) const noexcept;
  void pour(const SimSense& sense, double seconds) noexcept;
  const SimJob& job() const noexcept { return jobs_[job_]; }

  const LiveScene& live_;
  std::vector<SimJob> jobs_;
  int job_ = 0, attempts_ = 0, abandoned_ = 0;
  bool has_failed_ = false, has_run_ = false;
  Phase phase_ = Phase::reach;
  double time_ = 0;  // in the phase, s
  double lasts_ = 0;
  core_f64::Vec3 from_{}, to_{}, home_{};
  double gap_from_ = 0, gap_to_ = 0, tilt_from_ = 0, tilt_to_ = 0, roll_from_ = 0, roll_to_ = 0;
  SimWish wish_;
};

}  // namespace wholehand
