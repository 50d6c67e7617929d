// SPDX-License-Identifier: MIT
// What holding takes, as a report shows it: the numbers against the laws of efforts, and words for every case.
// sanitizers: address
#include "evidence/report/holding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sweeps/grips/states.h"
#include "tests/support/files.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

constexpr double BRACKET = 1e-3;  // relative width of the bracket to which an effort is solved

std::string strong_scene() { return edited(RESULT_SCENE, NO_EFFORTS, "[strength]\n"); }

std::string efforts_html(const SweptScene& swept, std::size_t vessel) {
  MarkupWriter html;
  write_efforts(html, *swept.source, vessel, swept.best_grip(vessel), "v");
  EXPECT_TRUE(html.is_closed());
  return html.written();
}

TEST(DigitLoads, AreSumsOfNormalForces) {
  sweeps::StateHold hold;
  hold.strength.digits = {40, 25, 35, 25, 14, 80};
  hold.effort = 0.5;
  // two contacts of the thumb, one of the palm; what is across a normal does not count
  hold.contacts = {
      {1, 0, {}, {1, 0, 0}, {3, 9, -9}, 0}, {3, 0, {}, {0, 0, -1}, {5, 5, -7}, 0}, {0, FINGER_COUNT, {}, {0, 1, 0}, {0, 8, 0}, 0}};
  const auto loads = digit_loads(hold);
  EXPECT_EQ(loads[0].force, 10);
  EXPECT_EQ(loads[0].share, 10.0 / 40);
  for (const std::size_t digit : {1, 2, 3, 4}) EXPECT_EQ(loads[digit].force, 0);
  EXPECT_EQ(loads[FINGER_COUNT].force, 8);
  EXPECT_EQ(loads[FINGER_COUNT].share, 0.1);
  hold.effort = INFINITY;
  for (const DigitLoad& load : digit_loads(hold)) EXPECT_TRUE(std::isnan(load.force) && std::isnan(load.share));
}

// The effort is the share of the digit that is nearest to its limit.
TEST(DigitLoads, TheLargestShareIsTheEffort) {
  const SweptScene swept(strong_scene());
  for (std::size_t vessel = 0; vessel < 2; ++vessel) {
    const sweeps::GripReport report = grip_with_holding(*swept.source, vessel, swept.best_grip(vessel));
    ASSERT_EQ(report.holds.size(), 8u) << "2 fills, 4 tilts";
    int held = 0;
    for (const sweeps::StateHold& hold : report.holds) {
      if (!std::isfinite(hold.effort)) continue;
      ++held;
      double largest = 0;
      for (const DigitLoad& load : digit_loads(hold)) largest = std::max(largest, load.share);
      EXPECT_LE(largest, hold.effort * (1 + 1e-9)) << "roundings of the basis";
      EXPECT_GE(largest, hold.low * (1 - 1e-9));
    }
    EXPECT_GT(held, 0);
  }
}

TEST(WriteDigits, HasARowForEachDigitAndTwoColumnsForEachGrip) {
  const SweptScene swept(strong_scene());
  std::vector<RankedReport> grips;
  for (const std::size_t rank : {1, 2}) grips.push_back({rank, grip_with_holding(*swept.source, 0, swept.best_grip(0))});
  MarkupWriter html;
  write_digits(html, swept.scene, grips, "cup");
  EXPECT_TRUE(html.is_closed());
  for (const char* header : {">thumb</th>", ">palm</th>", ">grip 1 (N)</th>", ">grip 2 (%)</th>", ">strength (N)</th>"})
    EXPECT_TRUE(has(html.written(), header)) << header;
  const auto hardest = sweeps::hardest_state(grips[0].report);
  const auto loads = digit_loads(grips[0].report.holds[hardest.value()]);
  const std::string cells =
      "<td>" + shown_number(loads[0].force, 1) + "</td>\n<td>" + shown_number(100 * loads[0].share, 0) + "</td>";
  EXPECT_TRUE(has(html.written(), "<td>40</td>\n" + cells)) << html.written();
  MarkupWriter none;
  write_digits(none, swept.scene, {{1, sweeps::GripReport{}}}, "cup");
  EXPECT_EQ(none.written(), "");
}

TEST(EffortsOverTilt, AreThoseOfTheFullestFill) {
  const SweptScene swept(strong_scene());
  for (std::size_t vessel = 0; vessel < 2; ++vessel) {
    const GripInput grip = swept.best_grip(vessel);
    const TiltEfforts efforts = efforts_over_tilt(*swept.source, vessel, grip);
    const sweeps::GripReport report = grip_with_holding(*swept.source, vessel, grip);
    ASSERT_EQ(efforts.whole.size(), 4u);
    ASSERT_EQ(efforts.tips.size(), 4u);
    for (std::size_t t = 0; t < 4; ++t) {
      const sweeps::GripState& state = report.answer.states[4 + t];
      EXPECT_EQ(state.fill, 0.6);
      EXPECT_EQ(state.tilt, swept.scene.tilts[t]);
      EXPECT_EQ(efforts.whole[t], report.holds[4 + t].effort);
      EXPECT_EQ(efforts.tips[t], report.holds[4 + t].tips);
      // more contacts never take more
      EXPECT_LE(efforts.whole[t], efforts.tips[t] * (1 + BRACKET));
    }
  }
}

TEST(EffortsOverTilt, TwiceTheStrengthIsHalfTheEffort) {
  const SweptScene swept(strong_scene()),
      strong(edited(strong_scene(), "[strength]",
                    "[strength]\nthumb_N = 80\nindex_N = 50\nmiddle_N = 70\nring_N = 50\nlittle_N = 28\npalm_N = 160"));
  const GripInput grip = swept.best_grip(0);
  const TiltEfforts once = efforts_over_tilt(*swept.source, 0, grip), twice = efforts_over_tilt(*strong.source, 0, grip);
  for (std::size_t t = 0; t < 4; ++t) EXPECT_NEAR(twice.whole[t], 0.5 * once.whole[t], BRACKET * once.whole[t]);
}

TEST(EffortsOverTilt, AreMissingWhereThereAreNone) {
  const SweptScene without(RESULT_SCENE), still(edited(strong_scene(), RESULT_TILTS, ""));
  for (const SweptScene* swept : {&without, &still}) {
    EXPECT_TRUE(efforts_over_tilt(*swept->source, 0, swept->best_grip(0)).whole.empty());
    EXPECT_EQ(efforts_html(*swept, 0), "") << "what a scene does not need is not spoken of";
  }
  const SweptScene swept(strong_scene());
  GripInput beyond = swept.best_grip(0);
  beyond.height = 10;
  EXPECT_TRUE(efforts_over_tilt(*swept.source, 0, beyond).whole.empty());
}

TEST(WriteEfforts, HasTwoLinesTheLimitAndTheNumbers) {
  const SweptScene swept(strong_scene());
  const std::string html = efforts_html(swept, 0);
  for (const char* part : {">Effort over the tilt</h3>", "id=\"v-effort-title\"", ">whole hand</text>", ">two tips</text>",
                           ">all of the strength</text>", "with the vessel filled to 60\u00a0%", ">two tips over whole hand</th>"})
    EXPECT_TRUE(has(html, part)) << part << html;
  EXPECT_TRUE(has(html, "stroke-dasharray"));
  const TiltEfforts efforts = efforts_over_tilt(*swept.source, 0, swept.best_grip(0));
  EXPECT_TRUE(has(html, "<td>" + shown_number(efforts.whole[1], 3) + "</td>\n<td>" + shown_number(efforts.tips[1], 3) + "</td>"));
}

TEST(WriteEfforts, WhatTwoTipsCannotHoldIsSaid) {
  // without torsion and friction two points hold nothing
  const SweptScene swept(edited(strong_scene(), "[tilts]", "[force]\nfriction = 0\n[tilts]"));
  MarkupWriter writer;
  write_efforts(writer, *swept.source, 0, SweptScene(strong_scene()).best_grip(0), "v");
  const std::string html = writer.written();
  EXPECT_TRUE(has(html, "No force of the two tips holds the vessel at any tilt, so they have no line."));
  EXPECT_TRUE(has(html, "Two tips: no force holds the vessel at any tilt."));
  EXPECT_FALSE(has(html, ">two tips</text>"));
}

// On a wall that narrows upwards by more than the friction, nothing holds the vessel upright; upside down its wall rests on the
// hand.
TEST(WriteEfforts, ALineEndsWithACrossWhereNothingHolds) {
  const SweptScene swept(
      edited(edited(edited(strong_scene(), "shape = \"flask\"", "shape = \"conical\"\nupright_mm = 4\nshoulder_mm = 105"),
                    "[tilts]", "[force]\nfriction = 0.1\n[tilts]"),
             "[0, 45, 90, 135]", "[0, 45, 90, 135, 180]"));
  GripInput grip;
  grip.height = 0.05;
  const TiltEfforts efforts = efforts_over_tilt(*swept.source, 1, grip);
  ASSERT_EQ(efforts.whole.size(), 5u);
  EXPECT_TRUE(std::isinf(efforts.tips.front()) && std::isfinite(efforts.tips.back()));
  MarkupWriter html;
  write_efforts(html, *swept.source, 1, grip, "v");
  EXPECT_TRUE(has(html.written(), "end-of-line"));
  EXPECT_TRUE(has(html.written(), " A cross marks where a line ends because no force holds the vessel beyond."));
  EXPECT_TRUE(has(html.written(), "Two tips: ∞ at 0°, at most "));
  EXPECT_TRUE(has(html.written(), " where a force holds the vessel, and infinite elsewhere."));
}

TEST(WriteEfforts, GreatEffortsEndTheChartAndAreSaid) {
  const SweptScene swept(edited(strong_scene(), "[strength]", "[strength]\nindex_N = 1"));
  const TiltEfforts efforts = efforts_over_tilt(*swept.source, 0, swept.best_grip(0));
  const double highest = *std::max_element(efforts.tips.begin(), efforts.tips.end());
  ASSERT_GT(highest, 3);
  const std::string html = efforts_html(swept, 0);
  EXPECT_TRUE(has(html, " The efforts go up to " + shown_number(highest, 1) + "; the chart ends at 3.")) << html;
  EXPECT_FALSE(has(efforts_html(SweptScene(strong_scene()), 0), "The efforts go up to"));
}

TEST(WriteEfforts, LeftOutTiltsAreMissingNotInfinite) {
  const SweptScene swept(edited(strong_scene(), RESULT_TILTS, RESULT_TILTS + "\nuntil_poured = 0.5"));
  const TiltEfforts efforts = efforts_over_tilt(*swept.source, 0, swept.best_grip(0));
  ASSERT_EQ(efforts.whole.size(), 4u);
  EXPECT_TRUE(std::isfinite(efforts.whole.front()));
  EXPECT_TRUE(std::isnan(efforts.whole.back()) && std::isnan(efforts.tips.back()));
  EXPECT_FALSE(has(efforts_html(swept, 0), "end-of-line"));
}

TEST(WriteEfforts, WithoutTheCoreTheReasonIsSaid) {
  SweptScene swept(strong_scene());
  swept.source->core = nullptr;
  swept.source->no_core = "no mesh";
  EXPECT_TRUE(has(efforts_html(swept, 0), "This part is left out: no mesh."));
}

TEST(WriteProtocols, NameTheirSources) {
  MarkupWriter html;
  write_protocols(html);
  EXPECT_TRUE(html.is_closed());
  for (const char* part : {"no comparison", "arXiv:2412.16490", "arXiv:2504.18829", "arXiv:2210.02697"})
    EXPECT_TRUE(has(html.written(), part)) << part;
}

}  // namespace
}  // namespace wholehand
