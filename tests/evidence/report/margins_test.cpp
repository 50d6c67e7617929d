// SPDX-License-Identifier: MIT
// The margins of a grip by their definitions, and the sentence for each limit that can come first.
// sanitizers: address
#include "evidence/report/margins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/files.h"

namespace wholehand {
namespace {

constexpr double ENDLESS_NUMBER = std::numeric_limits<double>::infinity();

// A grip that keeps to every limit, and its scene: margins 4 (strength), 3 (friction), 1.6 (table), 2 (gripper).
struct JudgedGrip {
  JudgedGrip() {
    scene.force.friction = 0.6;
    scene.force.max = 8;
    scene.tilts = {0, radians(90)};
    scene.score = {0.30, 0.10, 0.20, 0.10, 0.15, 0.15};
    scene.liquid.emplace();
    report.has_liquid = true;
    report.hold = sweeps::GripHold{};
    report.hold->worst = 0.25;
    report.hold->worst_fill = 0.6;
    report.hold->worst_tilt = radians(90);
    report.hold->friction_needed = 0.2;
    GripResult& result = report.answer.result;
    result.table_depth = -6e-3;
    result.used_mask = 0b10111;
    result.touch_mask = 0xFFF;
    result.phalanx_depth = 0.4e-3;
    result.palm_depth = 0.1e-3;
    result.closure = 0.45;
    report.answer.states.resize(3);
    report.answer.states[0].state.normal_force = 4;
    report.answer.states[1].state.normal_force = -2;
    report.answer.states[2].state.normal_force = 50;  // left out
    report.answer.states[2].counts = false;
    report.answer.score.terms = {0.8, 0.5, 0.96, 0.9, 0.5, 0.8};
  }

  Scene scene;
  sweeps::GripReport report;

  // In a list of grips.
  std::string text(const std::vector<RankedReport>& list = {}) const { return verdict(scene, report, list); }
  double margin(Limit limit) const {
    for (const Margin& margin : grip_margins(scene, report))
      if (margin.limit == limit) return margin.value;
    return std::nan("");
  }
};

TEST(ReportMargins, AreTheirDefinitions) {
  const JudgedGrip grip;
  const auto margins = grip_margins(grip.scene, grip.report);
  ASSERT_EQ(margins.size(), 4u);
  // 1e-12: quotients of a few roundings
  EXPECT_NEAR(grip.margin(Limit::effort), 1 / 0.25, 1e-12);
  EXPECT_NEAR(grip.margin(Limit::friction), 0.6 / 0.2, 1e-12);
  EXPECT_NEAR(grip.margin(Limit::table), 1 + 6.0 / 10, 1e-12);
  EXPECT_NEAR(grip.margin(Limit::force), 8.0 / 4, 1e-12) << "the state of 50 N is left out";
}

TEST(ReportMargins, AreOneAtTheirLimits) {
  JudgedGrip grip;
  grip.report.hold->worst = 1;
  grip.report.hold->friction_needed = grip.scene.force.friction;
  grip.report.answer.result.table_depth = 0;
  grip.report.answer.states[0].state.normal_force = grip.scene.force.max;
  for (const Margin& margin : grip_margins(grip.scene, grip.report)) EXPECT_EQ(margin.value, 1);
}

TEST(ReportMargins, FallAsTheGripGetsWorse) {
  JudgedGrip good, bad;
  bad.report.hold->worst *= 2;
  bad.report.hold->friction_needed *= 2;
  bad.report.answer.result.table_depth += 2e-3;
  bad.report.answer.states[0].state.normal_force *= 2;
  for (const Limit limit : {Limit::effort, Limit::friction, Limit::table, Limit::force})
    EXPECT_LT(bad.margin(limit), good.margin(limit));
}

TEST(ReportMargins, WhatTheSceneDoesNotHaveHasNone) {
  JudgedGrip grip;
  grip.report.answer.result.table_depth = std::nan("");
  for (const Margin& margin : grip_margins(grip.scene, grip.report)) EXPECT_NE(margin.limit, Limit::table);
  EXPECT_EQ(grip_margins(grip.scene, grip.report).size(), 3u);
  grip.report.hold.reset();
  EXPECT_TRUE(grip_margins(grip.scene, grip.report).empty()) << "what would fail first is not known";
  EXPECT_EQ(grip.text(), "");
  EXPECT_FALSE(smallest_margin({}));
}

TEST(ReportMargins, TheSmallestDecidesAndTheFirstOfEqualOnes) {
  EXPECT_EQ(smallest_margin({{Limit::effort, 4}, {Limit::table, 1.2}, {Limit::force, 3}})->limit, Limit::table);
  EXPECT_EQ(smallest_margin({{Limit::friction, 2}, {Limit::table, 2}, {Limit::force, 2}})->limit, Limit::friction);
  EXPECT_EQ(smallest_margin({{Limit::effort, ENDLESS_NUMBER}, {Limit::force, 7}})->limit, Limit::force);
  EXPECT_FALSE(smallest_margin({{Limit::effort, ENDLESS_NUMBER}, {Limit::force, ENDLESS_NUMBER}})) << "nothing comes near";
}

TEST(ReportVerdict, NamesTheTable) {
  EXPECT_EQ(JudgedGrip().text(),
            "This grip is good because 4 of 5 fingers touch the vessel; the table would be in the way first, because the hand has "
            "6.0 mm of room above its clearance (margin 1.60).");
  JudgedGrip grip;
  grip.report.answer.result.table_depth = 1.5e-3;
  EXPECT_TRUE(has(grip.text(), ", the table is in the way, because the hand is 1.5 mm too low (margin 0.85)."));
}

TEST(ReportVerdict, AHandThatIsNowhereDeepIsSaidSo) {
  JudgedGrip grip;
  grip.report.answer.score.terms = {0, 0.1, 1, 0.1, 0, 0};
  EXPECT_FALSE(has(grip.text(), "in the glass")) << "a depth is no reason by itself";
  grip.report.answer.result.phalanx_depth = 0.04e-3;
  grip.report.answer.result.palm_depth = 0.01e-3;
  EXPECT_TRUE(has(grip.text(), "because the hand does not reach into the glass;"));
}

TEST(ReportVerdict, NamesTheStrengthOfTheHand) {
  JudgedGrip grip;
  grip.report.hold->worst = 0.8;
  EXPECT_TRUE(has(grip.text(),
                  "; the strength of the hand would fail first, because the hardest state takes 80\u00a0% of the hand's "
                  "strength (margin 1.25)."));
  grip.report.hold->worst = 1.6;
  EXPECT_TRUE(has(grip.text(),
                  ", the strength of the hand fails, because the hardest state takes 160\u00a0% of the hand's strength "
                  "(margin 0.62)."))
      << grip.text();
}

TEST(ReportVerdict, NamesTheStateThatNothingHolds) {
  JudgedGrip grip;
  grip.report.hold->worst = grip.report.hold->friction_needed = ENDLESS_NUMBER;
  EXPECT_TRUE(has(grip.text(), ", no force of the hand holds the vessel at a tilt of 90° and a fill of 60\u00a0%."));
  grip.report.hold->worst_fill = 0.605;
  EXPECT_TRUE(has(grip.text(), " and a fill of 60.5\u00a0%.")) << "as tables and charts of the page have it: " << grip.text();
  grip.report.has_liquid = false;
  EXPECT_TRUE(has(grip.text(), ", no force of the hand holds the vessel at a tilt of 90°."));
}

TEST(ReportVerdict, NamesTheFriction) {
  JudgedGrip grip;
  grip.report.hold->friction_needed = 0.5;
  EXPECT_TRUE(has(grip.text(),
                  "; friction would fail first, because the grip needs a friction of 0.500 and the vessel has 0.6 (margin 1.20)."));
  grip.report.hold->worst = 1.1;
  grip.report.hold->friction_needed = 0.8;
  EXPECT_TRUE(
      has(grip.text(), ", friction fails, because the grip needs a friction of 0.800 and the vessel has 0.6 (margin 0.75)."));
}

// The hand is too weak at any friction: friction is not what fails.
TEST(ReportVerdict, AFrictionThatDoesNotExistIsNotBlamed) {
  JudgedGrip grip;
  grip.report.hold->worst = 1.1;
  grip.report.hold->friction_needed = ENDLESS_NUMBER;
  EXPECT_TRUE(has(grip.text(), ", the strength of the hand fails, because"));
}

TEST(ReportVerdict, NamesTheGripper) {
  JudgedGrip grip;
  grip.report.answer.states[1].state.normal_force = 6.4;
  EXPECT_TRUE(has(grip.text(),
                  "; the force of the gripper would reach its limit first, because the feedback force is up to 6.4 N and "
                  "the gripper gives 8 N (margin 1.25)."));
  grip.report.answer.states[1].state.normal_force = 10;
  EXPECT_TRUE(has(grip.text(),
                  ", the force of the gripper is beyond its limit, because the feedback force is up to 10.0 N and the "
                  "gripper gives 8 N (margin 0.80)."));
}

TEST(ReportVerdict, AloneItsReasonIsTheTermThatAddsMost) {
  JudgedGrip grip;
  const auto reasons = [&grip](const ScoreTerms& terms) {
    grip.report.answer.score.terms = terms;
    const std::string text = grip.text({{1, grip.report}});
    EXPECT_EQ(text, grip.text());
    return text.substr(0, text.find(';'));
  };
  // weights 0.3, 0.1, 0.2, 0.1, 0.15, 0.15
  EXPECT_EQ(reasons({0, 1, 0, 0.9, 0, 0}), "This grip is good because 12 of 24 points of the hand touch the vessel");
  EXPECT_EQ(reasons({0, 0, 0, 1, 0.5, 0.6}), "This grip is good because the hand is near the middle of its range (closure 0.45)");
  EXPECT_EQ(reasons({0, 0, 0, 0, 0.5, 0.6}), "This grip is good because the hardest state takes 25\u00a0% of the hand's strength");
  EXPECT_EQ(reasons({0.1, 0, 0, 0, 0, 0}), "This grip is good because 4 of 5 fingers touch the vessel");
  EXPECT_EQ(reasons({0, 0, 0, 0, 0, 0}), "Nothing speaks for this grip");
}

// What all grips of a list share is one reason at most, and what a grip has more of than the median comes first.
TEST(ReportVerdict, ItsReasonsTellItFromTheMedianOfItsList) {
  JudgedGrip usual, other, grip;
  grip.report.hold->worst = 0.2;
  grip.report.answer.score.terms.hold = 0.9;
  std::vector<RankedReport> list{{1, grip.report}, {2, usual.report}, {3, usual.report}, {4, other.report}};
  const auto reasons = [](const std::string& text) { return text.substr(0, text.find(';')); };
  EXPECT_EQ(
      reasons(grip.text(list)),
      "This grip is good because the hardest state takes 20\u00a0% of the hand's strength (median of the list: 25\u00a0%) and 4 "
      "of 5 fingers touch the vessel");
  EXPECT_EQ(reasons(usual.text(list)), "This grip is good because 4 of 5 fingers touch the vessel") << "it shares all";
  grip.report.answer.result.closure = 0.5;
  grip.report.answer.score.terms.posture = 1;
  grip.report.answer.result.touch_mask = 0x1FFF;
  grip.report.answer.score.terms.contacts = 0.9;
  list[0].report = grip.report;
  EXPECT_EQ(reasons(grip.text(list)),
            "This grip is good because 13 of 24 points of the hand touch the vessel (median of the list: 12) and the hardest state "
            "takes 20\u00a0% of the hand's strength (median of the list: 25\u00a0%)")
      << "the two by which it exceeds the median most";
  list[3].report.hold->worst = 0.15;
  list[3].report.answer.score.terms.hold = 0.95;
  EXPECT_FALSE(has(grip.text(list), "takes 20")) << "another takes less, and of the rest it has more than any other";
  for (RankedReport& one : list) one.report.held_share = 0.5;
  list[0].report.held_share = grip.report.held_share = 0.98;
  EXPECT_TRUE(has(grip.text(list), "good because 98\u00a0% of its deviations hold (median of the list: 50\u00a0%) and 13 of 24"))
      << grip.text(list);
}

// A grip that has less than the median of everything is not praised for a part of it, as long as there is anything else.
TEST(ReportVerdict, WhatIsLessThanTheMedianIsTheLastReason) {
  JudgedGrip usual, grip;
  grip.report.answer.result.used_mask = 0b111;
  grip.report.answer.score.terms.fingers = 0.6;
  const std::vector<RankedReport> list{{1, usual.report}, {2, usual.report}, {3, grip.report}};
  EXPECT_FALSE(has(grip.text(list), "fingers touch")) << grip.text(list);
  grip.report.answer.score.terms = {0.6, 0, 0, 0, 0, 0};
  EXPECT_TRUE(has(grip.text(list), "good because 3 of 5 fingers touch the vessel;")) << grip.text(list);
}

// A grip is not praised for what it would fail by.
TEST(ReportVerdict, ItsReasonIsNotItsLimit) {
  JudgedGrip grip;
  grip.report.answer.score.terms = {0.1, 0, 0, 0, 1, 1};
  grip.report.hold->worst = 0.9;
  EXPECT_TRUE(has(grip.text(), "good because the gripper renders at most 4.0\u00a0N of its 8\u00a0N;"));
  grip.report.hold->worst = 0.25;
  grip.report.answer.states[0].state.normal_force = 7;
  EXPECT_TRUE(has(grip.text(), "good because the hardest state takes 25\u00a0% of the hand's strength;"));
}

TEST(WriteMargins, HasARowForEachGripAndADashForWhatItDoesNotHave) {
  JudgedGrip whole, weak;
  whole.report.hold->tips_worst = ENDLESS_NUMBER;
  whole.report.hold->push = 21.5;
  weak.report.hold->worst = 1.25;
  weak.report.hold->friction_needed = ENDLESS_NUMBER;
  weak.report.answer.result.table_depth = std::nan("");
  MarkupWriter html;
  write_margins(html, whole.scene, {{1, whole.report}, {4, weak.report}}, "cup");
  EXPECT_TRUE(html.is_closed());
  EXPECT_TRUE(has(html.written(), ">Limits of the best grips of cup</caption>"));
  const auto cells = [](const std::vector<std::string>& texts) {
    std::string row;
    for (const std::string& text : texts) row += "<td>" + text + "</td>\n";
    return row;
  };
  EXPECT_TRUE(has(html.written(), ">1</th>\n" + cells({"0.250", "∞", "21.5", "0.200", "4.00", "3.00", "1.60", "2.00"})))
      << html.written();
  EXPECT_TRUE(has(html.written(), ">4</th>\n" + cells({"1.250", "0.00", "0.0", "∞", "0.80", "–", "–", "2.00"}))) << html.written();
}

TEST(WriteMargins, WithoutHoldsThereIsNoTable) {
  JudgedGrip grip;
  grip.report.hold.reset();
  MarkupWriter html;
  write_margins(html, grip.scene, {{1, grip.report}}, "cup");
  EXPECT_EQ(html.written(), "");
}

TEST(ReportVerdict, HoldingIsNoReasonWhereItTakesMoreThanTheHandHas) {
  JudgedGrip grip;
  grip.scene.score.hold = 2;  // holding by two tips adds most to the score
  grip.report.answer.result.table_depth = 5e-3;
  grip.report.hold->worst = 0.9;
  EXPECT_NE(grip.text().find("takes 90"), std::string::npos) << grip.text();
  grip.report.hold->worst = 1.2;
  EXPECT_EQ(grip.text().find("takes 120"), std::string::npos) << grip.text();
}

}  // namespace
}  // namespace wholehand
