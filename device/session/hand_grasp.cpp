// SPDX-License-Identifier: MIT
#include "device/session/hand_grasp.h"

#include "core/grip_effort.h"
#include "core/load.h"

namespace wholehand::device {

using core_f64::Vec3;

void HandGrasp::take(const LiveScene& live, const core_f64::Vessel& vessel, const std::array<Vec3, JOINT_COUNT>& posed,
                     std::uint32_t touching) noexcept {
  const double scale = core_f64::placed_scale(live.hand, posed);
  std::array<core_f64::PressingJoint, JOINT_COUNT> pressing;
  count_ = static_cast<std::size_t>(core_f64::find_contacts(live.hand, vessel, posed, scale, touching, pressing));
  for (std::size_t k = 0; k < count_; ++k) contacts_[k] = pressing[k].contact;
  strength_ = core_f64::load_strength(live.scene, glm::length(posed[INDEX_TIP] - posed[THUMB_TIP]), scale);
  center_ = core_f64::contacts_center(contacts());
}

double HandGrasp::hold_force(Vec3 center, Vec3 weight) const noexcept {
  core_f64::EffortSolver solver(contacts(), strength_, center_);
  return solver.solve(core_f64::wrench_at(center, weight)).effort * strength_.weaker_tip();
}

}  // namespace wholehand::device
