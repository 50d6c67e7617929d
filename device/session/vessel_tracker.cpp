// SPDX-License-Identifier: MIT
#include "device/session/vessel_tracker.h"

#include <algorithm>

namespace wholehand::device {

VesselTracker::VesselTracker(const Scene& scene) {
  for (std::size_t v = 0; v < std::min(scene.vessels.size(), poses_.size()); ++v) poses_[v].place = scene.vessels[v].place;
}

void VesselTracker::follow(const Tick& tick) noexcept {
  if (tick.vessel >= 0 && tick.vessel < LIVE_VESSELS) poses_[tick.vessel] = vessel_pose(tick);
}

VesselHistory::VesselHistory(const Scene& scene, std::span<const Tick> ticks)
    : ticks_(ticks), start_(VesselTracker(scene).poses()) {
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const int v = ticks[k].vessel;
    if (v < 0 || v >= LIVE_VESSELS) continue;
    if (k > 0 && ticks[k - 1].vessel == v) {
      stretches_[v].back().last = k;
    } else {
      stretches_[v].push_back({k, k});
    }
  }
}

VesselPoses VesselHistory::at(std::size_t tick) const noexcept {
  VesselPoses poses = start_;
  for (std::size_t v = 0; v < poses.size(); ++v) {
    // the last stretch that has begun by then
    const auto after = std::upper_bound(stretches_[v].begin(), stretches_[v].end(), tick,
                                        [](std::size_t moment, const Stretch& stretch) { return moment < stretch.first; });
    if (after == stretches_[v].begin()) continue;
    poses[v] = vessel_pose(ticks_[std::min(std::prev(after)->last, tick)]);
  }
  return poses;
}

}  // namespace wholehand::device
