// SPDX-License-Identifier: MIT
#include "device/advice/moment.h"

#include "core/mirror.h"
#include "device/advice/present_grip.h"

namespace wholehand::device {

Advice advice_of(const LiveScene& live, const Tick& tick, const VesselPoses& poses, Adviser& adviser, std::size_t grips,
                 bool keeps_line, const std::atomic<bool>* stop) {
  Advice advice;
  if (const std::optional<Approach> approach = approach_of(live, tick, poses)) {
    const auto v = static_cast<std::size_t>(approach->vessel);
    advice = adviser.advise({approach->vessel, approach->is_held, approach->grip, tick.volume[v], keeps_line}, grips, stop);
    advice.handedness = live.scene.hand.handedness;
    advice.rotation = poses[v].rotation;
    if (approach->is_held) {
      core_f64::Hand yielding = live.hand;
      advice.ahead = tilts_ahead(live, tick, hand_posture(live, tick, poses, yielding).posed);
    }
  }
  advice.tick = tick.number;
  return advice;
}

ShownGrip shown_grip(const Scene& scene, const Advice& advice, const Adviser& adviser) {
  ShownGrip shown;
  if (advice.vessel < 0 || advice.is_held || !advice.best || !advice.is_better) return shown;
  const auto v = static_cast<std::size_t>(advice.vessel);
  const Mirror mirror(scene.hand.handedness);
  GripInput grip = mirror(advice.best->grip);
  grip.azimuth = grip.offset = 0;
  GripResult result;
  adviser.core().grip(v, mirror(grip), result);
  if (result.reason != Reason::none) return shown;
  shown = {advice.vessel, grip, result.gap, {}};
  const VesselData& vessel = scene.vessels[v];
  if (scene.task && !vessel.liquid_name.empty()) shown.path = PourPath(*scene.task, vessel, scene.hand, grip, result);
  return shown;
}

}  // namespace wholehand::device
