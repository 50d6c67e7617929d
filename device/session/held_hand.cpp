// SPDX-License-Identifier: MIT
#include "device/session/held_hand.h"

#include <algorithm>
#include <cmath>

#include "core/load.h"
#include "core/vectors.h"

namespace wholehand::device {

using core_f64::Vec3;

HeldHand::HeldHand(const LiveScene& live, const Tick& tick, const std::array<Triple, JOINT_COUNT>& posed)
    : live_(live), stance_(live.stance(vessel_pose(tick))) {
  std::array<Vec3, JOINT_COUNT> joints;
  for (std::size_t j = 0; j < JOINT_COUNT; ++j) joints[j] = stance_.inward(live.mirror.in(posed[j]));
  const Vec3 apart = joints[INDEX_TIP] - joints[THUMB_TIP];
  if (const double gap = glm::length(apart); gap > 0) pinch_ = apart / gap;
  grasp_.take(live, live.vessels[static_cast<std::size_t>(tick.vessel)].vessel, joints, tick.touch_mask);
  for (const core_f64::ContactPoint& contact : contacts())
    if (contact.is_tip) tips_.push_back(contact);
}

Triple HeldHand::place_out(Vec3 place) const { return live_.mirror.out(stance_.outward(place)); }

Triple HeldHand::turned_out(Vec3 v) const { return live_.mirror.out(stance_.rotation * v); }

Vec3 HeldHand::up() const { return glm::transpose(stance_.rotation) * Vec3(0, 1, 0); }

Vec3 HeldHand::pinch() const { return pinch_; }

double held_back(const LiveScene& live, std::size_t vessel, double volume, Vec3 up) {
  if (!(volume > 0)) return 0;
  const double sine = std::hypot(up.x, up.z);
  return std::min(volume, core_f64::lip_capacity(live.vessels[vessel].vessel, live.quadrature, sine, up.y));
}

core_f64::Wrench weight_of(const LiveScene& live, std::size_t vessel, double volume, Vec3 up) {
  const core_f64::Vessel& glass = live.vessels[vessel].vessel;
  const double sine = std::hypot(up.x, up.z);
  const Vec3 lean = sine > 0 ? Vec3(-up.x / sine, 0, -up.z / sine) : Vec3(1, 0, 0);
  core_f64::LiquidState liquid;
  liquid.height = glass.floor_height;
  double density = 0;
  if (volume > 0) {
    density = live.scene.liquid->density;
    liquid = core_f64::liquid_at(glass, live.quadrature, held_back(live, vessel, volume, up), sine, up.y);
  }
  const core_f64::Load load = core_f64::load_with(glass, density * volume, liquid.lean, liquid.height);
  return core_f64::wrench_at(core_f64::load_center(load, lean), -load.mass * live.scene.gravity * up);
}

}  // namespace wholehand::device
