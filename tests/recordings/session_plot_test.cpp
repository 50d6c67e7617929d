// SPDX-License-Identifier: MIT
// sanitizers: address
#include "recordings/session_plot.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/files.h"

namespace wholehand {
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

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
  return found;
}

TEST(SessionPlot, ShowsForcesTiltAndStates) {
  const Recording recording = some_recording();
  const std::string script = session_plot_script(recording, report_session(recording), "/tmp/a.svg");
  EXPECT_EQ(count(script, "\nplot "), 3u);
  EXPECT_EQ(count(script, "set object "), 2u) << "a shade for each state but free";
  EXPECT_NE(script.find("from first 10.000000, graph 0 to first 20.000000, graph 1"), std::string::npos);
  EXPECT_NE(script.find("set label 'T' at first 25.000000"), std::string::npos);
  EXPECT_NE(script.find("it''s a bench"), std::string::npos);
  EXPECT_NE(script.find("\n23.456000 7.25\n"), std::string::npos) << "one tick that stands out is drawn";
  EXPECT_LT(script.size(), 400000u) << "not every tick";
  // while nothing is held there is no tilt and no grip force
  const std::string grip = script.substr(script.find("$grip << EOD"));
  EXPECT_EQ(grip.find("\n5.0"), std::string::npos);
  EXPECT_NE(grip.find("\n15.0"), std::string::npos);
}

TEST(SessionPlot, IsDrawn) {
  const std::string file = (std::filesystem::temp_directory_path() / "wholehand_session_plot_test.svg").string();
  std::filesystem::remove(file);
  for (const std::size_t ticks : {std::size_t{40000}, std::size_t{1}}) {
    Recording recording = some_recording();
    recording.ticks.resize(ticks);
    EXPECT_EQ(draw_session(recording, report_session(recording), file), "");
    const std::string svg = file_text(file);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    for (const char* part : {"feedback force / N", "tilt / deg", "grip force / N", "time / s", "maintain"})
      EXPECT_NE(svg.find(part), std::string::npos) << part;
    std::filesystem::remove(file);
  }
}

}  // namespace
}  // namespace wholehand
