// SPDX-License-Identifier: MIT
// Grips as the viewer shows them: those of `grip --json`, turned about the middle of the tips, the glass on its table or above,
// with the states' own forces.
// sanitizers: address
#include "app/viewer/grips.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/text/error.h"
#include "core/contact.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/session/workspace.h"
#include "sweeps/grips/report.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;
using nlohmann::json;

// Without strengths: its hold force is that of two tips.
Scene beakers() {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  scene.strength.reset();
  return scene;
}

std::vector<ViewedGrip> some_grips() {
  GripInput side, above, oblique;
  side.height = 0.0585;
  side.roll = radians(22);
  above.height = 0.06;
  above.roll = radians(-80);
  above.azimuth = 0.7;
  oblique.height = 0.07;
  oblique.obliquity = radians(10);
  oblique.azimuth = -2;
  return {{0, side, "side"}, {1, above, "above"}, {2, oblique, "oblique"}, {0, above, "beaker from above"}};
}

// What `grip --json` says of it.
json report_of(const Scene& scene, const ViewedGrip& grip, const sweeps::StateAxes& axes) {
  return parse_json(sweeps::grip_json(
      sweeps::make_grip_report(scene, grip.vessel, grip.grip, axes, sweeps::open_grip_methods(scene, "core", Precision::full))));
}

TEST(GripsView, AFrameIsWhatGripTells) {
  Scene left = beakers();
  left.hand.handedness = Handedness::left;
  for (const Scene& scene : {beakers(), left}) {
    std::vector<std::string> notes;
    const std::vector<ViewedGrip> grips = some_grips();
    const GripsView view(scene, grips, notes);
    ASSERT_EQ(view.size(), grips.size());
    for (std::size_t g = 0; g < grips.size(); ++g) {
      const sweeps::StateAxes axes{{0, 0.5, 0.9}, {0, 0.4, radians(100)}};
      const json reported = report_of(scene, grips[g], axes);
      for (const json& state : reported["states"]) {
        const ViewFrame frame = view.frame(g, state["fill"], state["tilt_rad"]);
        EXPECT_EQ(frame.vessel, static_cast<int>(grips[g].vessel));
        const ViewFrame::Vessel& vessel = frame.vessels[grips[g].vessel];
        const Mat3 back = glm::transpose(to_mat3(vessel.pose.rotation));
        for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
          const Vec3 seen = back * (to_vec3(frame.hand.proxies[j]) - to_vec3(vessel.pose.place)),
                     rigged = back * (to_vec3(frame.hand.rigged[j]) - to_vec3(vessel.pose.place));
          EXPECT_LT(glm::length(seen - to_vec3(reported["proxies_m"][j].get<Triple>())), 1e-14) << j;
          EXPECT_LT(glm::length(rigged - to_vec3(reported["joints_m"][j].get<Triple>())), 1e-14) << j;
          const device::PointContact contact = frame.hand.contact[j];
          EXPECT_EQ(contact != device::PointContact::free && contact != device::PointContact::tracked,
                    reported["touching"][j].get<bool>())
              << j;
          if (j != THUMB_TIP && j != INDEX_TIP) {
            EXPECT_EQ(contact == device::PointContact::projected, !reported["projected"][j].is_null()) << j;
          }
        }
        EXPECT_EQ(frame.feedback, state["feedback_force_N"]);
        EXPECT_EQ(frame.normal, state["normal_force_N"]);
        EXPECT_EQ(frame.torque, state["torque_Nm"]);
        EXPECT_EQ(vessel.volume, state["liquid_volume_m3"]);
        EXPECT_NEAR(frame.weight, state["mass_kg"].get<double>() * scene.gravity, 1e-12);
        EXPECT_EQ(std::isfinite(frame.hold) ? json(frame.hold) : json(nullptr), state["hold_force_N"]);
        EXPECT_EQ(frame.closure, reported["closure"]);
        EXPECT_EQ(frame.gap, reported["gap_m"]);
        // the liquid's center is under its surface, and the lean of both to the same side
        if (!vessel.surface) continue;
        const Vec3 up = to_vec3(vessel.surface->up), center = to_vec3(state["liquid_com_m"].get<Triple>());
        EXPECT_LT(glm::dot(up, center), vessel.surface->level);
        EXPECT_NEAR(up.y, std::cos(frame.tilt), 1e-12);
        EXPECT_LE(up.x * center.x + up.z * center.z, 1e-9) << "up leans away from where it has gathered";
      }
    }
  }
}

// The forces at the contacts, in the world where the vessel is turned and lifted.
TEST(GripsView, AFrameHasTheHoldThatGripTells) {
  int held = 0;
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    Scene scene = beakers();
    scene.strength = StrengthData{{30, 20, 25, 15, 10, 60}, true, {}};
    scene.hand.handedness = handedness;
    std::vector<std::string> notes;
    const std::vector<ViewedGrip> grips = some_grips();
    const GripsView view(scene, grips, notes);
    for (std::size_t g = 0; g < grips.size(); ++g) {
      sweeps::GripReport report =
          sweeps::make_grip_report(scene, grips[g].vessel, grips[g].grip, {{0, 0.9}, {0, 0.4, radians(100)}},
                                   sweeps::open_grip_methods(scene, "core", Precision::full));
      sweeps::add_holding(report, scene, grips[g].vessel);
      for (std::size_t k = 0; k < report.holds.size(); ++k) {
        const sweeps::GripState& state = report.answer.states[k];
        const ViewFrame frame = view.frame(g, state.fill, state.tilt);
        const sweeps::StateHold& reported = report.holds[k];
        ASSERT_TRUE(frame.hand.hold);
        const device::HandHold& seen = *frame.hand.hold;
        EXPECT_EQ(seen.effort, reported.effort);
        EXPECT_EQ(seen.low, reported.low);
        EXPECT_EQ(seen.tips, reported.tips);
        EXPECT_EQ(frame.hold, reported.strength.digits[1] * reported.effort) << "the index finger is the weaker one";
        EXPECT_EQ(seen.presses.empty(), std::isinf(reported.effort));
        Vec3 sum(0);
        const device::VesselPose& pose = frame.vessels[grips[g].vessel].pose;
        for (const device::HandPress& press : seen.presses) {
          sum += to_vec3(press.force);
          const Vec3 place = glm::transpose(to_mat3(pose.rotation)) * (to_vec3(press.place) - to_vec3(pose.place));
          EXPECT_TRUE(std::any_of(reported.contacts.begin(), reported.contacts.end(), [&](const sweeps::HeldContact& contact) {
            const Vec3 force = to_mat3(pose.rotation) * to_vec3(contact.force);
            return contact.digit == press.digit && glm::length(place - to_vec3(contact.point)) < 1e-12 &&
                   glm::length(force - to_vec3(press.force)) < 1e-12;
          }));
        }
        if (seen.presses.empty()) continue;
        ++held;
        EXPECT_LT(glm::length(sum - Vec3(0, frame.weight, 0)), 1e-9 * frame.weight)
            << "up in the world, to the rounding of a solve";
      }
    }
  }
  EXPECT_GT(held, 10);
}

TEST(GripsView, WithoutStrengthsThereIsNoHold) {
  std::vector<std::string> notes;
  const Scene scene = beakers();
  EXPECT_FALSE(GripsView(scene, some_grips(), notes).frame(0, 0.5, 0.3).hand.hold);
}

TEST(GripsView, TheScoreOfAListIsShown) {
  std::vector<std::string> notes;
  std::vector<ViewedGrip> grips = some_grips();
  grips[1].score = 0.125;
  const Scene scene = beakers();
  const GripsView view(scene, grips, notes);
  const json shown = parse_json(view.content("", sweeps::scene_axes(scene, 0)).scene)["grips"];
  EXPECT_EQ(shown[1]["score"], 0.125);
  const double own = report_of(scene, grips[0], sweeps::scene_axes(scene, 0))["score"];
  EXPECT_NEAR(shown[0]["score"].get<double>(), own, 1e-12);
}

// In words only: the frame stays that of the swept grip.
TEST(GripsView, TheRefinedGripIsToldBesideTheSweptOne) {
  std::vector<std::string> notes;
  std::vector<ViewedGrip> grips = some_grips();
  const Scene scene = beakers();
  const std::string swept = frame_json(GripsView(scene, grips, notes).frame(1, 0.5, 0.1));
  grips[1].refined = RefinedView{grips[1].grip, 0.875};
  grips[1].refined->grip.height += 1.5e-3;
  grips[1].refined->grip.roll -= 0.02;
  const GripsView view(scene, grips, notes);
  const json shown = parse_json(view.content("", sweeps::scene_axes(scene, 0)).scene)["grips"];
  EXPECT_FALSE(shown[0].contains("refined"));
  EXPECT_EQ(shown[1]["refined"]["score"], 0.875);
  EXPECT_EQ(shown[1]["refined"]["height_m"], grips[1].refined->grip.height);
  EXPECT_EQ(shown[1]["refined"]["roll_rad"], grips[1].refined->grip.roll);
  EXPECT_EQ(shown[1]["height_m"], grips[1].grip.height);
  EXPECT_EQ(frame_json(view.frame(1, 0.5, 0.1)), swept);
}

TEST(GripsView, RobustScoresAreToldOfGripsThatHaveThem) {
  std::vector<std::string> notes;
  std::vector<ViewedGrip> grips = some_grips();
  grips[1].robust = RobustView{0.625, 0.25};
  const Scene scene = beakers();
  const GripsView view(scene, grips, notes);
  const json shown = parse_json(view.content("", sweeps::scene_axes(scene, 0)).scene)["grips"];
  EXPECT_FALSE(shown[0].contains("robust"));
  EXPECT_EQ(shown[1]["robust"]["mean"], 0.625);
  EXPECT_EQ(shown[1]["robust"]["low"], 0.25);
}

TEST(GripsView, ItTurnsTowardsWhereItPoursAndStaysAboveTheTable) {
  const Scene scene = beakers();
  std::vector<std::string> notes;
  const std::vector<ViewedGrip> grips = some_grips();
  const GripsView view(scene, grips, notes);
  for (std::size_t g = 0; g < grips.size(); ++g) {
    const core_f64::Vessel glass = ready_vessel(scene.vessels[grips[g].vessel]);
    const Vec3 pour = to_vec3(sweeps::pour_direction(scene, grips[g].grip)), pivot = to_vec3(view.result(g).midpoint);
    double before = -1;
    for (double tilt = 0; tilt <= PI; tilt += 0.05) {
      const ViewFrame frame = view.frame(g, 1, tilt);
      const device::VesselPose& pose = frame.vessels[grips[g].vessel].pose;
      const Mat3 turn = to_mat3(pose.rotation);
      EXPECT_LT(glm::length(turn[1] - std::cos(tilt) * Vec3(0, 1, 0) - std::sin(tilt) * pour), 1e-12);
      EXPECT_NEAR(glm::determinant(turn), 1, 1e-12);
      // the middle of the tips stays where it was, but for the lifting
      const Vec3 middle = to_vec3(pose.place) + turn * pivot;
      EXPECT_NEAR(middle.x, pivot.x, 1e-12);
      EXPECT_NEAR(middle.z, pivot.z, 1e-12);
      if (before >= 0) {
        EXPECT_LT(std::abs(middle.y - before), 0.05 * 0.3) << "without a jump";
      }
      before = middle.y;
      // all around its widest and its ends
      for (const double y : {0.0, 0.04, scene.vessels[grips[g].vessel].height}) {
        for (double angle = 0; angle < 2 * PI; angle += 0.1) {
          double r = 0.1;
          while (r > 0 && core_f64::signed_distance(glass, Vec3(r * std::cos(angle), y, r * std::sin(angle))) > 0) r -= 1e-3;
          const Vec3 p = to_vec3(pose.place) + turn * Vec3(r * std::cos(angle), y, r * std::sin(angle));
          EXPECT_GT(p.y, -1e-4);
        }
      }
      if (tilt == 0) {
        EXPECT_EQ(pose.place, scene.vessels[grips[g].vessel].place) << "it stands";
      }
    }
  }
}

// As high as it is in the scene: a hand that reaches under its base is under the table.
TEST(GripsView, AVesselStandsOnItsOwnTableWhereverTheHandIs) {
  Scene scene = beakers();
  scene.vessels[0].place = {0.1, 0.3, -0.2};
  GripInput low;
  low.height = 0.02;
  low.roll = radians(-10);
  std::vector<std::string> notes;
  const GripsView view(scene, {{0, low, "low"}}, notes);
  const ViewFrame frame = view.frame(0, 0, 0);
  EXPECT_EQ(frame.vessels[0].pose.place, scene.vessels[0].place);
  double lowest = 1;
  for (const Triple& joint : frame.hand.proxies) lowest = std::min(lowest, joint[1]);
  EXPECT_LT(lowest, 0.3);
}

TEST(GripsView, OnlyTheHeldVesselIsShown) {
  std::vector<std::string> notes;
  const GripsView view(beakers(), some_grips(), notes);
  const json frame = parse_json(frame_json(view.frame(1, 0.5, 0)));
  EXPECT_TRUE(frame["vessels"][0].is_null());
  EXPECT_FALSE(frame["vessels"][1].is_null());
  EXPECT_TRUE(frame["vessels"][2].is_null());
  EXPECT_EQ(frame["state"], "lift");
  EXPECT_EQ(parse_json(frame_json(view.frame(1, 0.5, 0.1)))["state"], "maintain");
}

TEST(GripsView, TheListTellsEachGripAndItsTerms) {
  const Scene scene = beakers();
  std::vector<std::string> notes;
  const std::vector<ViewedGrip> grips = some_grips();
  const GripsView view(scene, grips, notes);
  const ViewContent content = view.content("best", sweeps::scene_axes(scene, 0));
  const json seen = parse_json(content.scene);
  EXPECT_EQ(seen["mode"], "grips");
  EXPECT_EQ(seen["fills"], json(scene.liquid->fills));
  EXPECT_EQ(seen["tilts"], json(scene.tilts));
  ASSERT_EQ(seen["grips"].size(), grips.size());
  for (std::size_t g = 0; g < grips.size(); ++g) {
    const json &listed = seen["grips"][g], reported = report_of(scene, grips[g], sweeps::scene_axes(scene, 0));
    EXPECT_EQ(listed["vessel"], grips[g].vessel);
    EXPECT_EQ(listed["label"], grips[g].label);
    EXPECT_EQ(listed["score"], reported["score"]);
    EXPECT_EQ(listed["terms"], reported["score_terms"]);
    for (const auto& [key, value] : reported["grip"].items()) EXPECT_EQ(listed[key], value) << key;
    EXPECT_EQ(listed["gap_m"], reported["gap_m"]);
    EXPECT_EQ(listed["fingers"], reported["fingers_used"].size());
    int points = 0;
    for (const json& touches : reported["touching"]) points += touches.get<bool>();
    EXPECT_EQ(listed["points"], points);
    // the worst over all states
    double peak = 0, hold = 0;
    for (const json& state : reported["states"]) {
      peak = std::max(peak, state["feedback_force_N"].get<double>());
      hold = state["hold_force_N"].is_null() ? INFINITY : std::max(hold, state["hold_force_N"].get<double>());
    }
    EXPECT_NEAR(listed["peak_force_N"].get<double>(), peak, 1e-12);
    EXPECT_EQ(listed["hold_force_N"].is_null(), std::isinf(hold));
    if (std::isfinite(hold)) {
      EXPECT_NEAR(listed["hold_force_N"].get<double>(), hold, 1e-9);
    }
  }
}

TEST(GripsView, SafeToTheEndMeansAtEveryTiltThatCounts) {
  Scene scene = beakers();
  scene.liquid->volumes.clear();
  for (VesselData& vessel : scene.vessels) vessel.fills.clear();
  scene.liquid->fills = {0.5, 0.9};
  scene.tilts = {0, radians(45), radians(90), radians(170)};
  scene.until_poured = 0.3;
  scene.force.grip_strength = 1e6;
  std::vector<std::string> notes;
  const GripsView view(scene, some_grips(), notes);
  const json grips = parse_json(view.content("best", sweeps::scene_axes(scene, 0)).scene)["grips"];
  ASSERT_EQ(grips.size(), some_grips().size());
  const auto is_end = [](const json& grip) { return grip["safe_to_end"] == true; };
  EXPECT_TRUE(std::any_of(grips.begin(), grips.end(), is_end)) << grips;
  for (const json& grip : grips) {
    if (is_end(grip)) {
      EXPECT_LT(grip["safe_tilt_rad"], scene.tilts.back()) << "no tilt is left out";
    }
  }
  scene.force.grip_strength = 1e-3;
  const json weak = parse_json(GripsView(scene, some_grips(), notes).content("best", sweeps::scene_axes(scene, 0)).scene)["grips"];
  ASSERT_EQ(weak.size(), some_grips().size());
  for (const json& grip : weak) EXPECT_FALSE(is_end(grip));
}

TEST(GripsView, AnswersAtAnyStateAndRefusesWhatIsNone) {
  std::vector<std::string> notes;
  const GripsView view(beakers(), some_grips(), notes);
  const ViewContent content = view.content("best", {});
  EXPECT_EQ(content.state({{"grip", "1"}, {"fill", "0.37"}, {"tilt", "1.234"}}), frame_json(view.frame(1, 0.37, 1.234)));
  EXPECT_EQ(content.state({{"grip", "0"}, {"fill", "1"}, {"tilt", "3.1415927"}}), frame_json(view.frame(0, 1, PI)));
  using Query = ViewContent::Query;
  for (const Query& bad :
       {Query{}, Query{{"grip", "4"}, {"fill", "0"}, {"tilt", "0"}}, Query{{"grip", "-1"}, {"fill", "0"}, {"tilt", "0"}},
        Query{{"grip", "0.5"}, {"fill", "0"}, {"tilt", "0"}}, Query{{"grip", "0"}, {"fill", "1.01"}, {"tilt", "0"}},
        Query{{"grip", "0"}, {"fill", "0"}, {"tilt", "3.2"}}, Query{{"grip", "0"}, {"fill", "0"}}})
    EXPECT_THROW(content.state(bad), Error);
}

// Other fills in the scene would be another reference of the torque, and other forces than those of the report.
TEST(GripsView, WhatIsAskedForMovesTheSlidersAndNotTheForces) {
  const Scene scene = beakers();
  std::vector<std::string> notes;
  const GripsView view(scene, {some_grips()[0]}, notes);
  const sweeps::StateAxes asked{{0.3}, {0, radians(120)}};
  const json seen = parse_json(view.content("one", asked).scene),
             own = parse_json(view.content("one", sweeps::scene_axes(scene, 0)).scene);
  EXPECT_EQ(seen["fills"], json(asked.fills));
  EXPECT_EQ(seen["tilts"], json(asked.tilts));
  EXPECT_EQ(seen["grips"], own["grips"]);
}

TEST(GripsView, ASceneWithoutLiquidAndTiltsIsShownToo) {
  const Scene scene = scene_of({beaker1()});
  std::vector<std::string> notes;
  const GripsView view(scene, {some_grips()[0]}, notes);
  const json seen = parse_json(view.content("bare", sweeps::scene_axes(scene, 0)).scene);
  EXPECT_EQ(seen["fills"], json({0.0}));
  EXPECT_TRUE(seen["tilts"].empty());
  EXPECT_FALSE(seen["grips"][0]["terms"].contains("force"));
  EXPECT_TRUE(seen["grips"][0]["peak_force_N"].is_null());
  const ViewFrame frame = view.frame(0, 0, 0.5);
  EXPECT_FALSE(frame.vessels[0].surface);
  EXPECT_GT(frame.feedback, scene.force.base);
}

TEST(GripsView, WhatIsNotFeasibleIsLeftOutWithAWord) {
  std::vector<ViewedGrip> grips = some_grips();
  GripInput above_it;
  above_it.height = 0.5;
  grips.push_back({0, above_it, "in the air"});
  std::vector<std::string> notes;
  const GripsView view(beakers(), grips, notes);
  EXPECT_EQ(view.size(), grips.size() - 1);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("in the air is not shown: the core finds that it is not feasible (misses)"), std::string::npos)
      << notes[0];
  EXPECT_THROW(GripsView(beakers(), {grips.back()}, notes), Error);
}

}  // namespace
}  // namespace wholehand
