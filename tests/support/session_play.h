// SPDX-License-Identifier: MIT
// Sessions that are played through: a tick for each state that a gripper was in.
#pragma once

#include <functional>
#include <vector>

#include "core/vectors.h"
#include "device/session/session.h"
#include "device/session/workspace.h"
#include "tests/support/live_script.h"

namespace wholehand {

// All ticks of a way through a scene: the state of each by a function.
inline std::vector<device::Tick> play_session(
    const Scene& scene, const std::function<device::GripperState(std::int64_t)>& at, std::int64_t ticks,
    const std::function<std::int64_t(std::int64_t)>& next = [](std::int64_t n) { return n + 1; }) {
  device::Session session(scene, own_gap(scene.hand));
  std::vector<device::Tick> record;
  device::Tick tick;
  for (std::int64_t n = 0; n < ticks; n = next(n)) {
    session.step(at(n), n, tick);
    record.push_back(tick);
  }
  return record;
}

inline LiveScript script_for(const Scene& scene) {
  LiveScript script;
  script.vessel = scene.vessels[0].place;
  return script;
}

inline std::vector<device::Tick> play_session(const Scene& scene, const LiveScript& script) {
  return play_session(
      scene, [&](std::int64_t n) { return script.at(n); }, static_cast<std::int64_t>(script.seconds() * script.rate));
}

inline double liquid_in_sight(const device::Tick& tick, int v) {
  const auto k = static_cast<std::size_t>(v);
  return tick.volume[k] + tick.arrived[k] + tick.spilled[k];
}

// Straight above the hand's own frame: the gripper at NO_ROTATION.
inline device::GripperState gripper_at(core_f64::Vec3 middle, double gap) {
  device::GripperState state;
  state.position = to_triple(middle);
  state.gap = gap;
  return state;
}

}  // namespace wholehand
