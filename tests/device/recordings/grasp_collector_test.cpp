// SPDX-License-Identifier: MIT
// Grasps that are collected tick by tick against the same rules read from all ticks at once.
// sanitizers: address
#include "device/recordings/grasp_collector.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/numbers/random_bits.h"
#include "device/recordings/session_report.h"
#include "tests/support/recorded_session.h"

namespace wholehand::device {
namespace {

constexpr double COLLECTED_MAX = 5;  // F_max, N

// Ticks without a sense, so that every order of states, vessels, losses and faults comes up.
std::vector<Tick> senseless_ticks(std::uint64_t seed) {
  std::uint64_t state = seed;
  const auto below = [&state](int count) { return static_cast<int>(unit_interval(split_mix(state)) * count); };
  std::vector<Tick> ticks;
  Tick tick;
  for (int stretch = 0; stretch < 60; ++stretch) {
    tick.state = static_cast<SessionState>(below(SESSION_STATES));
    tick.vessel = below(4) - 1;
    for (int k = below(6) + 1; k > 0; --k) {
      tick.number += 1 + below(2);
      tick.lost += below(8) == 0 ? 1 : 0;
      tick.user_force = below(1000) * 6e-3;
      tick.feedback = tick.user_force;
      tick.tilt = below(90) * PI / 180;
      for (std::size_t v = 0; v < 3; ++v) {
        tick.arrived[v] += below(100) * 1e-7;
        tick.spilled[v] += below(100) * 1e-8;
      }
      ticks.push_back(tick);
    }
  }
  return ticks;
}

bool goes_on(const Tick& a, const Tick& b) { return is_held(b.state) && a.vessel == b.vessel; }

// docs/session.md, word by word: an outcome is that of the ticks from the grasp's end to the next grasp, and liquid counts until
// the vessel's next grasp.
std::vector<GraspReport> grasps_at_once(const std::vector<Tick>& ticks) {
  std::vector<GraspReport> grasps;
  for (std::size_t first = 0, end = 0; first < ticks.size(); first = end) {
    end = first + 1;
    if (!is_held(ticks[first].state)) continue;
    while (end < ticks.size() && goes_on(ticks[first], ticks[end])) ++end;
    if (ticks[first].vessel < 0) continue;
    GraspOutcome outcome = end == ticks.size()                          ? GraspOutcome::recording_ends
                           : ticks[end].state == SessionState::released ? GraspOutcome::released
                                                                        : GraspOutcome::let_go;
    for (std::size_t k = end; k < ticks.size(); ++k) {
      if (ticks[k].lost > ticks[end - 1].lost) outcome = GraspOutcome::lost;
      if (ticks[k].lost > ticks[end - 1].lost || is_held(ticks[k].state)) break;
    }
    const auto held = std::span(ticks).subspan(first, end - first);
    GraspReport grasp = measure_grasp(held, 1000, outcome == GraspOutcome::lost);
    grasp.outcome = outcome;
    std::size_t last = end;
    while (last < ticks.size() && !(is_held(ticks[last].state) && ticks[last].vessel == grasp.vessel)) ++last;
    if (last == ticks.size()) --last;
    const auto v = static_cast<std::size_t>(grasp.vessel);
    grasp.arrived = ticks[last].arrived[v] - ticks[first].arrived[v];
    grasp.spilled = ticks[last].spilled[v] - ticks[first].spilled[v];
    grasps.push_back(grasp);
  }
  return grasps;
}

std::vector<GraspReport> collected(const std::vector<Tick>& ticks) {
  GraspCollector collector(1000, COLLECTED_MAX);
  for (const Tick& tick : ticks) collector.add(tick);
  return collector.finish();
}

std::uint64_t collected_bits(double value) { return std::isnan(value) ? 0 : std::bit_cast<std::uint64_t>(value); }

TEST(GraspCollector, SaysWhatAllTicksAtOnceSay) {
  int outcomes[4] = {};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const std::vector<Tick> ticks = senseless_ticks(seed);
    const std::vector<GraspReport> expected = grasps_at_once(ticks), found = collected(ticks);
    ASSERT_EQ(found.size(), expected.size()) << seed;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const std::string place = "session " + std::to_string(seed) + ", grasp " + std::to_string(k);
      EXPECT_EQ(found[k].vessel, expected[k].vessel) << place;
      EXPECT_EQ(found[k].outcome, expected[k].outcome) << place;
      for (const auto member : {&GraspReport::start, &GraspReport::end, &GraspReport::largest_tilt, &GraspReport::grip_change,
                                &GraspReport::after_at_first, &GraspReport::arrived, &GraspReport::spilled, &GraspReport::poured})
        EXPECT_EQ(collected_bits(found[k].*member), collected_bits(expected[k].*member)) << place;
      EXPECT_EQ(collected_bits(found[k].before.mean), collected_bits(expected[k].before.mean)) << place;
      ++outcomes[static_cast<std::size_t>(found[k].outcome)];
    }
  }
  // every way to end was there
  for (const int count : outcomes) EXPECT_GT(count, 0);
}

// A loss that is counted while nothing is held, long after the grasp, is the grasp's; with the next grasp it is too late.
TEST(GraspCollector, LossIsThatOfTheGraspBefore) {
  RecordedSession session;
  session.hold(0).stretch(0.1, SessionState::lift).stretch(0.3, SessionState::free);
  session.with([](Tick& tick) { ++tick.lost; }).stretch(0.1, SessionState::free);
  session.hold(1).stretch(0.1, SessionState::lift).with([](Tick& tick) { ++tick.lost; }).stretch(0.1, SessionState::lift);
  session.stretch(0.1, SessionState::free);
  const auto grasps = collected(session.recording.ticks);
  ASSERT_EQ(grasps.size(), 2u);
  EXPECT_EQ(grasps[0].outcome, GraspOutcome::lost);
  EXPECT_EQ(grasps[1].outcome, GraspOutcome::let_go);
}

TEST(GraspCollector, WithoutTicksThereAreNoGrasps) { EXPECT_TRUE(collected({}).empty()); }

// 4 N over the first 0.1 s, then 6 N: only the beginning counts.
TEST(GraspCollector, ForceAtFirstWhileMaintained) {
  RecordedSession session;
  session.hold(0).stretch(0.5, SessionState::lift, [](double, Tick& tick) { tick.user_force = 2; });
  session.stretch(1, SessionState::tilt, [](double t, Tick& tick) { tick.tilt = t; });
  session.stretch(1, SessionState::maintain, [](double t, Tick& tick) { tick.user_force = t < 0.1005 ? 4 : 6; });
  session.stretch(0.5, SessionState::free);
  const auto grasps = collected(session.recording.ticks);
  ASSERT_EQ(grasps.size(), 1u);
  EXPECT_DOUBLE_EQ(grasps[0].after_at_first, 4);
  EXPECT_GT(grasps[0].after.mean, 5.7);
}

}  // namespace
}  // namespace wholehand::device
