// SPDX-License-Identifier: MIT
#include "device/recordings/grasp_collector.h"

#include <cstdint>
#include <span>
#include <utility>

namespace wholehand::device {
namespace {

// At F_max the gripper renders neither what the torque adds nor what the user does.
void add_saturation(GraspReport& grasp, std::span<const Tick> held, double rate, double force_max) {
  std::int64_t periods = 0;
  bool while_tilting = false;
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (!(held[k].feedback >= force_max)) continue;
    periods += periods_of(held, k);
    while_tilting = while_tilting || held[k].state != SessionState::lift;
  }
  grasp.saturated = static_cast<double>(periods) / rate;
  if (while_tilting) grasp.course = GripCourse::not_analyzed;
}

}  // namespace

void GraspCollector::add(const Tick& tick) {
  const bool is_held_now = is_held(tick.state);
  if (!held_.empty()) {
    if (!behind_ && !(is_held_now && tick.vessel == held_.back().vessel)) behind_ = tick.state;
    // a loss that is counted before the next grasp is this one's
    if (behind_ && tick.lost > held_.back().lost) {
      report(GraspOutcome::lost);
    } else if (behind_ && is_held_now) {
      report(outcome_without_loss());
    }
  }
  if (is_held_now && tick.vessel >= 0) {
    if (held_.empty()) close_liquid(tick.vessel, tick.arrived, tick.spilled);
    held_.push_back(tick);
  }
  arrived_ = tick.arrived;
  spilled_ = tick.spilled;
}

std::vector<GraspReport> GraspCollector::finish() {
  if (!held_.empty()) report(behind_ ? outcome_without_loss() : GraspOutcome::recording_ends);
  for (int vessel = 0; vessel < LIVE_VESSELS; ++vessel) close_liquid(vessel, arrived_, spilled_);
  return std::move(grasps_);
}

GraspOutcome GraspCollector::outcome_without_loss() const {
  return behind_ == SessionState::released ? GraspOutcome::released : GraspOutcome::let_go;
}

// Only now it is known whether the grip was lost, and with this what the grasp says.
void GraspCollector::report(GraspOutcome outcome) {
  GraspReport grasp = measure_grasp(held_, rate_, outcome == GraspOutcome::lost);
  grasp.outcome = outcome;
  add_saturation(grasp, held_, rate_, force_max_);
  const auto vessel = static_cast<std::size_t>(grasp.vessel);
  pouring_[vessel] = {grasps_.size(), held_.front().arrived[vessel], held_.front().spilled[vessel]};
  grasps_.push_back(grasp);
  held_.clear();
  behind_.reset();
}

// Counts what arrived and was spilled until now for the vessel's latest grasp, because liquid is still in the air when a grasp ends.
void GraspCollector::close_liquid(int vessel, const Volumes& arrived, const Volumes& spilled) {
  const auto v = static_cast<std::size_t>(vessel);
  if (!pouring_[v]) return;
  GraspReport& grasp = grasps_[pouring_[v]->grasp];
  grasp.arrived = arrived[v] - pouring_[v]->arrived;
  grasp.spilled = spilled[v] - pouring_[v]->spilled;
  pouring_[v].reset();
}

std::vector<GraspReport> grasps_of(const Recording& recording) {
  GraspCollector collector(recording.info.rate, recording.info.force_max);
  for (const Tick& tick : recording.ticks) collector.add(tick);
  return collector.finish();
}

}  // namespace wholehand::device
