// SPDX-License-Identifier: MIT
// Advice in step with a session: the same each time, there a moment later, and ended by a device that fails.
// sanitizers: address
#include "device/advice/stepped_advice.h"

#include <gtest/gtest.h>

#include "tests/support/advised_session.h"

namespace wholehand::device {
namespace {

// The grips that are shown in a session, with the ticks at which they come.
std::vector<std::pair<std::int64_t, ShownGrip>> shown_in(const Scene& scene, const std::vector<Tick>& record, int threads) {
  SteppedAdvice::Options options;
  options.threads = threads;
  options.keeps_line = true;
  options.grips = LEAST_CLOUD;
  SteppedAdvice advice(scene, "core", options);
  std::vector<std::pair<std::int64_t, ShownGrip>> shown;
  ShownGrip grip;
  VesselTracker vessels(scene);
  for (const Tick& tick : record) {
    vessels.follow(tick);
    advice.look(tick, vessels.poses());
    if (advice.take(tick.number, grip)) shown.emplace_back(tick.number, grip);
  }
  return shown;
}

TEST(SteppedAdvice, IsTheSameEachTimeAndOnAnyThreads) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  const auto one = shown_in(scene, record, 1), two = shown_in(scene, record, 2);
  ASSERT_EQ(one.size(), two.size());
  ASSERT_GT(one.size(), 10u);
  bool has_grip = false;
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].first, two[k].first);
    EXPECT_EQ(one[k].first % 200, 0) << "five times a second of 1 kHz";
    EXPECT_EQ(one[k].second.vessel, two[k].second.vessel);
    EXPECT_EQ(one[k].second.grip.height, two[k].second.grip.height);
    EXPECT_EQ(one[k].second.grip.roll, two[k].second.grip.roll);
    EXPECT_EQ(one[k].second.grip.azimuth, 0);
    EXPECT_EQ(one[k].second.grip.offset, 0);
    has_grip = has_grip || one[k].second.vessel == 0;
  }
  EXPECT_TRUE(has_grip);
}

// The answer to a question is there at the next moment, and not before.
TEST(SteppedAdvice, TakesItsTime) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  SteppedAdvice::Options options;
  options.threads = 1;
  options.grips = LEAST_CLOUD;
  SteppedAdvice advice(scene, "core", options);
  VesselTracker vessels(scene);
  for (const Tick& tick : record) {
    vessels.follow(tick);
    advice.look(tick, vessels.poses());
    if (tick.number < 200) {
      EXPECT_FALSE(advice.newest());
    } else {
      ASSERT_TRUE(advice.newest()) << tick.number;
      EXPECT_EQ(advice.newest()->tick, (tick.number / 200 - 1) * 200);
    }
  }
  EXPECT_GT(advice.tally().updates, 10u);
}

TEST(SteppedAdvice, AsksNothingWhileHeldWhereNobodyFollows) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  SteppedAdvice::Options options;
  options.threads = 1;
  options.while_held = false;
  options.grips = LEAST_CLOUD;
  SteppedAdvice advice(scene, "core", options);
  int near = 0, held = 0;  // ticks
  VesselTracker vessels(scene);
  for (const Tick& tick : record) {
    vessels.follow(tick);
    advice.look(tick, vessels.poses());
    if (tick.number < 200) continue;
    ASSERT_TRUE(advice.newest()) << tick.number;
    EXPECT_FALSE(advice.newest()->is_held);
    near += advice.newest()->vessel == 0;
    if (!is_held(record[static_cast<std::size_t>((tick.number / 200 - 1) * 200)].state)) continue;
    ++held;
    EXPECT_EQ(advice.newest()->vessel, -1);
  }
  EXPECT_GE(near, 200);
  EXPECT_GE(held, 200);
}

// Five runs suffice to advise. After the next run, which fails, there is no advice to show or to follow, and one line says why.
TEST(SteppedAdvice, IsEndedByADeviceThatFails) {
  const Scene scene = advised_session_scene();
  const std::vector<Tick> record = play_session(scene, script_for(scene));
  SteppedAdvice::Options options;
  options.keeps_line = true;
  options.grips = LEAST_CLOUD;
  SteppedAdvice advice(scene, dying_adviser(5), options);
  ShownGrip grip;
  bool was_advised = false, is_ended = false;
  VesselTracker vessels(scene);
  for (const Tick& tick : record) {
    vessels.follow(tick);
    advice.look(tick, vessels.poses());
    const bool is_new = advice.take(tick.number, grip);
    was_advised = was_advised || advice.newest();
    if (is_ended) {
      ASSERT_FALSE(advice.newest() || is_new) << tick.number;
      continue;
    }
    const std::vector<std::string> warnings = advice.take_warnings();
    if (warnings.empty()) continue;
    is_ended = true;
    EXPECT_EQ(warnings, std::vector<std::string>{"advice: the device is gone; the session goes on without advice"});
    EXPECT_FALSE(advice.newest());
    EXPECT_TRUE(is_new);
    EXPECT_EQ(grip.vessel, -1);
  }
  EXPECT_TRUE(was_advised && is_ended);
  EXPECT_TRUE(advice.take_warnings().empty());
  EXPECT_EQ(advice.tally().updates, 5u);
}

}  // namespace
}  // namespace wholehand::device
