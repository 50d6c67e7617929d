// SPDX-License-Identifier: MIT
#include "advice/shown.h"

#include "core/mirror.h"

namespace wholehand {

ShownGrip shown_grip(const Scene& scene, const Advice& advice, const Adviser& adviser) {
  ShownGrip shown;
  if (advice.vessel < 0 || advice.is_held || !advice.best || !advice.is_better) return shown;
  const auto v = static_cast<std::size_t>(advice.vessel);
  const Handedness handedness = scene.hand.handedness;
  GripInput grip = mirrored(advice.best->grip, handedness);
  grip.azimuth = grip.offset = 0;
  GripResult result;
  adviser.core().grip(v, mirrored(grip, handedness), result);
  if (result.reason != Reason::none) return shown;
  shown = {advice.vessel, grip, result.gap, {}};
  const VesselData& vessel = scene.vessels[v];
  if (scene.task && !vessel.liquid_name.empty()) shown.path = PourPath(*scene.task, vessel, scene.hand, grip, result);
  return shown;
}

}  // namespace wholehand
