// SPDX-License-Identifier: MIT
// The loop around a session where time is lost: stalls, and calls that take long or never return.
// sanitizers: thread
#include "device/loop/haptic_loop.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "base/system/clock.h"
#include "device/simulated/replay_gripper.h"
#include "tests/support/loop_rig.h"

namespace wholehand::device {
namespace {

// ---- stalls ----

// A force from the first tick on, as large as it will be.
void press_at_once(LoopRig& run) {
  run.options.is_simulated = false;
  run.options.seconds = 20;
  run.scene.live.ramp = 0;
  run.scene.live.slew = 1e9;
  run.scene.live.late_steps = 1 << 30;
  run.scene.live.jump = 1000;
}

// The process stalls while it waits for a measurement, while it writes, and between two ticks: the next force is none. At
// every rate, since a stall is a time and no number of ticks.
TEST(HapticLoop, AfterAStallTheFirstForceIsZero) {
  for (const double rate : {250.0, 1000.0}) {
    for (const std::string place : {"read", "write", "sink"}) {
      SCOPED_TRACE(place + " " + std::to_string(rate));
      LoopRig run;
      press_at_once(run);
      run.scene.live.rate = rate;
      std::size_t after = 0;  // the first write after it
      const auto stall = [&](const char* where) {
        if (where != place || after > 0 || run.gripper.written.size() < 30 || is_zero(run.gripper.written.back())) return;
        after = run.gripper.written.size();
        std::this_thread::sleep_for(std::chrono::duration<double>(1.05 * STALL));
      };
      run.gripper.tamper = [&](std::int64_t, GripperState&) {
        stall("read");
        return ReadOutcome::value;
      };
      run.gripper.refuses = [&](const GripperForce&) {
        stall("write");
        return false;
      };
      run.sink = [&](const Tick& tick) {
        run.sunk.push_back(tick);
        stall("sink");
        return true;
      };
      run.gripper.done = [&] { return after > 0 && run.gripper.written.size() > after + 10; };
      EXPECT_EQ(run.go().fault, Fault::none);
      ASSERT_GT(after, 0u);
      EXPECT_FALSE(is_zero(run.gripper.written[after - 1]));
      EXPECT_TRUE(is_zero(run.gripper.written[after]));
      // the tick numbers show it too, for a replay
      EXPECT_GE(static_cast<double>(run.sunk[after].number - run.sunk[after - 1].number) / rate, STALL);
    }
  }
}

// A measurement read before the stall belongs to the tick in which it arrives.
TEST(HapticLoop, TheTickAfterAStallHasTheClocksNumber) {
  LoopRig run;
  press_at_once(run);
  run.gripper.done = [&] { return run.gripper.ticks.size() > 60; };
  const auto start = std::chrono::steady_clock::now();
  run.gripper.tamper = [&](std::int64_t, GripperState&) {
    if (run.gripper.ticks.size() == 40) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return ReadOutcome::value;
  };
  double ended = 0;
  run.sink = [&](const Tick& tick) {
    run.sunk.push_back(tick);
    ended = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return true;
  };
  const LoopReport report = run.go();
  ASSERT_GT(run.sunk.size(), 50u);
  EXPECT_GE(run.sunk[39].number - run.sunk[38].number, 100);
  EXPECT_LE(static_cast<double>(run.sunk.back().number), 1e3 * ended) << "no number is ahead of the clock";
  EXPECT_GE(report.missed, 99);
  // up to the end, which may miss periods as well
  EXPECT_EQ(report.ticks + report.missed, run.sunk.back().number);
}

// A measurement taken before its read stalls arrives after the stall. A hand that moves at 0.4 m/s has not jumped in the next tick, which
// would be 40 times as fast; and a replay, which knows the numbers alone, agrees.
TEST(HapticLoop, AStallInsideOfAReadIsNoJump) {
  LoopRig run;
  press_at_once(run);
  run.scene.live.jump = 5;
  run.gripper.at = [](std::int64_t tick) {
    GripperState state = pressing(tick);
    state.position[1] = 0.3 + 4e-4 * static_cast<double>(tick);
    return state;
  };
  run.gripper.tamper = [&](std::int64_t, GripperState&) {
    if (run.gripper.ticks.size() == 40) std::this_thread::sleep_for(std::chrono::milliseconds(40));
    return ReadOutcome::value;
  };
  run.gripper.done = [&] { return run.gripper.ticks.size() > 60; };
  ASSERT_EQ(run.go().fault, Fault::none);
  ASSERT_GE(run.sunk[39].number - run.sunk[38].number, 40);
  LoopRig again;
  again.scene = run.scene;
  again.options.seconds = 0;
  Session session(again.scene, run.gripper.limits().gap);
  const auto replay = make_replay(run.sunk, run.gripper.limits());
  HapticLoop loop(again.scene.live, *replay, session, again.sink, again.options);
  loop.run(NEVER_STOPPED);
  EXPECT_EQ(loop.report().fault, Fault::none) << loop.guard().jump();
  EXPECT_EQ(again.sunk.size(), run.sunk.size());
}

// What a session with stalls wrote, its replay writes.
TEST(HapticLoop, AReplayOfStallsWritesTheSame) {
  LoopRig run;
  press_at_once(run);
  run.scene.live.ramp = 0.02;
  int ticks = 0;
  run.gripper.tamper = [&](std::int64_t, GripperState&) {
    if (++ticks % 40 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(14 + ticks / 40));
    return ReadOutcome::value;
  };
  run.gripper.done = [&] { return ticks >= 200; };
  ASSERT_EQ(run.go().fault, Fault::none);
  LoopRig again;
  again.scene = run.scene;
  again.options.is_simulated = true;
  again.options.seconds = 0;
  Session session(again.scene, run.gripper.limits().gap);
  const auto replay = make_replay(run.sunk, run.gripper.limits());
  HapticLoop loop(again.scene.live, *replay, session, again.sink, again.options);
  loop.run(NEVER_STOPPED);
  ASSERT_EQ(again.sunk.size(), run.sunk.size());
  int zeros = 0;
  for (std::size_t k = 0; k + 1 < run.sunk.size(); ++k) {
    EXPECT_EQ(again.sunk[k].number, run.sunk[k].number);
    EXPECT_TRUE(same_force(again.sunk[k].written, run.sunk[k].written)) << k;
    zeros += k > 0 && is_zero(run.sunk[k].written) && !is_zero(run.sunk[k].wanted);
  }
  EXPECT_GE(zeros, 4);
}

// ---- calls that take long ----

// Reads are waits for the device, but not for longer than its patience: three in a row end the session, one alone does not.
TEST(HapticLoop, ReadsThatTakeLongAreLateSteps) {
  for (const int most : {1, 3}) {
    LoopRig run;
    press_at_once(run);
    run.scene.live.rate = 250;
    run.scene.live.late_steps = 3;
    int slow = 0;
    run.gripper.tamper = [&](std::int64_t, GripperState&) {
      if (run.gripper.written.size() > 20 && slow < most) {
        ++slow;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
      return ReadOutcome::value;
    };
    run.gripper.done = [&] { return run.gripper.ticks.size() > 60; };
    const LoopReport report = run.go();
    EXPECT_EQ(report.fault, most == 3 ? Fault::late : Fault::none);
    EXPECT_GE(report.late, most);
    EXPECT_TRUE(is_zero(run.gripper.written.back()));
  }
}

// A call that does not return: a second thread writes zero force, and what the loop writes next is zero, however short the stall.
TEST(HapticLoop, TheWatchTakesTheForceAwayMeanwhile) {
  for (const std::string place : {"read", "write"}) {
    SCOPED_TRACE(place);
    LoopRig run;
    press_at_once(run);
    CallWatch watch(run.gripper);
    run.options.watch = &watch;
    std::size_t after = 0;
    const auto stick = [&](const char* where) {
      if (where != place || after > 0 || run.gripper.written.size() < 30) return;
      after = run.gripper.written.size();
      for (int k = 0; k < 10000 && run.gripper.meanwhiles == 0; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    run.gripper.tamper = [&](std::int64_t, GripperState&) {
      stick("read");
      return ReadOutcome::value;
    };
    run.gripper.refuses = [&](const GripperForce&) {
      stick("write");
      return false;
    };
    run.gripper.done = [&] { return after > 0 && run.gripper.written.size() > after + 10; };
    const LoopReport report = run.go();
    EXPECT_EQ(report.fault, Fault::none) << "one alone is late and no more";
    EXPECT_GE(report.late, 1);
    EXPECT_GE(run.gripper.meanwhiles, 1);
    EXPECT_GE(watch.count(), 1);
    ASSERT_GT(after, 0u);
    EXPECT_FALSE(is_zero(run.gripper.written[after - 1]));
    EXPECT_TRUE(is_zero(run.gripper.written[after]));
    const auto warning = watch.take_warning();
    ASSERT_TRUE(warning);
    EXPECT_EQ(*warning, "a call of the device did not return within 12 ms; meanwhile zero force was written");
    EXPECT_FALSE(watch.take_warning()) << "once";
  }
}

// A call returns while the watch examines it: its end reports the zero, or none was written. The short call after it must not report
// the zero in its place.
TEST(HapticLoop, TheWatchActsOnNoCallThatHasReturned) {
  ScriptedGripper gripper;
  int reports = 0;
  // each on a processor of its own, as far as there are two: else the one would stall while the other checks
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  std::vector<cpu_set_t> each;
  for (std::size_t k = 0; k < CPU_SETSIZE; ++k) {
    if (!CPU_ISSET(k, &before)) continue;
    CPU_ZERO(&each.emplace_back());
    CPU_SET(k, &each.back());
  }
  {
    sched_setaffinity(0, sizeof before, &each.front());
    CallWatch watch(gripper);  // its thread stays where it began
    sched_setaffinity(0, sizeof before, &each.back());
    const double start = monotonic_now();
    // each some tenths of a microsecond long, as long as the watch examines it; on a busy machine the watch may come for the first
    // time long after a second
    for (double moment = start; moment < start + (gripper.meanwhiles > 0 ? 1 : 60); moment = monotonic_now()) {
      watch.enter(moment - 1000);
      for (int k = 0; k < 4; ++k) monotonic_now();
      reports += watch.leave();
      watch.enter(moment + 1000);
      for (int k = 0; k < 4; ++k) monotonic_now();
      watch.leave();
    }
  }
  sched_setaffinity(0, sizeof before, &before);
  EXPECT_GT(gripper.meanwhiles, 0);
  EXPECT_GE(reports, gripper.meanwhiles);
}

}  // namespace
}  // namespace wholehand::device
