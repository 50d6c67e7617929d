// SPDX-License-Identifier: MIT
// The scatter of recorded grips against grips that are known.
// sanitizers: address
#include "device/recordings/grip_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/numbers/normal.h"
#include "base/numbers/random_bits.h"
#include "core/closure.h"
#include "core/mirror.h"
#include "core/reader/reader.h"
#include "core/vectors.h"
#include "tests/support/files.h"
#include "tests/support/recorded_session.h"
#include "tests/support/scene_texts.h"
#include "tests/support/special_values.h"

namespace wholehand::device {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

Mat3 about(Vec3 axis, double angle) { return Mat3(glm::rotate(glm::dmat4(1), angle, axis)); }

GripInput grip_at(double height_mm, double offset_mm, double obliquity_deg, double roll_deg, double azimuth_deg) {
  return {height_mm * 1e-3, radians(azimuth_deg), radians(obliquity_deg), radians(roll_deg), offset_mm * 1e-3, 1};
}

// Puts the hand of a grip on a vessel that is moved and turned, as docs/method.md defines the grip's line and roll.
void take_grip(Tick& tick, const GripInput& grip, Handedness handedness) {
  const Mirror mirror(handedness);
  const Mat3 turned = about(glm::normalize(Vec3(1, 2, 3)), 0.7);
  const Vec3 place(0.3, 0.1, -0.2);
  const Vec3 d = core_f64::grip_direction(grip.azimuth, grip.obliquity), aside(std::sin(grip.azimuth), 0, std::cos(grip.azimuth));
  const Vec3 nearest = Vec3(0, grip.height, 0) + grip.offset * aside;
  tick.vessel_rotation = mirror.out(turned);
  tick.vessel_place = mirror.out(place);
  tick.proxies = {mirror.out(place + turned * (nearest - 0.03 * d)), mirror.out(place + turned * (nearest + 0.05 * d))};
  tick.hand_rotation =
      mirror.out(turned * about({0, 1, 0}, grip.azimuth) * about({0, 0, 1}, grip.obliquity) * about({1, 0, 0}, grip.roll));
}

struct RecordedGrip {
  int vessel = 0, guidance = -1;
  GripInput grip;
};

RecordedSession session_of(const std::vector<RecordedGrip>& grips, Handedness handedness = Handedness::right) {
  RecordedSession session;
  for (const RecordedGrip& one : grips) {
    session.stretch(0.02, SessionState::free).hold(one.vessel).with([&](Tick& tick) {
      tick.guidance = one.guidance;
      take_grip(tick, one.grip, handedness);
    });
    session.stretch(0.02, SessionState::lift);
  }
  return session;
}

// Two vessels: squares about their means are 32 + 18 mm2, 2 + 8 mm2, 8 + 2 deg2, 200 + 50 deg2 and 6 + 0 deg2, from 7 grasps.
const std::vector<RecordedGrip> SEVEN{{0, -1, grip_at(40, 1, 0, -30, 179)}, {0, -1, grip_at(44, 2, 2, -40, -178)},
                                      {0, -1, grip_at(48, 3, 4, -50, 179)}, {0, -1, grip_at(44, 2, 2, -40, 180)},
                                      {1, -1, grip_at(70, -8, -3, 10, 20)}, {1, -1, grip_at(76, -4, -1, 20, 20)},
                                      {1, -1, grip_at(73, -6, -2, 15, 20)}};

TEST(GripScatter, IsThatOfKnownGripsInClosedForm) {
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    const GripScatter scatter = session_of(SEVEN, handedness).report().scatter;
    EXPECT_EQ(scatter.grasps(), 7u);
    EXPECT_EQ(scatter.vessels(), 2u);
    ASSERT_EQ(scatter.freedom(), 5u);
    const auto all = scatter.deviations();
    EXPECT_NEAR(all[0].value, 1e-3 * std::sqrt(50.0 / 5), 1e-12);
    EXPECT_NEAR(all[1].value, 1e-3 * std::sqrt(10.0 / 5), 1e-12);
    EXPECT_NEAR(all[2].value, radians(std::sqrt(10.0 / 5)), 1e-12);
    EXPECT_NEAR(all[3].value, radians(std::sqrt(250.0 / 5)), 1e-12);
    EXPECT_NEAR(all[4].value, radians(std::sqrt(6.0 / 5)), 1e-12) << "-1, 2, -1 and 0 degrees about 180";
    // sums of squares over the chi-square distribution's 12.8325 and 0.831212
    EXPECT_NEAR(all[0].interval.low, 1e-3 * std::sqrt(50 / 12.8325), 1e-8);
    EXPECT_NEAR(all[0].interval.high, 1e-3 * std::sqrt(50 / 0.831212), 1e-8);
  }
}

// The mean place on a vessel is no scatter, nor is what changes between shown guidance points or between people.
TEST(GripScatter, IsWithinPersonVesselAndShownPoint) {
  GripScatter scatter;
  for (const double habit : {0.0, 20.0}) {
    std::vector<RecordedGrip> grips;
    for (const int point : {0, 1, 2})
      for (const double off : {-1.0, 1.0}) grips.push_back({0, point, grip_at(30 + habit + 15 * point + off, 0, 0, 30 * point, 0)});
    scatter.add(session_of(grips).report().grasps);
  }
  ASSERT_EQ(scatter.freedom(), 6u);
  EXPECT_NEAR(scatter.deviations()[0].value, 1e-3 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(scatter.deviations()[3].value, 0, 1e-12);
  EXPECT_TRUE(has(scatter.table(), "[robust]  # scatter of 12 grasps of 1 vessel by 2 people, with 95 % intervals"))
      << scatter.table();
}

// A grip counts however its grasp ends; one with a number that is not finite, or alone at its vessel, does not.
TEST(GripScatter, CountsLostGripsAndNoneWithoutNumbersOrAlone) {
  std::vector<RecordedGrip> grips = SEVEN;
  RecordedSession session = session_of(grips);
  session.with([](Tick& tick) { ++tick.lost; }).stretch(0.02, SessionState::slipped);
  EXPECT_EQ(session.report().grasps.back().outcome, GraspOutcome::lost);
  EXPECT_EQ(session.report().scatter.grasps(), 7u);
  grips.push_back({1, 5, grip_at(1, 1, 1, 1, 1)});
  grips.push_back({0, -1, grip_at(NOT_A_NUMBER, 0, 0, 0, 0)});
  GripInput along{0.05, 0, PI / 2, 0, 0, 1};
  grips.push_back({0, -1, along});
  const SessionReport report = session_of(grips).report();
  EXPECT_EQ(report.grasps.size(), 10u);
  EXPECT_EQ(report.scatter.grasps(), 7u);
  EXPECT_EQ(report.scatter.table(), session.report().scatter.table());
}

TEST(GripScatter, NoTableIsOneLine) {
  const auto table = [](const std::vector<RecordedGrip>& grips) { return session_of(grips).report().scatter.table(); };
  EXPECT_EQ(table({SEVEN[0]}),
            "No [robust] table: the scatter of the grips needs 5 grasps in all beyond the first at each vessel and shown point, in "
            "one or "
            "more recordings "
            "of a person; there are 0\n");
  EXPECT_EQ(table({SEVEN[0], SEVEN[1], SEVEN[4]}),
            "No [robust] table: the scatter of the grips needs 5 grasps in all beyond the first at each vessel and shown point, in "
            "one or "
            "more recordings "
            "of a person; there is 1\n");
  EXPECT_EQ(table(std::vector<RecordedGrip>(6, {0, -1, {}})),
            "No [robust] table: it needs a deviation above 0 that its keys take\n");
  const nlohmann::json json = nlohmann::json::parse(session_json(session_of({SEVEN[0]}).report()));
  EXPECT_TRUE(json.at("scatter").is_null());
}

// The printed table, pasted in a scene, is that scene's scatter to its two decimals.
TEST(GripScatter, TableIsASceneTable) {
  const SessionReport report = session_of(SEVEN).report();
  const std::string text = session_table(report), table = text.substr(text.find("\n[robust]"));
  const Scene scene = scene_from(VESSEL + table);
  ASSERT_TRUE(scene.robust);
  const RobustData& robust = *scene.robust;
  const auto all = report.scatter.deviations();
  EXPECT_NEAR(robust.height, all[0].value, 0.005e-3) << table;
  EXPECT_NEAR(robust.offset, all[1].value, 0.005e-3) << table;
  EXPECT_NEAR(robust.obliquity, all[2].value, radians(0.005)) << table;
  EXPECT_NEAR(robust.roll, all[3].value, radians(0.005)) << table;
  EXPECT_EQ(robust.azimuth, 0) << "a vessel that is a body of revolution has no use for it";
  // where a vessel is none, its line counts without the mark of a comment
  std::string turned = table;
  turned.erase(turned.find("# azimuth_deg"), 2);
  EXPECT_NEAR(scene_from(VESSEL + turned).robust->azimuth, all[4].value, radians(0.005)) << turned;
  const nlohmann::json json = nlohmann::json::parse(session_json(report)).at("scatter");
  EXPECT_EQ(json.at("degrees_of_freedom"), 5);
  EXPECT_EQ(json.at("roll_rad").at("deviation"), all[3].value);
  EXPECT_EQ(json.at("height_m").at("high"), all[0].interval.high);
}

// Rolls all around deviate by some 104 degrees, which [robust] does not take.
TEST(GripScatter, ADeviationThatNoKeyTakesIsAComment) {
  std::vector<RecordedGrip> grips;
  for (int k = 0; k < 12; ++k) grips.push_back({0, -1, grip_at(40 + k % 2, 0, 0, 30 * k + 1, 30 * k)});
  const std::string table = session_of(grips).report().scatter.table();
  EXPECT_TRUE(has(table, "\n# roll_deg = 1")) << table;
  EXPECT_TRUE(has(table, "; more than [robust] takes\n")) << table;
  EXPECT_EQ(scene_from(VESSEL + "\n" + table).robust->roll, 0);
}

// Normal grips: the intervals have the true deviation in 95 % of the sessions. 2,000 sessions have a standard error of 0.5 %.
TEST(GripScatter, IntervalsHaveTheTrueDeviationIn95Percent) {
  constexpr int SESSIONS = 2000;
  constexpr double HEIGHT = 7e-3, ROLL = radians(5);
  std::uint64_t state = 1;
  const auto normal = [&state] { return normal_quantile(unit_interval(split_mix(state)) + 0x1p-60); };
  int heights = 0, rolls = 0;
  for (int session = 0; session < SESSIONS; ++session) {
    std::vector<GraspReport> grasps(9);
    for (std::size_t k = 0; k < grasps.size(); ++k) {
      grasps[k].vessel = static_cast<int>(k % 3);
      grasps[k].grip = GripInput{0.05 + HEIGHT * normal(), 0, 0, PI + ROLL * normal(), 0, 1};
    }
    GripScatter scatter;
    scatter.add(grasps);
    const auto all = scatter.deviations();
    heights += all[0].interval.low <= HEIGHT && HEIGHT <= all[0].interval.high ? 1 : 0;
    rolls += all[3].interval.low <= ROLL && ROLL <= all[3].interval.high ? 1 : 0;
  }
  EXPECT_NEAR(heights / double{SESSIONS}, 0.95, 0.02);
  EXPECT_NEAR(rolls / double{SESSIONS}, 0.95, 0.02);
}

}  // namespace
}  // namespace wholehand::device
