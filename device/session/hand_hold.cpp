// SPDX-License-Identifier: MIT
#include "device/session/hand_hold.h"

#include "core/grip_effort.h"
#include "device/session/held_hand.h"

namespace wholehand::device {

using core_f64::Effort;
using core_f64::EffortSolver;
using core_f64::Vec3;
using core_f64::Wrench;

std::optional<HandHold> hand_hold(const LiveScene& live, const Tick& tick, const std::array<Triple, JOINT_COUNT>& posed) {
  const Scene& scene = live.scene;
  if (!scene.strength || tick.vessel < 0 || !is_held(tick.state)) return std::nullopt;
  const auto v = static_cast<std::size_t>(tick.vessel);
  const HeldHand held(live, tick, posed);
  const core_f64::HandStrength hand = held.strength();
  const Wrench weight = weight_of(live, v, tick.volume[v], held.up());
  EffortSolver solver(held.contacts(), hand, held.center());
  const Effort found = solver.solve(weight);
  HandHold hold{
      found.effort, found.low, EffortSolver(held.tips(), hand, held.center()).solve(weight).effort, hand.weaker_tip(), {}};
  std::vector<core_f64::ContactForce> forces(held.contacts().size());
  solver.forces(forces);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (forces[i].force == Vec3(0)) continue;
    const core_f64::ContactPoint& contact = held.contacts()[i];
    hold.presses.push_back(
        {contact.digit, held.place_out(contact.place), held.turned_out(contact.normal), held.turned_out(forces[i].force)});
  }
  return hold;
}

}  // namespace wholehand::device
