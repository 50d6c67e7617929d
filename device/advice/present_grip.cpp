// SPDX-License-Identifier: MIT
#include "device/advice/present_grip.h"

#include <algorithm>
#include <cmath>

#include "core/contact.h"
#include "core/vectors.h"
#include "device/advice/cloud.h"
#include "device/session/grip_of_tips.h"

namespace wholehand::device {

using core_f64::Mat3;
using core_f64::Vec3;

namespace {

std::array<Vec3, 2> tips_in(const LiveScene& live, const Tick& tick, const Stance& stance) {
  return {stance.inward(live.mirror.in(tick.proxies[0])), stance.inward(live.mirror.in(tick.proxies[1]))};
}

// How far the further of the two tips is from the surface, m.
double away_from(const LiveScene& live, std::size_t v, const std::array<Vec3, 2>& tips) {
  const core_f64::Hand& hand = live.hand;
  const std::array<double, 2> radii{hand.scale * hand.radius[0][3], hand.scale * hand.radius[1][4]};
  double away = 0;
  for (std::size_t k = 0; k < 2; ++k) away = std::max(away, core_f64::separation_at(live.vessels[v].vessel, tips[k], radii[k]));
  return away;
}

int vessel_of(const LiveScene& live, const Tick& tick, const VesselPoses& poses) {
  if (tick.vessel >= 0) return tick.vessel;
  int nearest = -1;
  double least = NEAR_VESSEL;
  for (std::size_t v = 0; v < live.vessels.size(); ++v) {
    const double away = away_from(live, v, tips_in(live, tick, live.stance(poses[v])));
    if (away > least) continue;
    least = away;
    nearest = static_cast<int>(v);
  }
  return nearest;
}

}  // namespace

std::optional<Approach> approach_of(const LiveScene& live, const Tick& tick, const VesselPoses& poses) {
  if (tick.state == SessionState::released || is_returning(tick.state)) return std::nullopt;
  const int vessel = vessel_of(live, tick, poses);
  if (vessel < 0) return std::nullopt;
  const Stance stance = live.stance(poses[static_cast<std::size_t>(vessel)]);
  const Mat3 axes = glm::transpose(stance.rotation) * live.mirror.in(tick.hand_rotation);
  const std::optional<GripInput> grip = grip_of_tips(tips_in(live, tick, stance), axes);
  if (!grip) return std::nullopt;
  const VesselData& data = live.scene.vessels[static_cast<std::size_t>(vessel)];
  // a hand that is over the vessel, or under it, is not at it
  if (grip->height < data.base - REACH_HEIGHT || grip->height > data.height + REACH_HEIGHT) return std::nullopt;
  return Approach{vessel, is_held(tick.state), live.mirror(*grip)};
}

}  // namespace wholehand::device
