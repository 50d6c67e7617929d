// SPDX-License-Identifier: MIT
#include "live/hand_hold.h"

#include <algorithm>
#include <cmath>

#include "core/contacts.h"
#include "core/grip_effort.h"
#include "core/held.h"
#include "core/mirror.h"
#include "core/vectors.h"

namespace wholehand {

using core_f64::ContactPoint;
using core_f64::Effort;
using core_f64::EffortSolver;
using core_f64::Mat3;
using core_f64::Vec3;
using core_f64::Wrench;

namespace {

// The weight in the vessel frame, of the right hand's world. What is above the lip weighs at the place of the rest, as in Session.
Wrench weight_of(const LiveScene& live, const Tick& tick, Vec3 up) {
  const auto v = static_cast<std::size_t>(tick.vessel);
  const core_f64::Vessel& glass = live.vessels[v].vessel;
  const double sine = std::hypot(up.x, up.z);
  const Vec3 lean = sine > 0 ? Vec3(-up.x / sine, 0, -up.z / sine) : Vec3(1, 0, 0);
  core_f64::LiquidState liquid;
  liquid.height = glass.floor_height;
  double density = 0;
  if (tick.volume[v] > 0) {
    density = live.scene.liquid->density;
    const double held_back = core_f64::lip_capacity(glass, live.quadrature, sine, up.y);
    liquid = core_f64::liquid_at(glass, live.quadrature, std::min(tick.volume[v], held_back), sine, up.y);
  }
  const core_f64::Load load = core_f64::load_with(glass, density * tick.volume[v], liquid.lean, liquid.height);
  return core_f64::wrench_at(core_f64::load_center(load, lean), -load.mass * live.scene.gravity * up);
}

}  // namespace

std::optional<HandHold> hand_hold(const LiveScene& live, const Tick& tick, const VesselPose& vessel,
                                  const std::array<Triple, JOINT_COUNT>& posed) {
  const Scene& scene = live.scene;
  if (!scene.strength || tick.vessel < 0 || !is_held(tick.state)) return std::nullopt;
  const Handedness handedness = scene.hand.handedness;
  const Vec3 place = to_vec3(mirrored(vessel.place, handedness));
  const Mat3 turn = mirrored(to_mat3(vessel.rotation), handedness), back = glm::transpose(turn);
  std::array<Vec3, JOINT_COUNT> joints;
  for (std::size_t j = 0; j < JOINT_COUNT; ++j) joints[j] = back * (to_vec3(mirrored(posed[j], handedness)) - place);
  std::array<core_f64::PressingJoint, JOINT_COUNT> pressing;
  const int count = core_f64::find_contacts(live.hand, live.vessels[static_cast<std::size_t>(tick.vessel)].vessel, joints,
                                            core_f64::placed_scale(live.hand, joints), tick.touch_mask, pressing);
  std::vector<ContactPoint> contacts, tips;
  for (int i = 0; i < count; ++i) {
    const auto& [joint, between, contact] = pressing[static_cast<std::size_t>(i)];
    contacts.push_back(contact);
    if (between == 0 && (joint == THUMB_TIP || joint == INDEX_TIP)) tips.push_back(contact);
  }
  const Vec3 center = core_f64::contacts_center(contacts);
  const core_f64::HandStrength hand{scene.force.friction, scene.force.torsion, scene.strength->digits};
  const Wrench weight = weight_of(live, tick, back * Vec3(0, 1, 0));
  EffortSolver solver(contacts, hand, center);
  const Effort found = solver.solve(weight);
  HandHold hold{found.effort, found.low, EffortSolver(tips, hand, center).solve(weight).effort, scene.strength->weaker_tip(), {}};
  std::vector<core_f64::ContactForce> forces(contacts.size());
  solver.forces(forces);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (forces[i].force == Vec3(0)) continue;
    const auto out = [&](Vec3 v) { return mirrored(to_triple(turn * v), handedness); };
    hold.presses.push_back({contacts[i].digit, mirrored(to_triple(place + turn * contacts[i].place), handedness),
                            out(contacts[i].normal), out(forces[i].force)});
  }
  return hold;
}

}  // namespace wholehand
