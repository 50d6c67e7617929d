// SPDX-License-Identifier: MIT
#include "sweeps/grips/holding.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "core/counted_tilts.h"
#include "core/force.h"
#include "core/grip_effort.h"
#include "core/load.h"
#include "core/vectors.h"

namespace wholehand::sweeps {
namespace {

using core_f64::ContactPoint;
using core_f64::DIGITS;
using core_f64::Effort;
using core_f64::EffortSolver;
using core_f64::Load;
using core_f64::Vec3;
using core_f64::Wrench;

constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Holding::Holding(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripResult& result, const Triple& pour)
    : scene_(scene), evaluator_(evaluator), vessel_(vessel), pour_(pour) {
  for (const GripContact& found : evaluator.contacts(vessel, result)) {
    joints_.push_back(found.joint);
    between_.push_back(found.between);
    contacts_.push_back({to_vec3<double>(found.point), to_vec3<double>(found.normal), found.digit, found.is_tip});
    if (found.is_tip) tips_.push_back(contacts_.back());
  }
  center_ = core_f64::contacts_center(contacts_);
  hand_ = core_f64::load_strength(scene, result);
}

// The weight at the center of mass. Up in the vessel frame at a tilt t: cos t y - sin t n.
Wrench Holding::load(const StateResult& state, double tilt) const {
  const Vec3 up = core_f64::up_direction(to_vec3<double>(pour_), std::sin(tilt), std::cos(tilt));
  return core_f64::wrench_at(to_vec3<double>(state.center_of_mass), -state.mass * scene_.gravity * up);
}

StateHold Holding::state(const GripState& state) const {
  if (!state.counts) return {NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, hand_, std::nullopt, {}, std::nullopt};
  const Wrench weight = load(state.state, state.tilt);
  EffortSolver solver(contacts_, hand_, center_);
  const Effort found = solver.solve(weight);
  StateHold hold;
  hold.strength = hand_;
  hold.effort = found.effort;
  hold.low = found.low;
  hold.tips = EffortSolver(tips_, hand_, center_).solve(weight).effort;
  if (std::isinf(found.effort)) {
    const auto& escape = found.escape;
    const Vec3 turning(escape[3], escape[4], escape[5]);
    const Vec3 arm = to_vec3<double>(state.state.center_of_mass) - center_;
    const Vec3 moving = Vec3(escape[0], escape[1], escape[2]) + glm::cross(turning, arm);
    hold.escape = {moving.x, moving.y, moving.z, turning.x, turning.y, turning.z};
  }
  std::vector<core_f64::ContactForce> forces(contacts_.size());
  solver.forces(forces);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    hold.contacts.push_back({joints_[i], contacts_[i].digit, to_triple(contacts_[i].place), to_triple(contacts_[i].normal),
                             to_triple(forces[i].force), forces[i].torsion, between_[i]});
  }
  return hold;
}

std::optional<FingerShares> Holding::shares(const GripState& state, const StateHold& hold) const {
  if (!std::isfinite(hold.effort) || hold.effort == 0) return std::nullopt;
  std::array<double, DIGITS> pressed{};
  std::array<bool, DIGITS> has_contact{};
  for (const HeldContact& contact : hold.contacts) {
    const auto digit = static_cast<std::size_t>(contact.digit);
    pressed[digit] += dot(contact.force, contact.normal);
    has_contact[digit] = true;
  }
  const double sum = std::accumulate(pressed.begin() + 1, pressed.begin() + FINGER_COUNT, 0.0);
  const double enough = SHARE_ROOM * hold.effort;
  const Wrench weight = load(state.state, state.tilt);
  EffortSolver solver(contacts_, hand_, center_);
  const auto is_allowed = [&](int digit, double share, bool is_least) {
    solver.set_share({digit, share, is_least});
    return solver.solve(weight, core_f64::EFFORT_TOLERANCE, enough, enough).effort <= enough;
  };
  // From a share that is allowed to one that may not be: the set of forces is convex, and so are the allowed shares.
  const auto end_of_range = [&](int digit, double from, double to, bool is_least) {
    if (is_allowed(digit, to, is_least)) return to;
    while (std::abs(to - from) > SHARE_STEP) {
      const double middle = (from + to) / 2;
      (is_allowed(digit, middle, is_least) ? from : to) = middle;
    }
    return from;
  };
  FingerShares shares;
  for (std::size_t k = 0; k < shares.share.size(); ++k) {
    const auto digit = static_cast<int>(k) + 1;
    const double share = sum > 0 ? pressed[k + 1] / sum : NOT_A_NUMBER;
    shares.share[k] = shares.least[k] = shares.most[k] = share;
    if (!(sum > 0) || !has_contact[k + 1]) continue;
    shares.least[k] = end_of_range(digit, share, 0, false);
    shares.most[k] = end_of_range(digit, share, 1, true);
  }
  return shares;
}

// Vessel and liquid, at one fill and tilt.
Load Holding::load_at(double fill, double tilt) const {
  const VesselConstants constants = evaluator_.constants(vessel_);
  const LiquidResult liquid = scene_.liquid ? evaluator_.liquid(vessel_, fill, tilt) : LiquidResult{};
  const double mass = constants.mass + liquid.mass, share = mass > 0 ? liquid.mass / mass : 0;
  return {mass, (1 - share) * to_vec3<double>(constants.center_of_mass), share * liquid.lean, share * liquid.height};
}

std::optional<GripHold> Holding::over_states() const {
  const StateAxes axes = scene_axes(scene_, vessel_);
  if (axes.tilts.empty()) return std::nullopt;
  std::vector<Load> loads;
  for (const double fill : axes.fills)
    for (const double tilt : axes.tilts) loads.push_back(load_at(fill, tilt));
  std::vector<core_f64::StateTilt> tilts;
  for (const double tilt : axes.tilts) tilts.push_back({std::sin(tilt), std::cos(tilt)});
  const std::vector<std::size_t> counted = counted_tilts(scene_, vessel_);
  const core_f64::GripLoads states{loads, tilts, counted, to_vec3<double>(pour_), scene_.gravity};
  std::vector<core_f64::FillEffort> fills(axes.fills.size());
  const core_f64::GripEffort found = core_f64::grip_effort(contacts_, tips_, hand_, states, fills);
  GripHold hold;
  hold.worst = found.worst;
  hold.worst_fill = axes.fills[found.fill];
  hold.worst_tilt = axes.tilts[found.tilt];
  hold.tips_worst = found.tips_worst;
  hold.states = found.states;
  hold.skipped = found.skipped;
  hold.pivots = found.pivots;
  const Load fullest = load_at(axes.fills.back(), 0);
  hold.push = core_f64::push_held(contacts_, hand_, states.weight(fullest, {}), core_f64::load_center(fullest, states.pour));
  hold.friction_needed = core_f64::friction_needed(contacts_, hand_, states, found);
  return hold;
}

}  // namespace wholehand::sweeps
