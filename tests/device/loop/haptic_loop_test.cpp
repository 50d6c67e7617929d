// SPDX-License-Identifier: MIT
// The loop around a session: every fault injected into it, the force that is written then, and its clock.
// sanitizers: thread
#include "device/loop/haptic_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

#include "core/loop.h"
#include "tests/support/loop_rig.h"
#include "tests/support/special_values.h"

namespace wholehand::device {
namespace {

// ---- without a fault ----

TEST(HapticLoop, TicksUntilItsTimeIsOver) {
  LoopRig run;
  const LoopReport report = run.go();
  EXPECT_EQ(report.fault, Fault::none);
  EXPECT_EQ(report.ticks, 2000);
  EXPECT_EQ(run.gripper.ticks.size(), 2000u);
  EXPECT_EQ(run.gripper.shown.size(), 2000u);
  for (std::int64_t n = 0; n < 2000; ++n) {
    EXPECT_EQ(run.gripper.ticks[static_cast<std::size_t>(n)], n);
    EXPECT_EQ(run.sunk[static_cast<std::size_t>(n)].number, n);
    EXPECT_TRUE(same_force(run.sunk[static_cast<std::size_t>(n)].written, run.gripper.written[static_cast<std::size_t>(n)]));
  }
  expect_released(run, report, Fault::none, 2000);
  // the ramp, and then what the session wants
  EXPECT_LT(std::abs(run.sunk[1999].written.arm[0] - run.sunk[1999].wanted.arm[0]), 1e-12);
  EXPECT_GT(std::abs(run.sunk[1999].wanted.arm[0]), 1);
  EXPECT_TRUE(is_zero(run.sunk[0].written));
  for (int n = 0; n < 500; ++n)
    EXPECT_LE(std::abs(run.sunk[static_cast<std::size_t>(n)].written.arm[0]), n * 1e-3 / 0.5 * 12 + 1e-12);
}

TEST(HapticLoop, EndsWhenTheGripperIsDone) {
  LoopRig run;
  run.gripper.done = [&] { return run.gripper.ticks.size() >= 700; };
  expect_released(run, run.go(), Fault::none, 700);
}

TEST(HapticLoop, FollowsDictatedTicks) {
  LoopRig run;
  std::vector<std::int64_t> recorded;
  for (std::int64_t n = 0; n < 900; ++n) recorded.push_back(n + n / 10);
  run.gripper.replay = [&]() -> std::int64_t {
    const std::size_t next = run.gripper.ticks.size();
    return next < recorded.size() ? recorded[next] : -1;
  };
  run.gripper.done = [&] { return run.gripper.ticks.size() >= recorded.size(); };
  const LoopReport report = run.go();
  EXPECT_EQ(run.gripper.ticks, recorded);
  EXPECT_EQ(report.fault, Fault::none);
}

TEST(HapticLoop, GoesWithoutASink) {
  LoopRig run;
  run.sink = {};
  EXPECT_EQ(run.go().ticks, 2000);
}

// ---- faults ----

TEST(HapticLoop, LetsGoOnWhateverIsReadWrongly) {
  struct Wrong {
    const char* name;
    Fault fault;
    std::function<ReadOutcome(GripperState&)> tamper;
  };
  const auto number = [](std::function<void(GripperState&)> change) {
    return [change](GripperState& state) {
      change(state);
      return ReadOutcome::value;
    };
  };
  const std::vector<Wrong> wrongs{
      {"error", Fault::read_error, [](GripperState&) { return ReadOutcome::error; }},
      {"unplugged", Fault::read_error, [](GripperState&) { return ReadOutcome::error; }},
      {"timeout", Fault::timeout, [](GripperState&) { return ReadOutcome::timeout; }},
      {"stale", Fault::stale, number([](GripperState& s) { --s.sequence; })},
      {"position", Fault::not_finite, number([](GripperState& s) { s.position[1] = NOT_A_NUMBER; })},
      {"gap", Fault::not_finite, number([](GripperState& s) { s.gap = std::numeric_limits<double>::infinity(); })},
      {"rotation", Fault::not_finite, number([](GripperState& s) { s.rotation[4] = NOT_A_NUMBER; })},
      {"no rotation", Fault::not_finite, number([](GripperState& s) { s.rotation = {}; })},
      {"jump", Fault::jump, number([](GripperState& s) { s.position[2] += 5.01e-3; })},
      {"gap's jump", Fault::jump, number([](GripperState& s) { s.gap -= 5.01e-3; })},
      {"turned round", Fault::jump, number([](GripperState& s) { s.rotation = {-1, 0, 0, 0, 1, 0, 0, 0, -1}; })},
  };
  for (const Wrong& wrong : wrongs) {
    SCOPED_TRACE(wrong.name);
    LoopRig run;
    run.gripper.words = wrong.name;
    run.gripper.tamper = [&](std::int64_t tick, GripperState& state) {
      return tick == 800 ? wrong.tamper(state) : ReadOutcome::value;
    };
    const LoopReport report = run.go();
    expect_released(run, report, wrong.fault, 800);
    EXPECT_EQ(run.gripper.written.size(), 801u);  // in the very tick
    EXPECT_EQ(report.error, wrong.name);
    EXPECT_EQ(run.gripper.ticks.back(), 800);  // and no further read
  }
}

TEST(HapticLoop, LetsGoInTheFirstTickAsWell) {
  LoopRig run;
  run.gripper.tamper = [](std::int64_t, GripperState&) { return ReadOutcome::error; };
  const LoopReport report = run.go();
  EXPECT_EQ(report.fault, Fault::read_error);
  EXPECT_EQ(report.last.state, SessionState::released);
  ASSERT_EQ(run.gripper.written.size(), 1u);
  EXPECT_TRUE(is_zero(run.gripper.written[0]));
}

TEST(HapticLoop, LetsGoWhereTheForceIsNotTaken) {
  LoopRig run;
  run.gripper.refuses = [&](const GripperForce& force) { return run.gripper.ticks.back() == 800 && !is_zero(force); };
  expect_released(run, run.go(), Fault::write_error, 800);
  EXPECT_EQ(run.gripper.written.size(), 802u);
}

TEST(HapticLoop, LetsGoWhenTheRecordIsFull) {
  LoopRig run;
  run.sink = [&](const Tick& tick) {
    run.sunk.push_back(tick);
    return tick.number < 800;
  };
  expect_released(run, run.go(), Fault::ring_full, 800);
  EXPECT_EQ(run.gripper.written.size(), 802u);
}

TEST(HapticLoop, LetsGoWhenItIsStopped) {
  LoopRig run;
  std::atomic<bool> stop{false};
  run.gripper.tamper = [&](std::int64_t tick, GripperState&) {
    if (tick == 799) stop = true;
    return ReadOutcome::value;
  };
  expect_released(run, run.go(stop), Fault::interrupted, 800);
}

// The flag as a signal handler sets it, on the clock: no force within two periods of it.
std::atomic<bool> signalled{false};
TEST(HapticLoop, LetsGoOnASignal) {
  for (const int signal : {SIGINT, SIGTERM}) {
    signalled = false;
    struct sigaction action {
    }, before{};
    action.sa_handler = [](int) { signalled = true; };
    sigaction(signal, &action, &before);
    LoopRig run;
    run.options.is_simulated = false;
    run.options.seconds = 20;
    run.scene.live.late_steps = 1 << 30;  // a loaded machine is not what is tested here
    run.scene.live.jump = 1000;
    run.gripper.tamper = [&](std::int64_t tick, GripperState&) {
      if (tick >= 200 && !signalled) raise(signal);
      return ReadOutcome::value;
    };
    const LoopReport report = run.go(signalled);
    sigaction(signal, &before, nullptr);
    EXPECT_EQ(report.fault, Fault::interrupted);
    EXPECT_EQ(report.last.state, SessionState::released);
    EXPECT_TRUE(is_zero(run.gripper.written.back()));
    EXPECT_FALSE(std::all_of(run.gripper.written.begin(), run.gripper.written.end(), is_zero));
    // until the release there is a force, but for the first after a stall of a loaded machine
    const std::int64_t last = run.gripper.ticks.back(), before_last = run.gripper.ticks[run.gripper.ticks.size() - 2];
    if (1e-3 * static_cast<double>(std::max(last - before_last, report.last.number - last)) < STALL) {
      EXPECT_FALSE(is_zero(run.gripper.written[run.gripper.written.size() - 2]));
    }
    EXPECT_EQ(run.gripper.written.size(), run.gripper.ticks.size() + 1);  // the tick of the signal, and the release
  }
}

// ---- the clock ----

// Steps that take longer than a period, so many in a row: the next tick lets go.
TEST(HapticLoop, LetsGoWhenStepsAreLate) {
  for (const int most : {1, 3}) {
    LoopRig run;
    run.options.is_simulated = false;
    run.options.seconds = 20;
    run.scene.live.rate = 250;
    run.scene.live.ramp = 0;
    run.scene.live.late_steps = most;
    run.gripper.at = [](std::int64_t) {
      GripperState state = pressing(0);
      state.position[0] = 0.107;
      return state;
    };
    int slow = 0;
    run.gripper.refuses = [&](const GripperForce&) {
      if (run.gripper.written.size() > 20 && slow < most) {
        ++slow;
        std::this_thread::sleep_for(std::chrono::milliseconds(6));  // of 4
      }
      return false;
    };
    const LoopReport report = run.go();
    EXPECT_EQ(report.fault, Fault::late);
    EXPECT_EQ(report.last.state, SessionState::released);
    EXPECT_TRUE(is_zero(run.gripper.written.back()));
    EXPECT_LE(slow, most) << "the machine itself may be late, too";
    EXPECT_GE(report.late, most);
    if (most > 1) {
      EXPECT_GT(report.missed, 0);
    }
    // in the tick after the last that was late
    EXPECT_EQ(run.gripper.written.size(), run.gripper.ticks.size());
  }
}

// A late step now and then is none too many. At a rate at which a busy machine makes no three in a row late.
TEST(HapticLoop, ForgivesALateStepAlone) {
  LoopRig run;
  run.options.is_simulated = false;
  run.options.seconds = 60;
  run.scene.live.rate = 20;
  run.scene.live.late_steps = 3;
  run.scene.live.jump = 1000;
  run.gripper.refuses = [&](const GripperForce&) {
    if (run.gripper.written.size() % 5 == 3) std::this_thread::sleep_for(std::chrono::milliseconds(60));
    return false;
  };
  run.gripper.done = [&] { return run.gripper.written.size() >= 20; };
  const LoopReport report = run.go();
  EXPECT_EQ(report.fault, Fault::none);
  EXPECT_GE(report.late, 3);
}

// Every tick has the number of its period, whatever was missed; none comes before its time.
TEST(HapticLoop, KeepsTheTimeOfItsClock) {
  LoopRig run;
  run.options.is_simulated = false;
  run.options.seconds = 0.3;
  run.scene.live.late_steps = 1 << 30;
  run.scene.live.jump = 1000;
  std::vector<double> moments;
  const auto start = std::chrono::steady_clock::now();
  run.gripper.tamper = [&](std::int64_t, GripperState&) {
    moments.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return ReadOutcome::value;
  };
  const LoopReport report = run.go();
  EXPECT_EQ(report.fault, Fault::none);
  EXPECT_EQ(report.ticks + report.missed, 300) << "every tick of 0.3 s, whichever of them were missed";
  EXPECT_LT(run.gripper.ticks.back(), 300);
  for (std::size_t k = 1; k < moments.size(); ++k) {
    EXPECT_GT(run.gripper.ticks[k], run.gripper.ticks[k - 1]);
    // from before the loop's start: tick n is due n + 1 periods after it
    EXPECT_GE(moments[k], 1e-3 * static_cast<double>(run.gripper.ticks[k] + 1) - 1e-6);
  }
  EXPECT_EQ(report.latency.count(), static_cast<std::uint64_t>(report.ticks));
  EXPECT_EQ(report.step.count(), static_cast<std::uint64_t>(report.ticks));
  EXPECT_EQ(report.period.count(), static_cast<std::uint64_t>(report.ticks - 1));
  EXPECT_GT(report.step.largest(), 0);
  EXPECT_GE(run.sunk[10].latency, 0);
  EXPECT_GT(run.sunk[10].step_time, 0);
}

// The flag is set by one thread and seen by another, and ticks leave through the sink: a case for the thread sanitizer.
TEST(HapticLoop, StopsFromAnotherThread) {
  LoopRig run;
  run.options.is_simulated = false;
  run.options.seconds = 20;
  run.scene.live.late_steps = 1 << 30;
  run.scene.live.jump = 1000;
  std::atomic<bool> stop{false};
  std::atomic<std::int64_t> seen{0};
  run.sink = [&](const Tick& tick) {
    seen = tick.number;
    return true;
  };
  LoopReport report;
  std::thread haptic([&] { report = run.go(stop); });
  while (seen < 50) std::this_thread::yield();
  stop = true;
  haptic.join();
  EXPECT_EQ(report.fault, Fault::interrupted);
}

// ---- messages about the force ----

TEST(HapticLoop, TellsWhatBecameOfTheForce) {
  for (const bool takes_nothing : {false, true}) {
    LoopRig run;
    run.gripper.tamper = [&](std::int64_t tick, GripperState&) {
      if (tick < 800) return ReadOutcome::value;
      run.gripper.words = "unplugged";
      return ReadOutcome::error;
    };
    run.gripper.refuses = [&](const GripperForce&) {
      if (run.gripper.ticks.back() < 800 || !takes_nothing) return false;
      run.gripper.words = "it takes no force";
      return true;
    };
    const LoopReport report = run.go();
    EXPECT_EQ(report.fault, Fault::read_error);
    EXPECT_EQ(report.error, "unplugged") << "the read's, whatever failed afterwards";
    EXPECT_EQ(report.release, takes_nothing ? ReleaseResult::refused : ReleaseResult::written);
    EXPECT_EQ(report.release_error, takes_nothing ? "it takes no force" : "");
    EXPECT_TRUE(same_force(report.force, run.gripper.written[799])) << "the last that was taken";
    const ForceSize last = run.gripper.last_written_force();
    EXPECT_EQ(last.arm, takes_nothing ? std::abs(run.gripper.written[799].arm[0]) : 0);
  }
}

}  // namespace
}  // namespace wholehand::device
