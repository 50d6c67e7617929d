// SPDX-License-Identifier: MIT
#include "grips/holding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/counted_tilts.h"
#include "core/force.h"
#include "core/vectors.h"

namespace wholehand {
namespace {

using core_f64::ContactPoint;
using core_f64::Effort;
using core_f64::EffortSolver;
using core_f64::Vec3;
using core_f64::Wrench;

constexpr double INFINITE = std::numeric_limits<double>::infinity(), NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
constexpr double MOST_FRICTION = 10, FRICTION_STEP = 1e-3;
constexpr double PUSH_STEP = 1e-4;    // relative
constexpr double MOST_PUSH = 1e6;     // N
constexpr double SEARCH_STEP = 1e-4;  // of an effort that is compared with 1

}  // namespace

Holding::Holding(const Scene& scene, const Evaluator& evaluator, std::size_t vessel, const GripInput& grip,
                 const GripResult& result, const Triple& pour)
    : scene_(scene), evaluator_(evaluator), vessel_(vessel), grip_(grip), result_(result), pour_(pour) {
  for (const GripContact& found : evaluator.contacts(vessel, result)) {
    joints_.push_back(found.joint);
    contacts_.push_back({to_vec3<double>(found.point), to_vec3<double>(found.normal), found.digit});
    if (found.joint == THUMB_TIP || found.joint == INDEX_TIP) tips_.push_back(contacts_.back());
    center_ += contacts_.back().place;
  }
  if (!contacts_.empty()) center_ /= static_cast<double>(contacts_.size());
  hand_.friction = scene.force.friction;
  hand_.torsion = scene.force.torsion;
  hand_.digits = scene.strength.value().digits;
}

// The weight at the centre of mass. Up in the vessel frame at a tilt t: cos t y - sin t n.
Wrench Holding::load(const StateResult& state, double tilt) const {
  const Vec3 up = core_f64::up_direction(to_vec3<double>(pour_), std::sin(tilt), std::cos(tilt));
  return core_f64::wrench_at(to_vec3<double>(state.center_of_mass), -state.mass * scene_.gravity * up);
}

StateHold Holding::state(const GripState& state) const {
  if (!state.counts) return {NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, std::nullopt, {}};
  const Wrench weight = load(state.state, state.tilt);
  EffortSolver solver(contacts_, hand_, center_);
  const Effort found = solver.solve(weight);
  StateHold hold;
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
                             to_triple(forces[i].force), forces[i].torsion});
  }
  return hold;
}

GripState Holding::loaded(double fill, double tilt) const {
  GripState state{fill, tilt, {}, {}};
  if (scene_.liquid) state.liquid = evaluator_.liquid(vessel_, fill, tilt);
  state.state = evaluator_.state(vessel_, grip_, result_, state.liquid, tilt);
  return state;
}

// Each state begins with the basis of the last. Where this basis holds the next load within the largest effort so far, nothing is solved.
std::optional<GripHold> Holding::over_states() const {
  const StateAxes axes = scene_axes(scene_, vessel_);
  if (axes.tilts.empty()) return std::nullopt;
  GripHold hold;
  hold.worst = hold.tips_worst = -1;
  EffortSolver whole(contacts_, hand_, center_), tips(tips_, hand_, center_);
  Wrench worst;
  const auto look = [](EffortSolver& solver, const Wrench& weight, double& largest, int& pivots) {
    if (solver.bound(weight) <= largest) return 0;
    const Effort found = solver.solve(weight);
    pivots += found.pivots;
    if (!(found.effort > largest)) return 1;
    largest = found.effort;
    return 2;
  };
  const std::vector<std::size_t> counted = counted_tilts(scene_, vessel_);
  for (std::size_t f = 0; f < axes.fills.size(); ++f) {
    const double fill = axes.fills[f];
    for (std::size_t t = 0; t < counted[f]; ++t) {
      const double tilt = axes.tilts[t];
      const Wrench weight = load(loaded(fill, tilt).state, tilt);
      ++hold.states;
      int tips_pivots = 0;
      if (std::isfinite(hold.tips_worst)) look(tips, weight, hold.tips_worst, tips_pivots);
      if (std::isinf(hold.worst)) continue;
      const int seen = look(whole, weight, hold.worst, hold.pivots);
      hold.skipped += seen == 0;
      if (seen < 2) continue;
      hold.worst_fill = fill;
      hold.worst_tilt = tilt;
      worst = weight;
    }
  }
  hold.push = push();
  hold.friction_needed = friction_for(worst);
  return hold;
}

double Holding::push() const {
  const double fullest = scene_axes(scene_, vessel_).fills.back();
  const StateResult upright = loaded(fullest, 0).state;
  const Wrench weight = load(upright, 0);
  double least = INFINITE;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sense : {1.0, -1.0}) {
      Vec3 direction(0);
      direction[axis] = sense;
      least = std::min(least, push_along(weight, to_vec3<double>(upright.center_of_mass), direction));
    }
  return least;
}

// The effort is convex along a line of loads: what holds weight and push, holds everything between.
double Holding::push_along(const Wrench& weight, const Vec3& center, const Vec3& direction) const {
  EffortSolver solver(contacts_, hand_, center_);
  const auto is_held = [&](double force) {
    const Wrench push = core_f64::wrench_at(center, force * direction);
    const Wrench both{weight.force + push.force, weight.moment + push.moment};
    return solver.bound(both) <= 1 || solver.solve(both, SEARCH_STEP).effort <= 1;
  };
  if (!is_held(0)) return 0;
  double low = 0, high = 1;
  for (; high < MOST_PUSH && is_held(high); high *= 2) low = high;
  while (high - low > PUSH_STEP * high) {
    const double middle = 0.5 * (low + high);
    (is_held(middle) ? low : high) = middle;
  }
  return low;
}

// More friction holds everything that less holds.
double Holding::friction_for(const Wrench& load) const {
  const auto is_held = [&](double friction) {
    core_f64::HandStrength hand = hand_;
    hand.friction = friction;
    return EffortSolver(contacts_, hand, center_).solve(load, SEARCH_STEP).effort <= 1;
  };
  if (is_held(0)) return 0;
  if (!is_held(MOST_FRICTION)) return INFINITE;
  double low = 0, high = MOST_FRICTION;
  while (high - low > FRICTION_STEP) {
    const double middle = 0.5 * (low + high);
    (is_held(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace wholehand
