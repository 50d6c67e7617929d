// SPDX-License-Identifier: MIT
// Where every vessel of a live session is. A tick has only the vessel that is touched, held or returning; the others are where they were last.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "device/session/tick.h"

namespace wholehand::device {

// World frame: of the vessel's origin, m, and vessel to world.
struct VesselPose {
  Triple place{};
  Rotation rotation{NO_ROTATION};
};
using VesselPoses = std::array<VesselPose, LIVE_VESSELS>;  // in the scene's order; entries without a vessel keep their first value

// The vessel that is touched, held or returning in a tick.
inline VesselPose vessel_pose(const Tick& tick) noexcept { return {tick.vessel_place, tick.vessel_rotation}; }

// Follows a session tick by tick: a Session keeps its own (Session::poses), and what has only its ticks needs another. Skipped ticks may hide the end
// of a vessel's way.
class VesselTracker {
 public:
  explicit VesselTracker(const Scene& scene);
  void follow(const Tick& tick) noexcept;
  const VesselPoses& poses() const noexcept { return poses_; }

 private:
  VesselPoses poses_{};
};

// Follows all ticks of a recording at once, and then knows any moment.
class VesselHistory {
 public:
  // `ticks` must outlive it.
  VesselHistory(const Scene& scene, std::span<const Tick> ticks);
  // At a tick, by its index in the recording.
  VesselPoses at(std::size_t tick) const noexcept;

 private:
  // Ticks first .. last that have one vessel.
  struct Stretch {
    std::size_t first = 0, last = 0;
  };
  std::span<const Tick> ticks_;
  VesselPoses start_;
  std::array<std::vector<Stretch>, LIVE_VESSELS> stretches_;
};

}  // namespace wholehand::device
