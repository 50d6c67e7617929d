// SPDX-License-Identifier: MIT
#include "evidence/trials/predictions.h"

#include <algorithm>
#include <cmath>

#include "core/counted_tilts.h"
#include "core/force.h"
#include "core/grip_effort.h"
#include "core/load.h"
#include "core/planes.h"
#include "core/score.h"
#include "core/vectors.h"
#include "sweeps/grips/methods.h"
#include "sweeps/grips/quality.h"
#include "sweeps/grips/report.h"

namespace wholehand {

using core_f64::ContactPoint;
using core_f64::EffortSolver;
using core_f64::HandStrength;
using core_f64::Load;
using core_f64::Vec3;
using core_f64::Wrench;

namespace {

constexpr double NO_VALUE = std::numeric_limits<double>::quiet_NaN();

Scene with_friction(Scene scene, const TrialSettings& settings) {
  if (!std::isnan(settings.friction)) scene.force.friction = settings.friction;
  return scene;
}

}  // namespace

// A grip with its contacts.
struct TrialPredictor::Held {
  std::size_t vessel = 0;
  GripInput grip;
  GripResult result;
  Vec3 pour{};
  std::vector<ContactPoint> contacts, tips;
  HandStrength hand;
};

std::vector<double> leg_tilts(double from, double to) {
  constexpr double NEAR = 1e-9;  // rad: a whole step that is one of the ends, but for rounding
  std::vector<double> tilts{from};
  for (double step = std::floor(from / LEG_STEP); step * LEG_STEP < to - NEAR; ++step)
    if (step * LEG_STEP > from + NEAR) tilts.push_back(step * LEG_STEP);
  if (to > from) tilts.push_back(to);
  return tilts;
}

TrialPredictor::TrialPredictor(const Scene& scene, const TrialSettings& settings)
    : scene_(with_friction(scene, settings)), settings_(settings), core_(make_core_evaluator(scene_)) {
  for (std::size_t v = 0; v < scene_.vessels.size(); ++v) states_.push_back(states_of(v));
}

double TrialPredictor::mass_of(double state) const { return std::isnan(settings_.mass) ? state : settings_.mass; }

GripPrediction TrialPredictor::predict(std::size_t vessel, const GripInput& grip, const std::vector<TrialCase>& cases) const {
  Held held{vessel, grip, {}, to_vec3<double>(sweeps::pour_direction(scene_, grip)), {}, {}, {}};
  core_->grip(vessel, grip, held.result);
  for (const GripContact& found : core_->contacts(vessel, held.result)) {
    held.contacts.push_back({to_vec3<double>(found.point), to_vec3<double>(found.normal), found.digit, found.is_tip});
    if (found.is_tip) held.tips.push_back(held.contacts.back());
  }
  held.hand = core_f64::load_strength(scene_, held.result);
  GripPrediction prediction;
  prediction.worst_effort = prediction.tips_worst_effort = NO_VALUE;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const TrialCase& one = cases[k];
    CasePrediction& found = prediction.cases.emplace_back(predict_case(held, one));
    if (one.protocol != TrialProtocol::fill_tilt) continue;
    const bool goes_on = k > 0 && cases[k - 1].protocol == one.protocol && cases[k - 1].fill == one.fill;
    predict_leg(held, one, goes_on ? cases[k - 1].tilt : 0, found);
    prediction.worst_effort = std::fmax(prediction.worst_effort, found.leg_effort);
    prediction.tips_worst_effort = std::fmax(prediction.tips_worst_effort, found.leg_tips);
  }
  predict_states(held, prediction);
  predict_scores(held, prediction);
  const sweeps::GripQuality quality = sweeps::grip_quality(scene_, *core_, vessel, held.result, TRIAL_FACETS);
  prediction.epsilon = 0.5 * (quality.wrenches.epsilon[0] + quality.wrenches.epsilon[1]);
  return prediction;
}

// The weight at a tilt; or the push along a direction, without weight.
CasePrediction TrialPredictor::predict_case(const Held& held, const TrialCase& one) const {
  const bool is_push = one.protocol == TrialProtocol::six_forces;
  const double tilt = is_push ? 0 : one.tilt;
  const LiquidResult liquid = scene_.liquid ? core_->liquid(held.vessel, one.fill, tilt) : LiquidResult{};
  const StateResult state = core_->state(held.vessel, held.grip, held.result, liquid, tilt);
  double mass = mass_of(state.mass);
  HandStrength hand = held.hand;
  Vec3 force = -mass * scene_.gravity * core_f64::up_direction(held.pour, std::sin(tilt), std::cos(tilt));
  if (is_push) {
    const TrialMaterial& material = settings_.materials[static_cast<std::size_t>(one.material)];
    if (!std::isnan(material.mass)) mass = material.mass;
    if (!std::isnan(material.friction)) hand.friction = material.friction;
    if (!std::isnan(material.torsion)) hand.torsion = material.torsion;
    force = Vec3(0);
    force[one.direction / 2] = (one.direction % 2 == 0 ? 1 : -1) * mass * settings_.push_acceleration;
  }
  const Wrench load = core_f64::wrench_at(to_vec3<double>(state.center_of_mass), force);
  const Vec3 center = core_f64::contacts_center(held.contacts);
  const double effort = EffortSolver(held.contacts, hand, center).solve(load).effort;
  const double tips = EffortSolver(held.tips, hand, center).solve(load).effort;
  return {effort, tips, effort, tips};
}

// `prediction` is that of the case itself, where the way ends.
void TrialPredictor::predict_leg(const Held& held, const TrialCase& one, double from, CasePrediction& prediction) const {
  for (const double tilt : leg_tilts(from, one.tilt)) {
    if (tilt == one.tilt) continue;
    TrialCase on_the_way = one;
    on_the_way.tilt = tilt;
    const CasePrediction found = predict_case(held, on_the_way);
    prediction.leg_effort = std::max(prediction.leg_effort, found.effort);
    prediction.leg_tips = std::max(prediction.leg_tips, found.tips);
  }
}

TrialPredictor::States TrialPredictor::states_of(std::size_t vessel) const {
  const sweeps::StateAxes axes = sweeps::scene_axes(scene_, vessel);
  const VesselConstants constants = core_->constants(vessel);
  const auto load_at = [&](double fill, double tilt) {
    const LiquidResult liquid = scene_.liquid ? core_->liquid(vessel, fill, tilt) : LiquidResult{};
    const double mass = constants.mass + liquid.mass, share = mass > 0 ? liquid.mass / mass : 0;
    return Load{mass_of(mass), (1 - share) * to_vec3<double>(constants.center_of_mass), share * liquid.lean, share * liquid.height};
  };
  States states;
  for (const double fill : axes.fills)
    for (const double tilt : axes.tilts) states.loads.push_back(load_at(fill, tilt));
  for (const double tilt : axes.tilts) states.tilts.push_back({std::sin(tilt), std::cos(tilt)});
  states.counted = counted_tilts(scene_, vessel);
  states.fullest = load_at(axes.fills.back(), 0);
  return states;
}

// Over the scene's own states, as a sweep.
void TrialPredictor::predict_states(const Held& held, GripPrediction& prediction) const {
  const States& of = states_[held.vessel];
  const core_f64::GripLoads states{of.loads, of.tilts, of.counted, held.pour, scene_.gravity};
  std::vector<core_f64::FillEffort> fills(of.counted.size());
  const core_f64::GripEffort found = core_f64::grip_effort(held.contacts, std::nullopt, held.hand, states, fills);
  prediction.scene_worst_effort = found.worst;
  prediction.friction_needed = core_f64::friction_needed(held.contacts, held.hand, states, found);
  prediction.push =
      core_f64::push_held(held.contacts, held.hand, states.weight(of.fullest, {}), core_f64::load_center(of.fullest, states.pour));
}

void TrialPredictor::predict_scores(const Held& held, GripPrediction& prediction) const {
  const ScoreTerms terms = core_->score(held.vessel, held.grip, held.result).terms;
  prediction.terms = {
      terms.fingers, terms.contacts,
      terms.depth,   terms.posture,
      terms.force,   std::isnan(settings_.mass) ? terms.hold : core_f64::effort_term(prediction.scene_worst_effort)};
  const std::array<double, 6> weights = effective_weights(scene_);
  for (std::size_t k = 0; k < SCORE_TERM_COUNT; ++k) prediction.score += weights[k] * prediction.terms[k];
  if (!core_f64::effort_holds(prediction.scene_worst_effort)) prediction.score = 0;
}

}  // namespace wholehand
