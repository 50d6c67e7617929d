// SPDX-License-Identifier: MIT
// sanitizers: address
#include "evidence/trials/predictions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evidence/trials/cases.h"
#include "sweeps/grips/report.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

constexpr double SAME_KERNELS = 1e-9;  // of numbers of size 1 that come by two ways through the same kernels

// The default scene with its hand's strength.
Scene strong_beakers() {
  Scene scene = three_beakers();
  scene.strength = StrengthData{};
  return scene;
}

GripInput good_grip() {
  GripInput grip;
  grip.height = 0.07;
  grip.roll = radians(-35);
  return grip;
}

std::vector<TrialCase> all_cases(const Scene& scene) {
  TrialOptions options;
  options.six_forces = true;
  return trial_cases(scene, *make_core_evaluator(scene), 0, options);
}

TEST(TrialPredictions, AreThoseOfAGripAndASweep) {
  const Scene scene = strong_beakers();
  const auto cases = all_cases(scene);
  const TrialPredictor predictor(scene, {});
  const GripPrediction found = predictor.predict(0, good_grip(), cases);
  sweeps::StateAxes axes{usual_fills(scene, *predictor.core(), 0), usual_tilts(scene)};
  sweeps::GripReport report =
      sweeps::make_grip_report(scene, 0, good_grip(), axes, sweeps::core_grip_methods(scene, predictor.core(), "core"));
  ASSERT_EQ(report.answer.result.reason, Reason::none);
  ASSERT_TRUE(report.answer.result.plausible);
  sweeps::add_holding(report, scene, 0);
  double worst = 0, tips = 0;
  for (std::size_t k = 0; k < report.holds.size(); ++k) {
    EXPECT_NEAR(found.cases[k].effort, report.holds[k].effort, SAME_KERNELS) << k;
    EXPECT_NEAR(found.cases[k].tips, report.holds[k].tips, SAME_KERNELS) << k;
    worst = std::max(worst, found.cases[k].effort);
    tips = std::max(tips, found.cases[k].tips);
  }
  EXPECT_GE(found.worst_effort, worst) << "of the ways to the states";
  EXPECT_GE(found.tips_worst_effort, tips);
  EXPECT_NEAR(found.scene_worst_effort, report.hold->worst, SAME_KERNELS);
  EXPECT_NEAR(found.push, report.hold->push, SAME_KERNELS);
  EXPECT_NEAR(found.friction_needed, report.hold->friction_needed, SAME_KERNELS);
  EXPECT_NEAR(found.score, report.answer.score.score, SAME_KERNELS);
  EXPECT_NEAR(found.terms[5], report.answer.score.terms.hold, SAME_KERNELS);
  EXPECT_GT(found.epsilon, 0);
}

TEST(TrialPredictions, AWayIsLookedAtEveryFiveDegrees) {
  const auto expect_tilts = [](double from, double to, const std::vector<double>& wanted) {
    const std::vector<double> found = leg_tilts(radians(from), radians(to));
    ASSERT_EQ(found.size(), wanted.size()) << from << " to " << to;
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], radians(wanted[k]), 1e-12) << from << " to " << to;
  };
  expect_tilts(0, 0, {0});
  expect_tilts(0, 15, {0, 5, 10, 15});
  expect_tilts(15, 30, {15, 20, 25, 30});
  expect_tilts(3, 12.5, {3, 5, 10, 12.5});
  expect_tilts(6, 9, {6, 9});
}

// The states of the way asked for one by one give the largest on it; a first tilt starts upright, and a push has no way.
TEST(TrialPredictions, EffortOfTheWayIsTheLargestOnIt) {
  const Scene scene = strong_beakers();
  const TrialPredictor predictor(scene, {});
  const auto case_at = [](double fill, double degrees) {
    TrialCase one;
    one.fill = fill;
    one.tilt = radians(degrees);
    return one;
  };
  const std::vector<TrialCase> cases{case_at(0.5, 20), case_at(1, 0), case_at(1, 150)};
  std::vector<TrialCase> each{case_at(0.5, 0), case_at(0.5, 5), case_at(0.5, 10), case_at(0.5, 15), case_at(0.5, 20)};
  for (int degrees = 0; degrees <= 150; degrees += 5) each.push_back(case_at(1, degrees));
  const GripPrediction found = predictor.predict(0, good_grip(), cases), all = predictor.predict(0, good_grip(), each);
  const auto largest = [&](std::size_t first, std::size_t last, double CasePrediction::*effort) {
    double most = 0;
    for (std::size_t k = first; k < last; ++k) most = std::max(most, all.cases[k].*effort);
    return most;
  };
  constexpr double NEAR = 1e-9;
  EXPECT_NEAR(found.cases[0].leg_effort, largest(0, 5, &CasePrediction::effort), NEAR);
  EXPECT_NEAR(found.cases[0].leg_tips, largest(0, 5, &CasePrediction::tips), NEAR);
  EXPECT_EQ(found.cases[1].leg_effort, found.cases[1].effort) << "upright from upright";
  EXPECT_NEAR(found.cases[2].leg_effort, largest(5, each.size(), &CasePrediction::effort), NEAR);
  EXPECT_NEAR(found.cases[2].leg_tips, largest(5, each.size(), &CasePrediction::tips), NEAR);
  EXPECT_GT(found.cases[2].leg_effort, 1.5 * found.cases[2].effort) << "poured out, it is easier to hold than on the way";
  EXPECT_EQ(found.worst_effort, std::max(found.cases[0].leg_effort, found.cases[2].leg_effort));
  EXPECT_EQ(found.tips_worst_effort, std::max(found.cases[0].leg_tips, found.cases[2].leg_tips));
  EXPECT_NEAR(all.worst_effort, found.worst_effort, NEAR) << "the same ways in smaller parts";
  for (const CasePrediction& push : predictor.predict(0, good_grip(), all_cases(scene)).cases)
    EXPECT_GE(push.leg_effort, push.effort);
}

// Twice the mass takes twice the effort; the mass is that of every state.
TEST(TrialPredictions, MassOfTheTrials) {
  const Scene scene = strong_beakers();
  const auto cases = all_cases(scene);
  TrialSettings light, heavy;
  light.mass = 0.3;
  heavy.mass = 0.6;
  const GripPrediction one = TrialPredictor(scene, light).predict(0, good_grip(), cases);
  const GripPrediction two = TrialPredictor(scene, heavy).predict(0, good_grip(), cases);
  for (std::size_t k = 0; k < 18; ++k) EXPECT_NEAR(two.cases[k].effort, 2 * one.cases[k].effort, 4e-3 * one.cases[k].effort) << k;
  EXPECT_NEAR(two.scene_worst_effort, 2 * one.scene_worst_effort, 4e-3 * one.scene_worst_effort);
  EXPECT_LT(two.score, one.score);
  EXPECT_LT(two.push, one.push);
  // what is more than the strength scores 0
  TrialSettings too_heavy;
  too_heavy.mass = 1.01 * 0.3 / one.scene_worst_effort;
  EXPECT_EQ(TrialPredictor(scene, too_heavy).predict(0, good_grip(), cases).score, 0);
  too_heavy.mass *= 0.98;
  EXPECT_GT(TrialPredictor(scene, too_heavy).predict(0, good_grip(), cases).score, 0);
  // the second material of six_forces has a mass of its own
  for (std::size_t k = 18; k < 24; ++k) EXPECT_EQ(two.cases[k].effort, one.cases[k].effort) << k;
}

TEST(TrialPredictions, FrictionOfTheTrials) {
  const Scene scene = strong_beakers();
  const auto cases = all_cases(scene);
  TrialSettings slippery;
  slippery.friction = 0.3;
  const TrialPredictor predictor(scene, slippery);
  const GripPrediction less = predictor.predict(0, good_grip(), cases),
                       more = TrialPredictor(scene, {}).predict(0, good_grip(), cases);
  for (std::size_t k = 0; k < 18; ++k) EXPECT_GT(less.cases[k].effort, more.cases[k].effort) << k;
  for (std::size_t k = 18; k < 24; ++k) EXPECT_EQ(less.cases[k].effort, more.cases[k].effort) << "has a friction of its own";
  EXPECT_LE(less.epsilon, more.epsilon);
  EXPECT_EQ(predictor.scene().force.friction, 0.3);
}

// A push against no weight: opposite directions of equal size, and proportional to the mass. A force of 10 m/s2 x mass.
TEST(TrialPredictions, PushesAreWithoutWeight) {
  const Scene scene = strong_beakers();
  const auto cases = all_cases(scene);
  TrialSettings settings;
  settings.materials = {{"scene"}, {"half", 0.05, 0.6, 20e-3}};
  TrialSettings twice = settings;
  twice.materials[1].mass = 0.1;
  const GripPrediction a = TrialPredictor(scene, settings).predict(0, good_grip(), cases);
  const GripPrediction b = TrialPredictor(scene, twice).predict(0, good_grip(), cases);
  for (std::size_t k = 18; k < 24; ++k) EXPECT_NEAR(b.cases[k].effort, 2 * a.cases[k].effort, 4e-3 * a.cases[k].effort);
  // down (-y) is what an upright vessel weighs, but for 10 and 9.80665 m/s2
  const GripPrediction c = TrialPredictor(scene, {}).predict(0, good_grip(), cases);
  EXPECT_NEAR(c.cases[15].effort / c.cases[8].effort, 10 / scene.gravity, 3e-3) << "fullest, upright";
}

}  // namespace
}  // namespace wholehand
