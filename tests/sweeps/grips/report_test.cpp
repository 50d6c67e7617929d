// SPDX-License-Identifier: MIT
// One grip's report: the JSON's form, which fields exist, and that both ways to an answer agree.
#include "sweeps/grips/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/text/error.h"
#include "core/core_backend.h"
#include "core/counted_tilts.h"
#include "core/reader/reader.h"

namespace wholehand::sweeps {
namespace {

using Json = nlohmann::ordered_json;

// Answers with what it is given.
class ToldEvaluator final : public Evaluator {
 public:
  GripResult result;
  GripScore given_score;

  void grip(std::size_t, const GripInput&, GripResult& out) const override { out = result; }
  LiquidResult liquid(std::size_t, double fill, double tilt) const override { return {fill * 1e-3, fill, 0.1 * tilt, 0.05, 1e-6}; }
  StateResult state(std::size_t, const GripInput&, const GripResult&, const LiquidResult& liquid, double tilt,
                    double) const override {
    StateResult state;
    state.mass = 0.1 + liquid.mass;
    state.center_of_mass = {0.1, 0.2, 0.3};
    state.pivot_length = 0.04;
    state.torque = 0.5;
    state.exact_torque = -0.5;
    state.normal_force = 1.0 / 3.0;
    state.feedback_force = 2;
    state.hold_force = tilt > 0 ? std::numeric_limits<double>::infinity() : 3;
    return state;
  }
  GripScore score(std::size_t, const GripInput&, const GripResult&) const override { return given_score; }
  void planes(std::size_t, const GripInput*, std::size_t, const FieldSet&, std::size_t, double*, std::uint32_t*,
              double) const override {}
  double distance(std::size_t, const Triple&) const override { return 0; }
  Triple gradient(std::size_t, const Triple&) const override { return {}; }
  VesselConstants constants(std::size_t) const override { return {}; }
  double pouring_tilt(std::size_t, double) const override { return 0; }
  double gap_at(double) const override { return 0; }
};

Scene plain_scene(bool has_liquid, bool has_tilts) {
  Scene scene;
  scene.name = "plain";
  scene.vessels.resize(1);
  scene.vessels[0].name = "glass";
  if (has_liquid) scene.liquid = LiquidData{1000, {0, 0.5}, {}, Pour::away};
  if (has_tilts) scene.tilts = {0, 0.1};
  return scene;
}

GripResult feasible_result() {
  GripResult result;
  result.plausible = true;
  result.contact_angles = {0.1, 0.2};
  result.closure = 0.25;
  result.gap = 0.08;
  result.midpoint = {0, 0.05, 1e-300};
  for (int j = 0; j < JOINT_COUNT; ++j) {
    result.joints[j] = {j * 0.1, 0, 0};
    result.posed[j] = {0, j * 0.1, 0};
    result.proxies[j] = {0, 0, j / 3.0};
    result.separation[j] = -j * 1e-3;
  }
  result.touch_mask = 1u << 3 | 1u << 8 | 1u << 23;
  result.tip_mask = 1u << 13;
  result.finger_mask = 1u << 12;
  result.inner_mask = 1u << 17;
  result.used_mask = 1u << 0 | 1u << 1 | 1u << 4;
  result.phalanx_depth = 0.001;
  result.palm_depth = 0.002;
  result.bone_stretch = 0.003;
  return result;
}

GripReport report_of(const Scene& scene, const GripResult& result) {
  const auto evaluator = std::make_shared<ToldEvaluator>();
  evaluator->result = result;
  evaluator->given_score.score = 0.75;
  evaluator->given_score.terms = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  const GripInput grip{0.05, 0.1, 0.2, 0.3, 0.4, 1.1};
  return make_grip_report(scene, 0, grip, scene_axes(scene, 0), core_grip_methods(scene, evaluator, "fake"));
}

std::vector<std::string> keys_of(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& item : json.items()) keys.push_back(item.key());
  return keys;
}

TEST(GripReport, JsonHasEveryFieldInOrder) {
  const Json json = parse_ordered_json(grip_json(report_of(plain_scene(true, true), feasible_result())));
  EXPECT_EQ(keys_of(json), (std::vector<std::string>{"vessel",         "grip",          "feasible",        "reason",
                                                     "plausible",      "antipodal",     "undecided",       "contact_angles_rad",
                                                     "closure",        "gap_m",         "midpoint_m",      "joints_m",
                                                     "posed_m",        "separation_m",  "touching",        "proxies_m",
                                                     "projected",      "fingers_used",  "phalanx_depth_m", "palm_depth_m",
                                                     "bone_stretch_m", "table_depth_m", "self_depth_m",    "wrist_share",
                                                     "states",         "score",         "score_terms"}));
  EXPECT_EQ(json["vessel"], "glass");
  EXPECT_EQ(json_text(json["grip"]),
            R"({"height_m":0.05,"azimuth_rad":0.1,"obliquity_rad":0.2,"roll_rad":0.3,"offset_m":0.4,"hand_scale":1.1})");
  EXPECT_EQ(json["feasible"], true);
  EXPECT_EQ(json["reason"], "");
  EXPECT_EQ(json["plausible"], true);
  EXPECT_EQ(json["antipodal"], false);
  EXPECT_EQ(json_text(json["contact_angles_rad"]), "[0.1,0.2]");
  EXPECT_EQ(json_text(json["midpoint_m"]), "[0.0,0.05,1e-300]");
  for (const char* points : {"joints_m", "posed_m", "proxies_m"}) {
    ASSERT_EQ(json[points].size(), 24u);
    for (const auto& point : json[points]) EXPECT_EQ(point.size(), 3u);
  }
  EXPECT_EQ(json["proxies_m"][1][2].get<double>(), 1 / 3.0);  // to the last bit
  ASSERT_EQ(json["separation_m"].size(), 24u);
  EXPECT_EQ(json["separation_m"][23].get<double>(), -23 * 1e-3);
  ASSERT_EQ(json["touching"].size(), 24u);
  for (int j = 0; j < 24; ++j) EXPECT_EQ(json["touching"][j], j == 3 || j == 8 || j == 23) << j;
  ASSERT_EQ(json["projected"].size(), 24u);
  for (int j = 0; j < 24; ++j) {
    const Json expected = j == 13 ? Json("tip") : j == 12 ? Json("finger") : j == 17 ? Json("inner") : Json(nullptr);
    EXPECT_EQ(json["projected"][j], expected) << j;
  }
  EXPECT_EQ(json_text(json["fingers_used"]), R"(["thumb","index","little"])");
  EXPECT_EQ(json["score"], 0.75);
  EXPECT_EQ(json_text(json["score_terms"]), R"({"fingers":0.1,"contacts":0.2,"depth":0.3,"posture":0.4,"force":0.5,"hold":0.6})");
}

TEST(GripReport, JsonStatesRunFillByFill) {
  const Json json = parse_ordered_json(grip_json(report_of(plain_scene(true, true), feasible_result())));
  ASSERT_EQ(json["states"].size(), 4u);
  for (const auto& state : json["states"]) {
    EXPECT_EQ(keys_of(state), (std::vector<std::string>{"fill", "tilt_rad", "liquid_volume_m3", "liquid_mass_kg", "liquid_com_m",
                                                        "poured_m3", "mass_kg", "com_m", "pivot_length_m", "torque_Nm",
                                                        "exact_torque_Nm", "normal_force_N", "feedback_force_N", "hold_force_N"}));
  }
  EXPECT_EQ(json["states"][0]["fill"], 0.0);
  EXPECT_EQ(json["states"][1]["tilt_rad"], 0.1);
  EXPECT_EQ(json["states"][2]["fill"], 0.5);
  EXPECT_TRUE(json["states"][1]["liquid_com_m"].is_null());  // nothing in it
  EXPECT_TRUE(json["states"][2]["liquid_com_m"].is_array());
  EXPECT_EQ(json["states"][2]["hold_force_N"], 3.0);
  EXPECT_TRUE(json["states"][3]["hold_force_N"].is_null());  // infinite
  EXPECT_EQ(json["states"][3]["normal_force_N"].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(json["states"][3]["exact_torque_Nm"], -0.5);
  // along the direction of the tilt, (-sin a, 0, -cos a), and up
  const double lean = 0.1 * 0.1;
  EXPECT_DOUBLE_EQ(json["states"][3]["liquid_com_m"][0].get<double>(), -lean * std::sin(0.1));
  EXPECT_DOUBLE_EQ(json["states"][3]["liquid_com_m"][1].get<double>(), 0.05);
  EXPECT_DOUBLE_EQ(json["states"][3]["liquid_com_m"][2].get<double>(), -lean * std::cos(0.1));
}

TEST(GripReport, WhatASceneLacksIsLeftOut) {
  const Json dry = parse_ordered_json(grip_json(report_of(plain_scene(false, true), feasible_result())));
  ASSERT_EQ(dry["states"].size(), 2u);
  EXPECT_EQ(dry["states"][0]["fill"], 0.0);
  EXPECT_EQ(dry["states"][0]["liquid_mass_kg"], 0.0);
  EXPECT_TRUE(dry["states"][0]["liquid_com_m"].is_null());
  const Json still = parse_ordered_json(grip_json(report_of(plain_scene(true, false), feasible_result())));
  EXPECT_EQ(still["states"].size(), 0u);
  EXPECT_EQ(keys_of(still["score_terms"]), (std::vector<std::string>{"fingers", "contacts", "depth", "posture"}));
}

TEST(GripReport, SaysWhatTheWristDoes) {
  GripResult result = feasible_result();
  EXPECT_TRUE(parse_ordered_json(grip_json(report_of(plain_scene(false, false), result)))["wrist_share"].is_null());
  EXPECT_EQ(grip_table(report_of(plain_scene(false, false), result)).find("wrist"), std::string::npos);
  result.wrist_share = 0.5;
  result.wrist_angles = {radians(-10), radians(18), radians(-20)};
  const Json json = parse_ordered_json(grip_json(report_of(plain_scene(false, false), result)));
  EXPECT_EQ(json["wrist_share"], 0.5);
  EXPECT_EQ(json["beyond_wrist"], false);
  EXPECT_EQ(json["wrist_rad"][1], radians(18));
  const std::string within = grip_table(report_of(plain_scene(false, false), result));
  EXPECT_NE(within.find("  wrist          extension 10.000 deg, ulnar 18.000 deg, supination 20.000 deg: 50.000 % of a range\n"),
            std::string::npos)
      << within;
  result.wrist_share = 1.25;
  result.beyond_wrist = true;
  result.plausible = false;
  const std::string beyond = grip_table(report_of(plain_scene(false, false), result));
  EXPECT_NE(beyond.find(": 125.000 % of a range, beyond it\n"), std::string::npos) << beyond;
  EXPECT_NE(beyond.find("deep, palm 2.000 mm; wrist and forearm do not reach it within their ranges\n"), std::string::npos)
      << beyond;
}

TEST(GripReport, TellsOfTheTable) {
  GripResult result = feasible_result();
  EXPECT_TRUE(parse_ordered_json(grip_json(report_of(plain_scene(false, false), result)))["table_depth_m"].is_null());
  EXPECT_EQ(grip_table(report_of(plain_scene(false, false), result)).find("table"), std::string::npos);
  result.table_depth = -0.0125;
  EXPECT_EQ(parse_ordered_json(grip_json(report_of(plain_scene(false, false), result)))["table_depth_m"], -0.0125);
  const std::string above = grip_table(report_of(plain_scene(false, false), result));
  EXPECT_NE(above.find("  table          12.500 mm above the table and its clearance\n"), std::string::npos) << above;
  result.table_depth = 0.03;
  result.through_table = true;
  result.plausible = false;
  const std::string below = grip_table(report_of(plain_scene(false, false), result));
  EXPECT_NE(below.find("  table          30.000 mm below the table and its clearance\n"), std::string::npos) << below;
  EXPECT_NE(below.find("  plausible      no: phalanges 1.000 mm deep, palm 2.000 mm; the hand goes through the table\n"),
            std::string::npos)
      << below;
}

TEST(GripReport, InfeasibleGripsHaveTheFieldsUpToTheReason) {
  const std::vector<std::string> early{"vessel", "grip", "feasible", "reason"};
  const std::vector<std::string> late{"vessel", "grip", "feasible", "reason", "gap_m", "midpoint_m"};
  for (std::uint32_t reason = 1; reason <= 6; ++reason) {
    GripResult result = feasible_result();
    result.reason = static_cast<Reason>(reason);
    const GripReport report = report_of(plain_scene(true, true), result);
    const Json json = parse_ordered_json(grip_json(report));
    EXPECT_EQ(json["feasible"], false);
    EXPECT_EQ(json["reason"], REASON_NAMES[reason]);
    EXPECT_EQ(keys_of(json), result.reason >= Reason::too_wide ? late : early) << reason;
    const std::string table = grip_table(report);
    EXPECT_NE(table.find(std::string("feasible       no: ") + REASON_NAMES[reason]), std::string::npos) << table;
    EXPECT_EQ(table.find("score"), std::string::npos);
  }
}

TEST(GripReport, TableHasEveryPointAndState) {
  const std::string table = grip_table(report_of(plain_scene(true, true), feasible_result()));
  for (const char* words :
       {"Grip of glass in plain, on fake", "thumb CMC", "thumb IP", "little DIP", "middle DIP", "touches", "projected: tip",
        "infinite", "height 50.000 mm", "score          0.750000", "hold 0.6000", " 500.0000  500.0000  back "}) {
    EXPECT_NE(table.find(words), std::string::npos) << words << "\n" << table;
  }
  for (std::size_t begin = 0; begin < table.size();) {
    const std::size_t end = table.find('\n', begin);
    EXPECT_LE(end - begin, 140u) << table.substr(begin, end - begin);
    begin = end + 1;
  }
}

// What a mesh is known to is all that its lengths show, and what follows from them.
TEST(GripReport, TableShowsTheDigitsThatAreKnown) {
  GripResult result = feasible_result();
  result.gap = 0.0812346;
  GripReport report = report_of(plain_scene(true, true), result);
  EXPECT_NE(grip_table(report).find("  gap            81.235 mm\n"), std::string::npos);
  report.length_error = 0.2e-3;
  const std::string table = grip_table(report);
  EXPECT_NE(table.find("  gap            81.2 mm\n"), std::string::npos) << table;
  EXPECT_NE(table.find("  closure        0.2500\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("81.23"), std::string::npos) << table;
  report.length_error = 3e-3;
  EXPECT_NE(grip_table(report).find("  gap            81 mm\n"), std::string::npos);
}

TEST(GripReport, TableHasNoNegativeZero) {
  GripResult result = feasible_result();
  result.midpoint = {-1e-9, 0.05, -0.0};
  for (double& separation : result.separation) separation = -1e-9;
  const std::string table = grip_table(report_of(plain_scene(true, true), result));
  EXPECT_EQ(table.find("-0.0"), std::string::npos) << table;
}

// Fills in the unit in which they are asked for.
TEST(GripReport, TableGivesFillsAsTheyAreAskedFor) {
  GripReport report = report_of(plain_scene(true, true), feasible_result());
  report.answer.score.fills = {{1, 0, 1, 0.1}, {1, 0, 1, 0.05}};
  EXPECT_NE(grip_table(report).find("all tilts, fill 0.5: peak"), std::string::npos) << grip_table(report);
  report.capacity = 413.2e-6;
  const std::string table = grip_table(report);
  EXPECT_NE(table.find("all tilts, 206.6 mL: peak"), std::string::npos) << table;
  EXPECT_EQ(table.find("fill 0"), std::string::npos) << table;
  EXPECT_NE(table.find("safe at every tilt, up to 5.72958 deg"), std::string::npos) << table;
  EXPECT_NE(table.find("safe up to 2.86479 deg"), std::string::npos) << table;
}

// The end is the last tilt that counts at each fill.
TEST(GripReport, TableSaysSafeAtEveryTiltThatCounts) {
  GripReport report = report_of(plain_scene(true, true), feasible_result());
  report.answer.score.fills = {{1, 0, 1, 0.05}, {1, 0, 1, 0.05}};
  report.last_tilts = {0.1, 0.05};
  const std::string table = grip_table(report);
  EXPECT_NE(table.find("safe up to 2.86479 deg"), std::string::npos) << table;
  EXPECT_NE(table.find("safe at every tilt, up to 2.86479 deg"), std::string::npos) << table;
}

TEST(GripThrough, FindsTheGripOfItsLine) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const GripInput grip{0.1 * uniform(random), 3.1 * uniform(random),  1.5 * uniform(random),
                         uniform(random),       0.05 * uniform(random), 1.2};
    const double ca = std::cos(grip.azimuth), sa = std::sin(grip.azimuth), cb = std::cos(grip.obliquity),
                 sb = std::sin(grip.obliquity);
    const Triple d{cb * ca, sb, -cb * sa}, o{grip.offset * sa, grip.height, grip.offset * ca};
    const double t0 = -0.04 + 0.02 * uniform(random), t1 = t0 + 0.08;
    const auto at = [&](double t) { return Triple{o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]}; };
    const GripInput found = grip_through(at(t0), at(t1), grip.roll, grip.hand_scale);
    // lengths of 0.1 m over 0.08 m of line: rounding of 1e-17 m turns it by 1e-16, times tan(1.5) = 14 and its slope 200
    EXPECT_NEAR(found.height, grip.height, 1e-13);
    EXPECT_NEAR(found.azimuth, grip.azimuth, 1e-13);
    EXPECT_NEAR(found.obliquity, grip.obliquity, 1e-14);
    EXPECT_NEAR(found.offset, grip.offset, 1e-14);
    EXPECT_EQ(found.roll, grip.roll);
    EXPECT_EQ(found.hand_scale, grip.hand_scale);
  }
}

TEST(GripThrough, RefusesWhatIsNoLine) {
  EXPECT_THROW(grip_through({0, 1, 2}, {0, 1, 2}, 0, 1), Error);
  EXPECT_THROW(grip_through({0, 1, 2}, {0, 3, 2}, 0, 1), Error);
  EXPECT_THROW(grip_through({0, NAN, 2}, {0, 3, 1}, 0, 1), Error);
}

// ---- with the core ----

const char* const CUP = R"(
[hand]
handedness = "HAND"
[[vessel]]
name = "cup"
shape = "cylinder"
diameter_mm = 76
height_mm = 100
wall_mm = 2
[[vessel]]
name = "flask"
shape = "flask"
diameter_mm = 85
neck_mm = 34
height_mm = 140
wall_mm = 1.5
[liquid]
fills = [0.25, 0.8]
pour = "POUR"
[strength]
efforts = false
[tilts]
deg = [0, 40, 80]
)";

Scene cup_scene(const std::string& hand, const std::string& pour) {
  std::string text = CUP;
  text.replace(text.find("HAND"), 4, hand);
  text.replace(text.find("POUR"), 4, pour);
  return parse_scene(text, "cup.toml");
}

TEST(GripReport, LiquidLeansWhereTheCoreSaysForEitherHand) {
  for (const char* hand : {"right", "left"}) {
    for (const char* pour : {"away", "towards"}) {
      const Scene scene = cup_scene(hand, pour);
      const std::shared_ptr<const Evaluator> core = make_core_evaluator(scene);
      const GripInput grip{0.05, 0.7, 0.1, -0.5, 0.002, 1};
      const GripReport report = make_grip_report(scene, 0, grip, scene_axes(scene, 0), core_grip_methods(scene, core, "core"));
      ASSERT_EQ(report.answer.result.reason, Reason::none);
      const Json json = parse_ordered_json(grip_json(report));
      for (const auto& state : json["states"]) {
        const double own = core->empty_mass(0), held = state["liquid_mass_kg"];
        const Triple center = core->empty_center_of_mass(0);
        for (int k = 0; k < 3; ++k) {
          const double liquid = state["liquid_com_m"].is_null() ? 0 : state["liquid_com_m"][k].get<double>();
          EXPECT_NEAR((own * center[k] + held * liquid) / (own + held), state["com_m"][k].get<double>(), 1e-16)
              << hand << pour << state;
        }
      }
    }
  }
}

// A state that the scene leaves out has its liquid and no forces. No requested tilt is left out.
TEST(GripReport, StatesThatAreLeftOutHaveNoForces) {
  Scene scene = cup_scene("right", "away");
  scene.tilts = {0, 0.5, 1.0, 1.5, 2.0, 2.5};
  scene.until_poured = 0.4;
  const GripMethods methods = core_grip_methods(scene, make_core_evaluator(scene), "core");
  const GripInput grip{0.05, 0.7, 0.1, -0.5, 0.002, 1};
  const StateAxes own = scene_axes(scene, 0);
  const GripReport report = make_grip_report(scene, 0, grip, own, methods);
  const std::vector<std::size_t> counted = counted_tilts(scene, 0);
  const Json states = parse_ordered_json(grip_json(report))["states"];
  ASSERT_EQ(states.size(), own.fills.size() * 6);
  std::size_t left_out = 0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const bool is_left_out = k % 6 >= counted[k / 6];
    left_out += is_left_out ? 1 : 0;
    EXPECT_EQ(report.answer.states[k].counts, !is_left_out);
    for (const char* name : {"pivot_length_m", "torque_Nm", "exact_torque_Nm", "normal_force_N", "feedback_force_N"})
      EXPECT_EQ(states[k][name].is_null(), is_left_out) << k << name;
    EXPECT_TRUE(states[k]["mass_kg"].is_number() && states[k]["poured_m3"].is_number());
  }
  ASSERT_GT(left_out, 0u);
  const std::string table = grip_table(report);
  std::size_t rows = 0;
  for (std::size_t at = table.find("left out by until_poured"); at != std::string::npos; at = table.find("left out by", at + 1))
    ++rows;
  EXPECT_EQ(rows, left_out) << table;
  EXPECT_NE(table.find("over " + std::to_string(counted.back()) + " of 6 tilts"), std::string::npos) << table;
  EXPECT_EQ(report.last_tilts.back(), scene.tilts[counted.back() - 1]);
  StateAxes asked = own;
  asked.tilts = {2.5};
  for (const GripState& state : make_grip_report(scene, 0, grip, asked, methods).answer.states)
    EXPECT_TRUE(state.counts && std::isfinite(state.state.torque));
}

TEST(GripReport, PlanesGiveWhatTheCoreGives) {
  Scene scene = cup_scene("left", "away");
  scene.table.emplace();
  const BackendOpener open = [](const Scene& opened, const FieldSet& fields) -> std::unique_ptr<Backend> {
    return std::make_unique<CoreBackend>(make_core_evaluator(opened), opened, fields, Precision::full, 1);
  };
  const GripMethods direct = core_grip_methods(scene, make_core_evaluator(scene), "core"),
                    planes = backend_grip_methods(scene, open);
  StateAxes other;
  other.fills = {0.5, 0.1};  // in any order, within the scene's largest
  other.tilts = {1.0, 0.25, 1.0};
  for (const StateAxes& axes : {scene_axes(scene, 0), other}) {
    for (const double height : {0.05, 0.2}) {  // held, and beside the cup
      const GripInput grip{height, 0.7, 0.1, -0.5, 0.002, 1};
      EXPECT_EQ(grip_json(make_grip_report(scene, 1, grip, axes, direct)),
                grip_json(make_grip_report(scene, 1, grip, axes, planes)));
    }
  }
  Scene cut = scene;
  cut.tilts = {0, 0.5, 1.0, 1.5, 2.0};
  cut.until_poured = 0.4;
  const GripMethods cut_direct = core_grip_methods(cut, make_core_evaluator(cut), "core"),
                    cut_planes = backend_grip_methods(cut, open);
  StateAxes half = scene_axes(cut, 0);
  half.fills = {0.5};
  for (const StateAxes& axes : {scene_axes(cut, 0), half, other}) {
    const GripInput grip{0.05, 0.7, 0.1, -0.5, 0.002, 1};
    EXPECT_EQ(grip_json(make_grip_report(cut, 1, grip, axes, cut_direct)),
              grip_json(make_grip_report(cut, 1, grip, axes, cut_planes)));
  }
  // planes of float have the scene's own tilts
  cut.tilts = {0, radians(75), radians(150)};
  cut.until_poured.reset();
  cut.force.grip_strength = 1e3;
  const GripMethods in_float = backend_grip_methods(cut, [](const Scene& opened, const FieldSet& fields) {
    return std::make_unique<CoreBackend>(make_core_float_evaluator(opened), opened, fields, Precision::single, 1);
  });
  const GripReport reported = make_grip_report(cut, 1, {0.05, 0.7, 0.1, -0.5, 0.002, 1}, scene_axes(cut, 1), in_float);
  for (const FillTerms& terms : reported.answer.score.fills) {
    EXPECT_EQ(terms.safe_tilt, cut.tilts.back());
    EXPECT_TRUE(std::find(cut.tilts.begin(), cut.tilts.end(), terms.peak_tilt) != cut.tilts.end()) << terms.peak_tilt;
  }
  EXPECT_NE(grip_table(reported).find("safe at every tilt, up to 150 deg"), std::string::npos) << grip_table(reported);
  other.fills = {0.9};
  EXPECT_THROW(planes.answer(0, {0.05, 0, 0, 0, 0, 1}, other), Error);
}

// The first sentences say what a person asks first.
TEST(GripVerdict, SaysWhetherItHoldsWhatFailsFirstAndHowSurely) {
  Scene scene = plain_scene(true, true);
  scene.force.friction = 0.6;
  GripReport report = report_of(scene, feasible_result());
  const std::string unsure = "Off its place the grip is not judged: the scene has no [robust].\n";
  EXPECT_EQ(grip_verdict(scene, report), "Whether the grip holds is not judged: the scene has no efforts.\n" + unsure);
  scene.strength.emplace();
  report.hold = GripHold{};
  report.hold->worst = 0.25;
  report.hold->worst_fill = 0.5;
  report.hold->worst_tilt = radians(90);
  report.hold->friction_needed = 0.1;
  const std::string holds = "Holds with 25.00 % of the hand's strength in the hardest state (fill 0.5, 90 deg).\n";
  EXPECT_EQ(grip_verdict(scene, report), holds + "The strength of the hand would fail first (margin 4.00).\n" + unsure);
  report.hold->friction_needed = 0.4;
  EXPECT_EQ(grip_verdict(scene, report),
            holds + "Friction would fail first: the grip needs 0.400, and the vessel has 0.6 (margin 1.50).\n" + unsure);
  scene.robust.emplace();
  report.answer.result.status |= STATUS_CONTACT_UNDECIDED;
  report.held_share = 0.955;
  EXPECT_TRUE(grip_verdict(scene, report)
                  .ends_with("It holds in 95 % of 64 deviations from its place.\n"
                             "Rounding may decide whether a point of the hand is a contact.\n"))
      << grip_verdict(scene, report);
}

TEST(GripVerdict, SaysWhyItDoesNotHold) {
  Scene scene = plain_scene(true, true);
  scene.strength.emplace();
  scene.robust.emplace();
  scene.force.friction = 0.6;
  GripReport report = report_of(scene, feasible_result());
  report.hold = GripHold{};
  report.hold->worst = 1.25;
  report.hold->friction_needed = 0.7;
  EXPECT_EQ(grip_verdict(scene, report),
            "Does not hold: it takes 125.00 % of the hand's strength in the hardest state (empty, 0 deg).\n"
            "The strength of the hand fails first (margin 0.80).\n");
  report.hold->friction_needed = 0.8;
  EXPECT_TRUE(
      grip_verdict(scene, report).ends_with("Friction fails first: the grip needs 0.800, and the vessel has 0.6 (margin 0.75).\n"));
  report.hold->worst = std::numeric_limits<double>::infinity();
  const std::string slips = "Does not hold: the vessel slips in the hardest state (empty, 0 deg), whatever the hand's strength.\n";
  EXPECT_EQ(grip_verdict(scene, report), slips + "A friction of 0.800 would hold it, and the vessel has 0.6.\n");
  report.hold->friction_needed = std::numeric_limits<double>::infinity();
  EXPECT_EQ(grip_verdict(scene, report), slips + "No friction up to 10 would hold it.\n");
  report.answer.result.plausible = false;
  EXPECT_EQ(grip_verdict(scene, report),
            "Not plausible: the hand would be too deep in the vessel, so nobody can take this grip.\n");
  report.answer.result.through_table = true;
  EXPECT_EQ(grip_verdict(scene, report), "Not plausible: the hand would go through the table, so nobody can take this grip.\n");
  report.answer.result.reason = Reason::too_wide;
  EXPECT_EQ(grip_verdict(scene, report), "Not feasible (too wide): no hand holds the vessel here.\n");
}

}  // namespace
}  // namespace wholehand::sweeps
