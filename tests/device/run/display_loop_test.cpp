// SPDX-License-Identifier: MIT
// What a session shows at display rate: the newest tick, each once, the last one always.
// sanitizers: thread
#include "device/run/display_loop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <vector>

#include "tests/support/live_script.h"

namespace wholehand::device {
namespace {

// Keeps what it is shown.
class Keeper final : public Display {
 public:
  bool is_watched() override { return watched; }
  void show(const DisplayMoment& moment) noexcept override {
    numbers.push_back(moment.tick.number);
    states.push_back(moment.tick.state);
    timings.push_back(moment.timing);
    places.push_back(moment.poses[1].place);
    tips.push_back(moment.hand.proxies[THUMB_TIP]);
    advised.push_back(moment.advice ? std::optional(moment.advice->vessel) : std::nullopt);
    ++count;
  }
  std::atomic<bool> watched{true};
  std::atomic<int> count{0};
  std::vector<std::int64_t> numbers;
  std::vector<SessionState> states;
  std::vector<DisplayTiming> timings;
  std::vector<Triple> places, tips;
  std::vector<std::optional<int>> advised;  // vessel; nothing: nobody was asked
};

Tick tick_of(std::int64_t number) {
  Tick tick;
  tick.number = number;
  tick.gap = 0.08;
  tick.closure = 0.3;
  tick.tips = tick.proxies = {Triple{-0.04, 1, 0}, Triple{0.04, 1, 0}};
  tick.middle = {0, 1, 0};
  return tick;
}

void wait_for(const Keeper& keeper, int count) {
  for (int k = 0; k < 4000 && keeper.count < count; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_GE(keeper.count, count);
}

TEST(DisplayLoop, ShowsTheNewestAndNothingTwice) {
  const LiveScene live(live_scene());
  Keeper keeper;
  DisplayLoop loop(live, {&keeper});
  const std::vector<Tick> first{tick_of(0), tick_of(1), tick_of(2)};
  loop.look(first, {});
  wait_for(keeper, 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // nothing new in some periods
  const std::vector<Tick> second{tick_of(3)};
  loop.look(second, {});
  loop.stop();
  EXPECT_EQ(keeper.numbers, (std::vector<std::int64_t>{2, 3}));
  EXPECT_EQ(keeper.tips[0], (Triple{-0.04, 1, 0}));
}

TEST(DisplayLoop, TheLastTickIsAlwaysShown) {
  const LiveScene live(live_scene());
  for (int round = 0; round < 20; ++round) {
    Keeper keeper;
    DisplayLoop loop(live, {&keeper});
    for (int k = 0; k < 50; ++k) loop.look(std::vector<Tick>{tick_of(k)}, {});
    Tick last = tick_of(50);
    last.state = SessionState::released;
    loop.look(std::vector<Tick>{last}, {});
    loop.stop();
    ASSERT_FALSE(keeper.numbers.empty());
    EXPECT_EQ(keeper.numbers.back(), 50);
    EXPECT_EQ(keeper.states.back(), SessionState::released);
  }
}

TEST(DisplayLoop, ShowsVesselsWhereTheyAre) {
  const LiveScene live(live_scene());
  Keeper keeper;
  DisplayLoop loop(live, {&keeper});
  VesselPoses poses;
  poses[1].place = {0.5, 0.1, 0.2};
  loop.look(std::vector<Tick>{tick_of(0)}, poses);
  loop.stop();
  ASSERT_EQ(keeper.places.size(), 1u);
  EXPECT_EQ(keeper.places[0], poses[1].place);
}

TEST(DisplayLoop, TellsMissedPeriodsAndTheLongestStepSinceTheMomentBefore) {
  const LiveScene live(live_scene());
  Keeper keeper;
  DisplayLoop loop(live, {&keeper});
  std::vector<Tick> ticks{tick_of(5), tick_of(6), tick_of(9), tick_of(10)};
  ticks[1].step_time = 30e-6;
  ticks[3].step_time = 10e-6;
  loop.look(ticks, {});
  wait_for(keeper, 1);
  std::vector<Tick> more{tick_of(11)};
  more[0].step_time = 5e-6;
  loop.look(more, {});
  loop.stop();
  ASSERT_EQ(keeper.timings.size(), 2u);
  EXPECT_EQ(keeper.timings[0].step, 30e-6);
  EXPECT_EQ(keeper.timings[0].missed, 2);
  EXPECT_EQ(keeper.timings[1].step, 5e-6);
  EXPECT_EQ(keeper.timings[1].missed, 2);
  EXPECT_EQ(keeper.timings[0].rate, live.scene.live.rate);
  EXPECT_EQ(keeper.timings[1].rate, live.scene.live.rate) << "none missed since";
}

// Once there is no advice any more, displays get that too, so that they remove the advice shown before.
TEST(DisplayLoop, TellsWhereThereIsNoAdvice) {
  const LiveScene live(live_scene());
  const auto advised = [&](const AdviceSource& source) {
    Keeper keeper;
    DisplayLoop loop(live, {&keeper}, source);
    loop.look(std::vector<Tick>{tick_of(0)}, {});
    loop.stop();
    return keeper.advised;
  };
  const auto advice = std::make_shared<Advice>();
  advice->vessel = 1;
  EXPECT_EQ(advised([&] { return advice; }), std::vector<std::optional<int>>{1});
  EXPECT_EQ(advised([] { return nullptr; }), std::vector<std::optional<int>>{-1});
  EXPECT_EQ(advised({}), std::vector<std::optional<int>>{std::nullopt});
}

TEST(DisplayLoop, TheRateIsThatOfTicksThatCame) {
  const LiveScene live(live_scene());
  Keeper keeper;
  DisplayLoop loop(live, {&keeper});
  loop.look(std::vector<Tick>{tick_of(0)}, {});
  wait_for(keeper, 1);
  std::vector<Tick> every_other;
  for (int k = 1; k <= 100; ++k) every_other.push_back(tick_of(2 * k));
  loop.look(every_other, {});
  loop.stop();
  ASSERT_EQ(keeper.timings.size(), 2u);
  EXPECT_DOUBLE_EQ(keeper.timings[1].rate, 0.5 * live.scene.live.rate);
}

TEST(DisplayLoop, PosesNoHandForNobody) {
  const LiveScene live(live_scene());
  Keeper keeper;
  keeper.watched = false;
  DisplayLoop loop(live, {&keeper});
  loop.look(std::vector<Tick>{tick_of(0)}, {});
  loop.stop();
  EXPECT_EQ(keeper.count, 0);
  loop.stop();  // once more does nothing
}

}  // namespace
}  // namespace wholehand::device
