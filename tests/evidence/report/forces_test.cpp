// SPDX-License-Identifier: MIT
// Forces over the tilt and pouring: the core's numbers, and a sentence for each thing that a scene does not have.
// sanitizers: address
#include "evidence/report/forces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/files.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

std::string forces_text(const SweptScene& swept, std::size_t vessel) {
  MarkupWriter html;
  write_forces(html, *swept.source, vessel, swept.best_grip(vessel), "v");
  EXPECT_TRUE(html.is_closed());
  return html.written();
}

std::string pouring_text(const SweptScene& swept, std::size_t vessel) {
  MarkupWriter html;
  write_pouring(html, *swept.source, vessel, "v");
  EXPECT_TRUE(html.is_closed());
  return html.written();
}

TEST(ReportForces, AreTheCoresOverFillsAndTilts) {
  const SweptScene swept(RESULT_SCENE);
  const GripInput grip = swept.best_grip(1);
  const Evaluator& core = *swept.source->core;
  GripResult result;
  core.grip(1, grip, result);
  const auto forces = forces_of(*swept.source, 1, grip);
  ASSERT_EQ(forces.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_EQ(forces[f].fill, swept.scene.liquid->fills[f]);
    ASSERT_EQ(forces[f].feedback.size(), 4u);
    for (std::size_t t = 0; t < 4; ++t) {
      const double tilt = swept.scene.tilts[t];
      const StateResult state = core.state(1, grip, result, core.liquid(1, forces[f].fill, tilt), tilt);
      EXPECT_EQ(forces[f].feedback[t], state.feedback_force);
      EXPECT_EQ(forces[f].hold[t], state.hold_force);
    }
  }
}

TEST(ReportForces, HaveTwoChartsAndATableOfTheirNumbers) {
  const std::string html = forces_text(SweptScene(RESULT_SCENE), 0);
  EXPECT_TRUE(has(html, "feedback force (N)") && has(html, "hold force per finger (N)"));
  EXPECT_TRUE(has(html, "feedback, 60\u00a0% (N)") && has(html, "hold, 0\u00a0% (N)"));
  EXPECT_TRUE(has(html, "limit of 8 N is not reached."));
  EXPECT_TRUE(has(html, "id=\"v-feedback-title\"") && has(html, "id=\"v-hold-title\""));
}

TEST(ReportForces, LinesEndWhereTheShareIsOut) {
  const SweptScene swept(edited(RESULT_SCENE, RESULT_TILTS, RESULT_TILTS + "\nuntil_poured = 0.5"));
  const auto forces = forces_of(*swept.source, 0, swept.best_grip(0));
  ASSERT_EQ(forces.size(), 2u);
  EXPECT_TRUE(std::isfinite(forces[0].feedback.back())) << "nothing to pour";
  EXPECT_TRUE(std::isfinite(forces[1].feedback.front()));
  EXPECT_TRUE(std::isnan(forces[1].feedback.back()) && std::isnan(forces[1].hold.back()));
  const std::string html = forces_text(swept, 0);
  EXPECT_TRUE(has(html, "A line ends at the first tilt at which 50\u00a0% of its fill has poured"));
  EXPECT_FALSE(has(html, "Where a line of the hold force is missing"));
  EXPECT_FALSE(has(forces_text(SweptScene(RESULT_SCENE), 0), "A line ends"));
}

TEST(ReportForces, ALimitWithinIsDrawnAndNotSaid) {
  const std::string html = forces_text(SweptScene(edited(RESULT_SCENE, "[tilts]", "[force]\nmax_N = 1\n[tilts]")), 0);
  EXPECT_TRUE(has(html, ">device 1 N</text>"));
}

TEST(ReportForces, OfAnEmptyVesselThereIsOneLine) {
  const std::string html = forces_text(SweptScene(edited(RESULT_SCENE, RESULT_LIQUID, "")), 0);
  EXPECT_TRUE(has(html, "The vessel is empty."));
  EXPECT_TRUE(has(html, "feedback, empty (N)"));
}

TEST(ReportForces, VolumesAreCalledVolumes) {
  const std::string html = forces_text(SweptScene(edited(RESULT_SCENE, "fills = [0, 0.6]", "fills_ml = [0, 12.5]")), 0);
  EXPECT_TRUE(has(html, "feedback, 12.5\u00a0mL (N)") && has(html, "hold, 0\u00a0mL (N)"));
  EXPECT_FALSE(has(html, "as a share of what the vessel holds"));
}

TEST(ReportForces, AGripThatNothingHoldsHasNoChartOfIt) {
  // without friction no force of two fingers holds anything
  const std::string html = forces_text(SweptScene(edited(RESULT_SCENE, "[tilts]", "[force]\nfriction = 0\n[tilts]")), 0);
  EXPECT_TRUE(has(html, "No force of two fingers holds the vessel in this grip"));
  EXPECT_FALSE(has(html, "v-hold-title"));
  EXPECT_TRUE(has(html, "v-feedback-title"));
}

TEST(ReportForces, WithoutTiltsOrTheCoreThereAreNone) {
  EXPECT_TRUE(has(forces_text(SweptScene(edited(RESULT_SCENE, RESULT_TILTS, "")), 0), "has no tilts"));
  SweptScene swept(RESULT_SCENE);
  swept.source->core = nullptr;
  swept.source->no_core = "no mesh";
  EXPECT_TRUE(has(forces_text(swept, 0), "This part is left out: no mesh."));
}

TEST(ReportPouring, TellsTheTiltOfEachFill) {
  const SweptScene swept(RESULT_SCENE);
  const std::string html = pouring_text(swept, 1);
  EXPECT_TRUE(has(html, "<th scope=\"row\">0\u00a0%</th>\n<td>0</td>\n<td>nothing to pour</td>")) << html;
  const double tilt = degrees(swept.source->core->pouring_tilt(1, 0.6)), volume = 0.6e6 * swept.source->core->capacity(1);
  EXPECT_TRUE(has(
      html, "<th scope=\"row\">60\u00a0%</th>\n<td>" + shown_number(volume, 0) + "</td>\n<td>" + shown_number(tilt, 1) + "</td>"))
      << html;
}

TEST(ReportPouring, WithoutLiquidThereIsNone) {
  EXPECT_TRUE(has(pouring_text(SweptScene(edited(RESULT_SCENE, RESULT_LIQUID, "")), 0), "The scene has no liquid."));
  EXPECT_TRUE(
      has(pouring_text(SweptScene(edited(RESULT_SCENE, "fills = [0, 0.6]", "fills = [0]")), 0), "This vessel has nothing to pour"));
}

TEST(ShownFills, AreSpreadFromFirstToLast) {
  EXPECT_EQ(shown_fills(1), (std::vector<std::size_t>{0}));
  EXPECT_EQ(shown_fills(5), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  const auto some = shown_fills(64);
  EXPECT_EQ(some.size(), 8u);
  EXPECT_EQ(some.front(), 0u);
  EXPECT_EQ(some.back(), 63u);
}

}  // namespace
}  // namespace wholehand
