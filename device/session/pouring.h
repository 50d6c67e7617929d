// SPDX-License-Identifier: MIT
// Liquid of a live session: what each vessel holds, what runs over its lip, falls, arrives in the target and is spilled.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/liquid.h"
#include "core/scene.h"
#include "device/session/tick.h"

namespace wholehand::device {

// Kernel 6 computes what a lip holds back at a tilt. The excess leaves with the time constant POUR_TIME (ours; a slow tilt hardly has any) and falls
// freely from the lip's lowest point. If that point was above the target's mouth, a level disc, it arrives after the time of the fall; otherwise it
// is spilled. The total is conserved to rounding.
class Pouring {
 public:
  // World frame for the target. Without a target, all that pours is spilled.
  Pouring(const std::vector<double>& volumes, const std::optional<TaskData>& task, double gravity, double rate);

  // Updates the vessel's liquid for `seconds` at a tilt whose lip's lowest point is at `lip` (world frame), at tick `number`. Returns the flow, m3/s.
  double pour(int vessel, double held_back, core_f64::Vec3 lip, std::int64_t number, double seconds) noexcept;
  // Lands what has fallen by tick `number`.
  void land(std::int64_t number) noexcept;

  double volume(int vessel) const noexcept { return volume_[vessel]; }    // m3
  double arrived(int vessel) const noexcept { return arrived_[vessel]; }  // of that vessel's liquid in the target, m3
  double spilled(int vessel) const noexcept { return spilled_[vessel]; }  // m3

 private:
  struct Drop {
    std::int64_t lands = 0;  // tick
    int vessel = 0;
    double volume = 0;
  };
  std::array<double, LIVE_VESSELS> volume_{}, arrived_{}, spilled_{};
  std::optional<TaskData> task_;
  double gravity_, rate_;
  std::vector<Drop> falling_;  // a ring: `first_` lands first, or waits for those before it
  std::size_t first_ = 0, count_ = 0;
};

constexpr double POUR_TIME = 0.15;    // s
constexpr double LONGEST_FALL = 2;    // s: 20 m; also without gravity
constexpr double LEAST_DROP = 1e-15;  // m3: less is rounding and stays

}  // namespace wholehand::device
