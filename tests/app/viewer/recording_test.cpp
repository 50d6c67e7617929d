// SPDX-License-Identifier: MIT
// A recording as the viewer shows it: at any moment what was recorded then.
// sanitizers: address
#include "app/viewer/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/text/error.h"
#include "tests/support/live_script.h"

namespace wholehand {
namespace {

using nlohmann::json;

// A session in which every 7th period is missed, from tick 3 on.
device::Recording recorded(const Scene& scene) {
  LiveScript script;
  script.vessel = scene.vessels[0].place;
  device::Recording recording;
  recording.info.rate = script.rate;
  recording.info.device.name = "a gripper";
  recording.info.device.grip = 7;
  for (const VesselData& vessel : scene.vessels) recording.info.vessels.push_back({vessel.name, vessel.liquid_name, 3});
  device::Session session(scene, own_gap(scene.hand));
  for (std::int64_t n = 3; n < static_cast<std::int64_t>(script.seconds() * script.rate); ++n) {
    if (n % 7 == 0) continue;
    device::Tick tick;
    session.step(script.at(n), n, tick);
    tick.step_time = 1e-6 * static_cast<double>(n % 11);
    recording.ticks.push_back(tick);
  }
  return recording;
}

TEST(RecordingView, AFrameIsTheNewestTickByThen) {
  const Scene scene = live_scene();
  const device::Recording recording = recorded(scene);
  const RecordingView view(scene, recording);
  EXPECT_DOUBLE_EQ(view.duration(), static_cast<double>(recording.ticks.back().number + 1) / 1000);
  const auto at = [&](double time) { return view.frames(time, time, 0).at(0); };
  EXPECT_EQ(at(0).tick, 3) << "the first, where there is none yet";
  EXPECT_EQ(at(0.0131).tick, 13);
  EXPECT_EQ(at(0.014).tick, 13) << "14 was missed";
  EXPECT_EQ(at(0.015).tick, 15);
  EXPECT_EQ(at(1e6).tick, recording.ticks.back().number);
  for (std::size_t k = 0; k < recording.ticks.size(); k += 111)
    EXPECT_EQ(at(static_cast<double>(recording.ticks[k].number) / 1000).tick, recording.ticks[k].number);
}

TEST(RecordingView, TellsWhatWasRecorded) {
  Scene scene = live_scene();
  scene.strength.emplace();  // what holding takes is not recorded: it is found again
  const device::Recording recording = recorded(scene);
  const RecordingView view(scene, recording);
  const device::LiveScene live(scene);
  device::VesselTracker tracker(scene);
  FrameMaker maker(live);
  for (std::size_t k = 0; k < recording.ticks.size(); ++k) {
    const device::Tick& tick = recording.ticks[k];
    tracker.follow(tick);
    if (k % 97 != 0) continue;
    const double time = static_cast<double>(tick.number) / 1000;
    const ViewFrame seen = view.frames(time, time, 0).at(0);
    const ViewFrame truth = maker.make(tick, tracker.poses(), device::hand_view(live, tick, tracker.poses()), seen.timing);
    EXPECT_EQ(frame_json(seen), frame_json(truth)) << tick.number;
    EXPECT_EQ(seen.hand.hold.has_value(), device::is_held(tick.state)) << tick.number;
    EXPECT_EQ(seen.timing.step, tick.step_time);
    EXPECT_EQ(seen.timing.missed, tick.number - 3 - static_cast<std::int64_t>(k));
    if (time > 1.1) {
      EXPECT_NEAR(seen.timing.rate, 6000.0 / 7, 2) << "six of seven, one more or less in a second";
    }
  }
}

TEST(RecordingView, AStretchIsAFrameEachPeriod) {
  const Scene scene = live_scene();
  const RecordingView view(scene, recorded(scene));
  const auto frames = view.frames(1, 2, 60);
  ASSERT_EQ(frames.size(), 61u);
  for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(frames[k].tick, view.frames(1 + k / 60.0, 1 + k / 60.0, 0).at(0).tick);
  EXPECT_EQ(view.frames(2, 2, 60).size(), 1u);
}

TEST(RecordingView, AnswersAsJsonAndRefusesTooMuch) {
  const Scene scene = live_scene();
  const RecordingView view(scene, recorded(scene));
  const ViewContent content = view.content("mine.nc");
  const json seen = parse_json(content.scene);
  EXPECT_EQ(seen["mode"], "recording");
  EXPECT_EQ(seen["title"], "mine.nc");
  EXPECT_EQ(seen["device"], "a gripper");
  EXPECT_EQ(seen["force"]["most"], 7.0);
  EXPECT_EQ(seen["rate"], 1000);
  EXPECT_EQ(seen["duration"], view.duration());
  const json answer = parse_json(content.recording({{"from", "0.5"}, {"to", "0.6"}, {"rate", "30"}}));
  ASSERT_EQ(answer["frames"].size(), 4u);
  EXPECT_EQ(json_text(answer["frames"][3]), json_text(parse_json(frame_json(view.frames(0.6, 0.6, 0).at(0)))));
  EXPECT_EQ(parse_json(content.recording({{"from", "0"}, {"to", "9.983"}, {"rate", "60"}}))["frames"].size(), 599u);
  using Query = ViewContent::Query;
  for (const Query& bad : {Query{{"from", "0"}, {"to", "10"}, {"rate", "60"}}, Query{{"from", "2"}, {"to", "1"}, {"rate", "60"}},
                           Query{{"from", "-1"}, {"to", "1"}, {"rate", "1"}}, Query{{"from", "0"}, {"to", "1e9"}, {"rate", "1e9"}},
                           Query{{"from", "0"}, {"to", "1"}}, Query{{"from", "0"}, {"to", "1"}, {"rate", "x"}}})
    EXPECT_THROW(content.recording(bad), Error);
}

// The page asks for all of it with the duration to 1e-6 s: rounded up here, that must not make it one frame too many.
TEST(RecordingView, AllOfItIsAtMostTheMostFramesWhateverTheRate) {
  const Scene scene = live_scene();
  struct Case {
    double rate;
    std::int64_t last;  // tick
    const char* duration;
  };
  for (const Case& c : {Case{333, 598, "1.798799"}, Case{1500, 3000, "2.000667"}}) {
    device::Recording recording = recorded(scene);
    std::erase_if(recording.ticks, [&](const device::Tick& tick) { return tick.number > c.last; });
    recording.info.rate = c.rate;
    const RecordingView view(scene, recording);
    EXPECT_NEAR(view.duration(), std::stod(c.duration), 5e-7);
    EXPECT_LT(view.duration(), std::stod(c.duration));
    const std::string rate = fmt::format("{}", std::min(c.rate, (MOST_RECORDED_FRAMES - 1) / view.duration()));
    const json answer = parse_json(view.content("").recording({{"from", "0"}, {"to", c.duration}, {"rate", rate}}));
    EXPECT_EQ(answer["frames"].size(), static_cast<std::size_t>(MOST_RECORDED_FRAMES)) << c.rate;
  }
}

TEST(RecordingView, RefusesARecordingWithoutTicksOrOfAnotherScene) {
  const Scene scene = live_scene();
  device::Recording empty = recorded(scene);
  empty.ticks.clear();
  EXPECT_THROW(RecordingView(scene, empty), Error);
  device::Recording other = recorded(scene);
  other.info.vessels.pop_back();
  EXPECT_THROW(RecordingView(scene, other), Error);
}

}  // namespace
}  // namespace wholehand
