// SPDX-License-Identifier: MIT
// What a drawing shows of a point, and when there is nothing to draw.
// sanitizers: address
#include "sweeps/grips/states.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>

#include "base/text/error.h"

namespace wholehand::sweeps {
namespace {

TEST(GripStates, AProjectedPointTouchesToo) {
  GripResult result;
  result.touch_mask = 1u << 2 | 1u << 5 | 1u << 6 | 1u << 7;
  result.tip_mask = 1u << 5;
  result.finger_mask = 1u << 6;
  result.inner_mask = 1u << 7;
  EXPECT_EQ(point_state(result, 2), PointState::touching);
  for (const int j : {5, 6, 7}) EXPECT_EQ(point_state(result, j), PointState::projected) << j;
  EXPECT_EQ(point_state(result, 3), PointState::free);
  EXPECT_STREQ(POINT_STYLES[static_cast<std::size_t>(PointState::projected)].name, "projected");
}

// In gray print the two that touch are alike, and dark beside the third; a drawing's shapes distinguish them.
TEST(GripStates, TouchingIsDarkerThanFree) {
  const auto lightness = [](PointState state) {
    const auto& c = POINT_STYLES[static_cast<std::size_t>(state)].color;
    return (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255;
  };
  EXPECT_LT(lightness(PointState::touching), 0.5);
  EXPECT_LT(lightness(PointState::projected), 0.5);
  EXPECT_GT(lightness(PointState::free), 0.99);
}

TEST(GripStates, AnInfeasibleGripIsRefusedByItsReason) {
  GripReport report;
  report.vessel = "glass";
  EXPECT_NO_THROW(check_drawable(report, "--svg"));
  report.answer.result.reason = Reason::on_mouth;
  try {
    check_drawable(report, "--svg");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_STREQ(error.what(),
                 "--svg: the grip of glass is not feasible (on_mouth), so there is no hand to draw; choose another grip");
  }
}

TEST(GripStates, TheFirstStateWithLiquidIsDrawn) {
  GripReport report;
  EXPECT_EQ(drawn_liquid(report), nullptr);
  report.answer.states.resize(3);
  EXPECT_EQ(drawn_liquid(report), nullptr);
  report.answer.states[1].liquid.volume = report.answer.states[2].liquid.volume = 1e-4;
  EXPECT_EQ(drawn_liquid(report), &report.answer.states[1]);
}

TEST(GripStates, TheHardestStateIsTheFirstOfThoseThatTakeMost) {
  GripReport report;
  EXPECT_EQ(hardest_state(report), std::nullopt);
  report.holds.resize(5);
  EXPECT_EQ(hardest_state(report), 0u);
  report.holds[1].effort = report.holds[2].effort = 0.5;
  EXPECT_EQ(hardest_state(report), 1u);
  report.holds[3].effort = report.holds[4].effort = std::numeric_limits<double>::infinity();
  EXPECT_EQ(hardest_state(report), 3u);
}

// Among states of equal effort, the hardest is the one reported as the worst: two names for one state would confuse.
TEST(GripStates, TheHardestStateIsTheWorstWhereThatIsListed) {
  GripReport report;
  report.holds.resize(3);
  report.answer.states.resize(3);
  for (std::size_t k = 0; k < 3; ++k) {
    report.holds[k].effort = 0.5 + 1e-4 * static_cast<double>(k);
    report.answer.states[k].fill = 0.5;
    report.answer.states[k].tilt = 0.1 * static_cast<double>(k);
  }
  report.hold.emplace();
  report.hold->worst_fill = 0.5;
  report.hold->worst_tilt = 0.1;
  EXPECT_EQ(hardest_state(report), 1u);
  report.hold->worst_tilt = 0.7;  // not listed
  EXPECT_EQ(hardest_state(report), 2u);
  report.hold->worst_tilt = 0.1;
  report.holds[2].effort = 0.6;  // only listed states take so much
  EXPECT_EQ(hardest_state(report), 2u);
}

// Wherever it stands, an effort that is not known is not the hardest.
TEST(GripStates, AStateWithoutAnEffortIsNotTheHardest) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  GripReport report;
  report.holds.resize(3);
  report.holds[1].effort = 0.2;
  report.holds[2].effort = 0.4;
  for (const std::size_t unknown : {0, 1}) {
    GripReport some = report;
    some.holds[unknown].effort = none;
    EXPECT_EQ(hardest_state(some), 2u) << unknown;
  }
  report.holds[2].effort = none;
  EXPECT_EQ(hardest_state(report), 1u);
  for (StateHold& hold : report.holds) hold.effort = none;
  EXPECT_EQ(hardest_state(report), std::nullopt);
}

}  // namespace
}  // namespace wholehand::sweeps
