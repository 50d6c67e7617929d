// SPDX-License-Identifier: MIT
// The report of a live session: what it narrates, and how it ends.
// sanitizers: address
#include "device/run/report.h"

#include <gtest/gtest.h>

#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "tests/support/live_script.h"

namespace wholehand::device {
namespace {

Scene board_scene() { return read_scene_file(find_scene("mixing_board")); }

TEST(LiveReport, NarratesWhatHappensAndNothingTwice) {
  const Scene scene = board_scene();
  Narrator narrator(scene);
  Tick tick;
  tick.number = 2000;
  tick.state = SessionState::touching;
  EXPECT_TRUE(narrator.look(tick).empty());
  tick.state = SessionState::lift;
  tick.vessel = 1;
  tick.grasps = 1;
  tick.grasp_height = 0.045;
  tick.guidance_distance = 0.0123;
  auto lines = narrator.look(tick);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], "    2.00 s  beaker1 is held at 45 mm, 12 mm from the guidance point");
  EXPECT_TRUE(narrator.look(tick).empty());
  tick.arrived[1] = 79e-6;
  lines = narrator.look(tick);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], "    2.00 s  79.0 mL of red are in the target");
  tick.state = SessionState::slipped;
  tick.lost = 1;
  lines = narrator.look(tick);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], "    2.00 s  beaker1 slipped and returns to where it stood");
  EXPECT_NE(narrator.status(tick).find("red 79.0 of 80.0 mL"), std::string::npos) << narrator.status(tick);
}

TEST(LiveReport, TheMixingBoardAddsUpVesselsOfOneLiquid) {
  Scene scene = board_scene();
  scene.vessels[2].liquid_name = "red";
  Tick tick;
  tick.arrived[1] = 1e-6;
  tick.arrived[2] = 2e-6;
  tick.spilled[2] = 5e-7;
  for (const MixedAmount& amount : mixing_board(scene, tick)) {
    EXPECT_DOUBLE_EQ(amount.arrived, amount.liquid == "red" ? 3e-6 : 0) << amount.liquid;
    EXPECT_DOUBLE_EQ(amount.spilled, amount.liquid == "red" ? 5e-7 : 0) << amount.liquid;
  }
  scene.task.reset();
  EXPECT_TRUE(mixing_board(scene, tick).empty());
}

TEST(LiveReport, TheFaultLineSaysWhenAndWhy) {
  LoopReport report;
  report.fault = Fault::read_error;
  report.error = "unplugged";
  report.last.number = 2004;
  const LiveData live;
  GripperLimits limits;
  Guard guard(live, limits);
  report.release = ReleaseResult::written;
  EXPECT_EQ(fault_line(report, guard, live, 0.02),
            "live: a fault ended the session after 2.004 s: read error (unplugged); zero force was written");
  GripperState state;
  state.sequence = 1;
  EXPECT_EQ(guard.check(ReadOutcome::value, state, 0), Fault::none);
  state.sequence = 2;
  state.gap = 12e-3;
  report.fault = guard.check(ReadOutcome::value, state, 1);
  report.error.clear();
  EXPECT_EQ(fault_line(report, guard, live, 0.02),
            "live: a fault ended the session after 2.004 s: jump (its gap by 12 m/s; allowed: up to 5, [live] jump_m_s); zero "
            "force was written");
  report.release = ReleaseResult::refused;
  report.release_error = "unplugged";
  report.force = {{0, -2.376, 0}, 0.004};
  report.fault = Fault::interrupted;
  EXPECT_TRUE(is_force_left(report));
  EXPECT_EQ(fault_line(report, guard, live, 0.031875),
            "live: the session ended after 2.004 s; zero force could not be written (unplugged); the last force was 2.38 N at the "
            "arm and 0 N at the "
            "fingers; the device's own watchdog takes it away within 31.875 ms");
  EXPECT_EQ(fault_line(report, guard, live, UNKNOWN_WATCHDOG),
            "live: the session ended after 2.004 s; zero force could not be written (unplugged); the last force was 2.38 N at the "
            "arm and 0 N at the fingers; the device or hand must let go by itself");
  report.force = {};
  EXPECT_EQ(fault_line(report, guard, live, 0.02),
            "live: the session ended after 2.004 s; zero force could not be written (unplugged); the last force was zero");
}

TEST(AdviceNarrator, TellsOfEachBeginningOnce) {
  const Scene scene = live_scene();
  AdviceNarrator narrator(scene);
  Advice advice;
  EXPECT_FALSE(narrator.narrate(advice));
  advice.vessel = 0;
  advice.tick = 1500;
  const auto first = narrator.narrate(advice);
  ASSERT_TRUE(first);
  EXPECT_EQ(*first, "    1.50 s  advice, " + scene.vessels[0].name + ": no grip within reach is possible");
  EXPECT_FALSE(narrator.narrate(advice));
  advice.is_held = true;
  EXPECT_FALSE(narrator.narrate(advice)) << "a held grip that is not rated has no words";
  advice.present.is_possible = true;
  EXPECT_TRUE(narrator.narrate(advice));
  EXPECT_FALSE(narrator.narrate(advice));
  advice.vessel = -1;
  EXPECT_FALSE(narrator.narrate(advice));
}

TEST(TallyWords, SayTheRate) {
  EXPECT_EQ(tally_words({"core, 2 threads", 0, 0, 0, 0, 0}), "computed on core, 2 threads: 0 updates");
  EXPECT_EQ(tally_words({"core, 2 threads", 20, 20480, 0.15, 2, 19}),
            "computed on core, 2 threads: 20 updates of 1,024 grips on average, 9.5 a second, no two further apart than 0.15 s");
}

}  // namespace
}  // namespace wholehand::device
