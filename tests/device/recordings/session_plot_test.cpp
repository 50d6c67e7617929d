// SPDX-License-Identifier: MIT
// sanitizers: address
#include "device/recordings/session_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/charts/colors.h"
#include "base/files/pictures.h"
#include "tests/support/drawn.h"
#include "tests/support/files.h"
#include "tests/support/xml.h"

namespace wholehand::device {
namespace {

// 40 s: free, lift, tilt with one tick of a much larger force, free.
Recording some_recording() {
  Recording recording;
  recording.info.scene_name = "it's a bench";
  recording.info.device.name = "omega.7";
  recording.info.vessels = {{"one", "", 2}};
  for (Tick tick; tick.number < 40000; ++tick.number) {
    const auto second = tick.number / 10000;
    tick.state = second == 1 ? SessionState::lift : second == 2 ? SessionState::tilt : SessionState::free;
    tick.vessel = is_held(tick.state) ? 0 : -1;
    tick.tilt = second == 2 ? radians(60) : 0;
    tick.user_force = is_held(tick.state) ? 3.5 : 0;
    tick.feedback = tick.number == 23456 ? 7.25 : tick.user_force;
    recording.ticks.push_back(tick);
  }
  return recording;
}

std::string drawn_session(const Recording& recording) {
  const std::string svg = session_picture(recording, report_session(recording));
  expect_well_formed(svg);
  return svg;
}

TEST(SessionPlot, ShowsForcesTiltAndStates) {
  const std::string svg = drawn_session(some_recording());
  const auto axes = drawn_axes(svg);
  ASSERT_EQ(axes.size(), 3u);
  for (const char* part : {"feedback force (N)", "tilt (°)", "grip force (N)", "time (s)", "maintain (M)", "touching",
                           "normal force", "Session in it&#39;s a bench, on omega.7"})
    EXPECT_TRUE(has(svg, part)) << part;
  EXPECT_TRUE(has(svg, std::string(PICTURE_MARK)));
  EXPECT_LT(svg.size(), 100000u) << "not every tick";
  // a shade for each state but free, in each panel; its letter above the uppermost
  const auto lift = drawn_boxes(svg, tint(okabe_ito::SKY_BLUE, 0.28)), tilt = drawn_boxes(svg, tint(okabe_ito::ORANGE, 0.45));
  ASSERT_EQ(lift.size(), 3u);
  ASSERT_EQ(tilt.size(), 3u);
  EXPECT_EQ(count_of(svg, "class=\"cell\""), 6);
  for (std::size_t k = 0; k < axes.size(); ++k) {
    EXPECT_NEAR((lift[k][0] - axes[k].left) / axes[k].width, 0.25, 1e-3);
    EXPECT_NEAR((lift[k][2] - axes[k].left) / axes[k].width, 0.5, 1e-3);
    EXPECT_NEAR(lift[k][3] - lift[k][1], axes[k].height, 0.1);
  }
  const auto letter = drawn_text(svg, "T");
  EXPECT_NEAR((letter[0] - axes[0].left) / axes[0].width, 0.625, 1e-3);
  EXPECT_LT(letter[1], axes[0].top);
}

TEST(SessionPlot, OneTickThatStandsOutIsDrawn) {
  const std::string svg = drawn_session(some_recording());
  const auto axes = drawn_axes(svg);
  const auto lines = drawn_lines(svg, "#000000");
  double highest = 0;
  for (const auto& line : lines) {
    for (const auto& point : line) {
      const auto [x, y] = axes[0].share(point);
      if (!(y > highest && y <= 1)) continue;
      highest = y;
      EXPECT_TRUE(y < 0.9 || std::abs(x - 23.456 / 40) < 1e-3) << x;
    }
  }
  EXPECT_NEAR(highest, 1 / 1.05, 2e-3) << "with a twentieth of room";
}

// While nothing is held there is no tilt and no grip force.
TEST(SessionPlot, WhatIsNotHeldHasNoLine) {
  const std::string svg = drawn_session(some_recording());
  const DrawnAxes grip = drawn_axes(svg).at(2);
  int held = 0;
  for (const auto& line : drawn_lines(svg, "#000000")) {
    if (line[0][1] < grip.top) continue;
    ++held;
    for (const auto& point : line) {
      EXPECT_GE(grip.share(point)[0], 0.25 - 1e-3);
      EXPECT_LE(grip.share(point)[0], 0.75 + 1e-3);
    }
  }
  EXPECT_EQ(held, 1);
}

TEST(SessionPlot, OfOneTickAndOfNoNumbersIsDrawn) {
  const Recording whole = some_recording();
  for (const std::size_t ticks : {std::size_t{2000}, std::size_t{1}}) {
    Recording recording = whole;
    recording.ticks.resize(ticks);
    EXPECT_EQ(drawn_axes(drawn_session(recording)).size(), 3u);
    for (Tick& tick : recording.ticks) tick.feedback = tick.tilt = Tick::NONE;
    EXPECT_EQ(drawn_axes(drawn_session(recording)).size(), 3u);
    recording.ticks[0].feedback = HUGE_VAL;
    EXPECT_EQ(drawn_axes(drawn_session(recording)).size(), 3u);
    for (const double tilt : {1e8, 1e300}) {  // of a damaged recording: no tick for each 30 degrees of it
      for (Tick& tick : recording.ticks) tick.tilt = tilt;
      EXPECT_LT(drawn_session(recording).size(), 100000u) << tilt;
    }
  }
}

}  // namespace
}  // namespace wholehand::device
