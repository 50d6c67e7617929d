// SPDX-License-Identifier: MIT
// What holding takes over the states of a grip: every number against its definition, by searches that know nothing of shortcuts.
#include "sweeps/grips/holding.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/files/json.h"
#include "core/vectors.h"
#include "sweeps/grips/report.h"
#include "sweeps/grips/states.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

using core_f64::EffortSolver;
using core_f64::Vec3;
using core_f64::Wrench;

GripReport held_report(const Scene& scene, std::size_t vessel, const GripInput& grip) {
  GripReport report = make_grip_report(scene, vessel, grip, scene_axes(scene, vessel),
                                       core_grip_methods(scene, make_core_evaluator(scene), "core"));
  add_holding(report, scene, vessel);
  return report;
}

GripInput beside(double height, double roll = 0) {
  GripInput grip;
  grip.height = height;
  grip.roll = radians(roll);
  return grip;
}

std::vector<core_f64::ContactPoint> contacts_of(const StateHold& hold) {
  std::vector<core_f64::ContactPoint> contacts;
  for (const HeldContact& contact : hold.contacts)
    contacts.push_back({to_vec3<double>(contact.point), to_vec3<double>(contact.normal), contact.digit});
  return contacts;
}

Wrench weight_of(const Scene& scene, const GripReport& report, const GripState& state) {
  const Vec3 up = Vec3(0, std::cos(state.tilt), 0) - std::sin(state.tilt) * to_vec3<double>(report.pour);
  return core_f64::wrench_at(to_vec3<double>(state.state.center_of_mass), -state.state.mass * scene.gravity * up);
}

Scene few_states() {
  Scene scene = three_beakers();
  scene.strength.emplace();
  scene.tilts = {0, radians(20), radians(45), radians(75), radians(120)};
  return scene;
}

// The contact forces carry the weight, no digit gives more than its share, and the whole hand never takes more than two of its
// tips.
TEST(Holding, ForcesOfAStateCarryTheVessel) {
  const Scene scene = few_states();
  int held = 0;
  for (std::size_t vessel = 0; vessel < scene.vessels.size(); ++vessel) {
    const GripReport report = held_report(scene, vessel, beside(0.5 * scene.vessels[vessel].height));
    ASSERT_EQ(report.holds.size(), report.answer.states.size());
    for (std::size_t k = 0; k < report.holds.size(); ++k) {
      const StateHold& hold = report.holds[k];
      EXPECT_LE(hold.low, hold.effort);
      EXPECT_LE(hold.low, hold.tips);
      EXPECT_EQ(hold.escape.has_value(), std::isinf(hold.effort));
      if (std::isinf(hold.effort)) continue;
      ++held;
      const Wrench weight = weight_of(scene, report, report.answer.states[k]);
      Vec3 force = weight.force, moment = weight.moment;
      std::array<double, FINGER_COUNT + 1> pressed{};
      for (const HeldContact& contact : hold.contacts) {
        const Vec3 normal = to_vec3<double>(contact.normal), pushed = to_vec3<double>(contact.force);
        force += pushed;
        moment += glm::cross(to_vec3<double>(contact.point), pushed) + contact.torsion * normal;
        pressed[static_cast<std::size_t>(contact.digit)] += glm::dot(pushed, normal);
      }
      EXPECT_LT(glm::length(force), 1e-9 * glm::length(weight.force));
      EXPECT_LT(glm::length(moment), 1e-9 * glm::length(weight.force));  // arms are below 1 m
      for (std::size_t digit = 0; digit < pressed.size(); ++digit)
        EXPECT_LE(pressed[digit], hold.effort * hold.strength.digits[digit] * (1 + 1e-9));
    }
  }
  EXPECT_GT(held, 30);
}

// A share's range ends where the effort passes 1.2 times the least one.
TEST(Holding, SharesEndWhereTheirEffortPassesTheRoom) {
  const Scene scene = few_states();
  const GripInput grip = beside(0.06, 20);
  const GripReport report = held_report(scene, 0, grip);
  const Holding holding(scene, *make_core_evaluator(scene), 0, report.answer.result, report.pour);
  int inner_ends = 0;
  for (std::size_t k = 0; k < report.holds.size(); ++k) {
    const StateHold& hold = report.holds[k];
    const std::optional<FingerShares> shares = holding.shares(report.answer.states[k], hold);
    ASSERT_EQ(shares.has_value(), std::isfinite(hold.effort));
    if (!shares) continue;
    EXPECT_NEAR(std::accumulate(shares->share.begin(), shares->share.end(), 0.0), 1, 1e-12);
    const auto contacts = contacts_of(hold);
    for (int digit = 1; digit < FINGER_COUNT; ++digit) {
      const std::size_t finger = static_cast<std::size_t>(digit) - 1;
      const auto effort = [&](double share, bool is_least) {
        EffortSolver solver(contacts, hold.strength, {});
        solver.set_share({digit, share, is_least});
        const core_f64::Effort found = solver.solve(weight_of(scene, report, report.answer.states[k]));
        return std::array{found.low / hold.effort, found.effort / hold.effort};
      };
      EXPECT_LE(shares->least[finger], shares->share[finger]);
      EXPECT_GE(shares->most[finger], shares->share[finger]);
      EXPECT_LE(effort(shares->least[finger], false)[1], SHARE_ROOM * (1 + core_f64::EFFORT_TOLERANCE));
      EXPECT_LE(effort(shares->most[finger], true)[1], SHARE_ROOM * (1 + core_f64::EFFORT_TOLERANCE));
      // at twice the step beyond the end; the bracket is a thousandth wide
      if (shares->least[finger] > 2 * SHARE_STEP) {
        EXPECT_GT(effort(shares->least[finger] - 2 * SHARE_STEP, false)[0], (1 - 2e-3) * SHARE_ROOM);
      }
      if (shares->most[finger] < 1 - 2 * SHARE_STEP && shares->most[finger] > 0) {
        EXPECT_GT(effort(shares->most[finger] + 2 * SHARE_STEP, true)[0], (1 - 2e-3) * SHARE_ROOM);
        ++inner_ends;
      }
    }
  }
  EXPECT_GT(inner_ends, 10);
}

// Two tips on a level line across the axis, the center of mass on it: the hold force of kernel 7, at the weaker of the two.
TEST(Holding, OfTwoTipsIsTheHoldForceOverTheWeaker) {
  const Scene scene = few_states();
  const GripReport report = held_report(scene, 0, beside(0.055));
  for (std::size_t k = 0; k < report.holds.size(); ++k) {
    const double hold = report.answer.states[k].state.hold_force, weaker = report.holds[k].strength.weaker_tip();
    EXPECT_NEAR(report.holds[k].tips, hold / weaker, 2e-3 * hold / weaker)
        << k;  // the bracket's width, and liquid that leans moves along x by 0
  }
}

// Solves every state from a cold start: no skipped state is worse.
TEST(Holding, TheWorstIsTheWorstOfAllStates) {
  const Scene scene = few_states();
  for (std::size_t vessel = 0; vessel < scene.vessels.size(); ++vessel)
    for (const double height : {0.3, 0.6}) {
      const GripReport report = held_report(scene, vessel, beside(height * scene.vessels[vessel].height, 20));
      if (report.answer.result.reason != Reason::none) continue;
      ASSERT_TRUE(report.hold);
      double worst = 0, tips = 0;
      for (const StateHold& hold : report.holds) {
        worst = std::max(worst, hold.effort);
        tips = std::max(tips, hold.tips);
      }
      const auto near = [](double a, double b) { return a == b || std::abs(a - b) <= 2e-3 * std::max(a, b); };
      EXPECT_TRUE(near(report.hold->worst, worst)) << report.hold->worst << " " << worst;
      EXPECT_TRUE(near(report.hold->tips_worst, tips)) << report.hold->tips_worst << " " << tips;
      EXPECT_EQ(report.hold->states, static_cast<int>(report.holds.size()));
      for (std::size_t k = 0; k < report.holds.size(); ++k) {
        const GripState& state = report.answer.states[k];
        if (state.fill == report.hold->worst_fill && state.tilt == report.hold->worst_tilt) {
          EXPECT_TRUE(near(report.holds[k].effort, worst));
        }
      }
    }
}

// At the push the worst of six directions takes all of the strength, and the friction that is needed just holds all states.
TEST(Holding, PushAndFrictionAreAtTheirLimits) {
  Scene scene = few_states();
  const GripReport report = held_report(scene, 0, beside(0.06, 20));
  ASSERT_TRUE(report.hold);
  const GripHold& hold = *report.hold;
  ASSERT_GT(hold.push, 0);
  const auto contacts = contacts_of(report.holds.front());
  const StateAxes axes = scene_axes(scene, 0);
  const GripState* full = nullptr;
  for (const GripState& state : report.answer.states)
    if (state.fill == axes.fills.back() && state.tilt == 0) full = &state;
  ASSERT_TRUE(full);
  const Wrench weight = weight_of(scene, report, *full);
  const auto most_effort = [&](double push) {
    double most = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sense : {1.0, -1.0}) {
        Vec3 force(0);
        force[axis] = sense * push;
        const Wrench pushed = core_f64::wrench_at(to_vec3<double>(full->state.center_of_mass), force);
        const Wrench both{weight.force + pushed.force, weight.moment + pushed.moment};
        most = std::max(most, EffortSolver(contacts, report.holds.front().strength, {}).solve(both, 1e-5).effort);
      }
    return most;
  };
  EXPECT_LE(most_effort(0.999 * hold.push), 1 + 1e-3);
  EXPECT_GT(most_effort(1.002 * hold.push), 1 - 1e-3);

  ASSERT_TRUE(std::isfinite(hold.friction_needed));
  const auto effort_at = [&](double friction) {  // the largest of all states
    core_f64::HandStrength hand = report.holds.front().strength;
    hand.friction = friction;
    double most = 0;
    for (const GripState& state : report.answer.states)
      most = std::max(most, EffortSolver(contacts, hand, {}).solve(weight_of(scene, report, state), 1e-5).effort);
    return most;
  };
  EXPECT_LE(effort_at(hold.friction_needed), 1 + 1e-3);
  EXPECT_GT(effort_at(hold.friction_needed - 2e-3), 1);
  scene.strength->digits.fill(0.1);
  EXPECT_EQ(held_report(scene, 0, beside(0.06, 20)).hold->push, 0) << "not even the weight";
}

// Strengths scale it, and without tilts there is nothing to sum up. An infeasible grip has no hold at all.
TEST(Holding, FollowsTheScene) {
  Scene scene = few_states();
  const GripReport report = held_report(scene, 0, beside(0.055));
  for (double& strength : scene.strength->digits) strength *= 2;
  const GripReport strong = held_report(scene, 0, beside(0.055));
  EXPECT_NEAR(strong.hold->worst, report.hold->worst / 2, 2e-3 * report.hold->worst);
  scene.tilts.clear();
  EXPECT_FALSE(held_report(scene, 0, beside(0.055)).hold);
  Scene unknown = few_states();
  unknown.strength.reset();
  const GripReport without = held_report(unknown, 0, beside(0.055));
  EXPECT_TRUE(without.holds.empty()) << "no strength is known";
  EXPECT_FALSE(without.hold);
  const GripReport missed = held_report(few_states(), 0, beside(5));
  EXPECT_TRUE(missed.holds.empty());
  EXPECT_FALSE(missed.hold);
  // a left hand holds what a right one does in the mirrored world
  Scene left = few_states();
  left.hand.handedness = Handedness::left;
  const GripReport other = held_report(left, 0, beside(0.055));
  ASSERT_EQ(other.holds.size(), report.holds.size());
  for (std::size_t k = 0; k < other.holds.size(); ++k)
    EXPECT_NEAR(other.holds[k].effort, report.holds[k].effort, 2e-3 * report.holds[k].effort) << k;
}

// A state that until_poured leaves out has no effort and is not the worst.
TEST(Holding, LeavesOutWhatTheSceneLeavesOut) {
  Scene scene = few_states();
  scene.until_poured = 0.2;
  const GripReport report = held_report(scene, 0, beside(0.055));
  double worst = 0;
  int left_out = 0;
  for (std::size_t k = 0; k < report.holds.size(); ++k) {
    EXPECT_EQ(std::isnan(report.holds[k].effort), !report.answer.states[k].counts) << k;
    left_out += !report.answer.states[k].counts;
    if (report.answer.states[k].counts) worst = std::max(worst, report.holds[k].effort);
  }
  EXPECT_GT(left_out, 0);
  EXPECT_NEAR(report.hold->worst, worst, 2e-3 * worst);
  EXPECT_EQ(report.hold->states, static_cast<int>(report.holds.size()) - left_out);
}

// A sphere on a bone is distinct from the joint at the bone's end, and is not a tip.
TEST(Holding, TellsTheSpheresOnBones) {
  Scene scene = few_states();
  scene.hand.between = 2;
  const GripReport report = held_report(scene, 0, beside(0.055));
  const auto json = parse_json(grip_json(report));
  GripResult result;
  const auto core = make_core_evaluator(scene);
  core->grip(0, report.grip, result);
  const std::vector<GripContact> pressing = core->contacts(0, result);
  const auto& contacts = json["states"][0]["contacts"];
  ASSERT_EQ(contacts.size(), pressing.size());
  int spheres = 0;
  for (std::size_t i = 0; i < pressing.size(); ++i) {
    EXPECT_EQ(contacts[i]["joint"], pressing[i].joint);
    EXPECT_EQ(contacts[i]["between"], pressing[i].between);
    spheres += pressing[i].between > 0;
  }
  EXPECT_GT(spheres, 0);
  EXPECT_NE(grip_table(report).find(" bone "), std::string::npos);
}

TEST(Holding, IsInTheJson) {
  const Scene scene = few_states();
  const GripReport report = held_report(scene, 0, beside(0.055));
  const auto json = parse_json(grip_json(report));
  for (const char* key :
       {"worst_effort", "worst_effort_fill", "worst_effort_tilt_rad", "tips_worst_effort", "push_N", "friction_needed"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["worst_effort"], report.hold->worst);
  ASSERT_EQ(json["states"].size(), report.holds.size());
  for (std::size_t k = 0; k < report.holds.size(); ++k) {
    const auto& state = json["states"][k];
    EXPECT_EQ(state["effort"], report.holds[k].effort);
    EXPECT_EQ(state["effort_low"], report.holds[k].low);
    EXPECT_TRUE(state["worst_direction"].is_null());
    ASSERT_EQ(state["contacts"].size(), report.holds[k].contacts.size());
    EXPECT_EQ(state["contacts"][0]["digit"], "thumb");
    EXPECT_EQ(state["contacts"][0]["force_N"][1], report.holds[k].contacts[0].force[1]);
  }
  // walls that nobody can hold: without friction the contacts of a level hand carry no weight
  Scene smooth = few_states();
  smooth.force.friction = 0;
  const auto fallen = parse_json(grip_json(held_report(smooth, 0, beside(0.055))));
  EXPECT_TRUE(fallen["worst_effort"].is_null());
  EXPECT_TRUE(fallen["states"][0]["effort"].is_null());
  EXPECT_EQ(fallen["states"][0]["worst_direction"].size(), 6u);
  EXPECT_LT(fallen["states"][0]["worst_direction"][1].get<double>(), 0) << "down";
  // among many such states, the one that is reported as the worst
  const GripReport none = held_report(smooth, 0, beside(0.055));
  const std::string table = grip_table(none);
  EXPECT_NE(table.find(fmt::format("  listed effort  no force holds it, in the hardest of the states listed above: {}, "
                                   "{:.6g} deg\n                 two tips alone in this state: no force holds it\n",
                                   fill_words(none, none.hold.value().worst_fill), none.hold->worst_tilt * 180 / PI)),
            std::string::npos)
      << table;
}

// The states that are listed need not be the scene's: each effort says of which it is.
TEST(Holding, TheTableTellsTheListedStatesFromTheScenesOwn) {
  const Scene scene = few_states();
  GripReport report = held_report(scene, 0, beside(0.055));
  ASSERT_TRUE(report.hold);
  // as with --fill 0 --tilt-deg 0, where the scene has harder ones
  report.answer.states.resize(1);
  report.holds.resize(1);
  ASSERT_LT(report.holds[0].effort, 0.9 * report.hold->worst);
  const std::string table = grip_table(report);
  EXPECT_NE(table.find(fmt::format("  listed effort  {:.2f} % of the hand's strength, in the hardest of the states listed above: "
                                   "empty, {:.6g} deg\n",
                                   100 * report.holds[0].effort, degrees(report.answer.states[0].tilt))),
            std::string::npos)
      << table;
  EXPECT_NE(table.find(fmt::format("  worst effort   {:.2f} % of the hand's strength, in the hardest of the scene's own states: "
                                   "{}, {:.6g} deg\n",
                                   100 * report.hold->worst, fill_words(report, report.hold->worst_fill),
                                   degrees(report.hold->worst_tilt))),
            std::string::npos)
      << table;
}

}  // namespace
}  // namespace wholehand::sweeps
