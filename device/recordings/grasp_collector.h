// SPDX-License-Identifier: MIT
// Collects a session's grasps from its ticks, one by one. Keeps only the ticks of one grasp.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "device/recordings/grasp_measure.h"
#include "device/recordings/recording.h"
#include "device/session/tick.h"

namespace wholehand::device {

class GraspCollector {
 public:
  // `rate` of the session in Hz; `force_max`: F_max, N; NaN: no grasp counts as saturated.
  GraspCollector(double rate, double force_max) : rate_(rate), force_max_(force_max) {}

  // Takes the ticks of the session, in the order of their numbers.
  void add(const Tick& tick);

  // Ends the session after the last tick and returns all its grasps in order. Call it once, and last.
  std::vector<GraspReport> finish();

 private:
  // For each vessel, by its number in the session.
  using Volumes = std::array<double, LIVE_VESSELS>;  // m3
  // A grasp whose liquid may still be in the air.
  struct Pouring {
    std::size_t grasp = 0;            // in grasps_
    double arrived = 0, spilled = 0;  // before it, m3
  };

  void report(GraspOutcome outcome);
  GraspOutcome outcome_without_loss() const;
  void close_liquid(int vessel, const Volumes& arrived, const Volumes& spilled);

  double rate_, force_max_;
  std::vector<Tick> held_;              // of the grasp in progress, or whose outcome is still open; empty: none
  std::optional<SessionState> behind_;  // state of the tick after these; absent: the grasp goes on
  std::array<std::optional<Pouring>, LIVE_VESSELS> pouring_;  // the latest grasp of each vessel
  Volumes arrived_{}, spilled_{};                             // at the last tick
  std::vector<GraspReport> grasps_;
};

// All grasps of a recording, in order.
std::vector<GraspReport> grasps_of(const Recording& recording);

}  // namespace wholehand::device
