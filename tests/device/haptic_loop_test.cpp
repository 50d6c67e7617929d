// SPDX-License-Identifier: MIT
// The loop around a session: every fault injected into it, the force that is written then, its clock, and what it does to the energy of a
// device that is pressed against a wall.
// sanitizers: address thread
#include "device/haptic_loop.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "core/loop.h"
#include "device/monotonic.h"
#include "device/replay_gripper.h"
#include "tests/support/scenes.h"
#include "tests/support/special_values.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

const std::atomic<bool> NEVER{false};

bool same(const GripperForce& a, const GripperForce& b) { return a.arm == b.arm && a.grip == b.grip; }
bool is_zero(const GripperForce& force) { return same(force, {}); }

// A gripper that does what it is told: the state of a tick by a function, and faults where they are wanted.
class ScriptedGripper : public Gripper {
 public:
  ScriptedGripper() {
    limits_.name = "scripted";
    limits_.force = 12;
    limits_.grip = 8;
    limits_.gap = {0, 0.12};
    limits_.rate = 1000;
  }
  const GripperLimits& limits() const noexcept override { return limits_; }
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    ticks.push_back(tick);
    GripperState next = at(tick);
    next.sequence = static_cast<std::uint32_t>(++reads_);
    const ReadOutcome outcome = tamper ? tamper(tick, next) : ReadOutcome::value;
    if (outcome == ReadOutcome::value) state = next;
    return outcome;
  }
  bool write(const GripperForce& force) noexcept override {
    written.push_back(force);
    return !refuses || !refuses(force);
  }
  LetGo let_go() noexcept override { return write({}) ? LetGo::written : LetGo::not_taken; }
  const char* trouble() const noexcept override { return words; }
  LetGo let_go_meanwhile() noexcept override {
    ++meanwhiles;
    return LetGo::written;
  }
  void show(const Tick& tick) noexcept override { shown.push_back(tick.number); }
  std::int64_t dictated_tick() const noexcept override { return dictate ? dictate() : -1; }
  bool is_done() const noexcept override { return done && done(); }

  std::function<GripperState(std::int64_t)> at;
  std::function<ReadOutcome(std::int64_t, GripperState&)> tamper;
  std::function<bool(const GripperForce&)> refuses;
  std::function<std::int64_t()> dictate;
  std::function<bool()> done;
  const char* words = "";
  std::atomic<int> meanwhiles{0};
  std::vector<GripperForce> written;
  std::vector<std::int64_t> ticks, shown;

 private:
  GripperLimits limits_;
  int reads_ = 0;
};

// A finger presses on the beaker's side, both tips at one side of it: a force of some newtons is felt from the start of its ramp.
GripperState pressing(std::int64_t) {
  GripperState state;
  state.position = {0.03, 0.05, 0};
  state.gap = 0.12;
  return state;
}

GripperState approaching(std::int64_t tick) {
  GripperState state = pressing(tick);
  // from the right at 0.1 m/s, to where the thumb is 5 mm in
  state.position[0] = std::max(0.107, 0.115 - 1e-4 * static_cast<double>(tick));
  return state;
}

struct Rig {
  Scene scene = scene_of({beaker1()});
  ScriptedGripper gripper;
  LoopOptions options;
  TickSink sink;
  std::vector<Tick> sunk;

  Rig() {
    options.is_simulated = true;
    options.seconds = 2;
    gripper.at = approaching;
    sink = [this](const Tick& tick) {
      sunk.push_back(tick);
      return true;
    };
  }
  LoopReport go(const std::atomic<bool>& stop = NEVER) {
    Session session(scene, gripper.limits().gap);
    HapticLoop loop(scene.live, gripper, session, sink, options);
    loop.run(stop);
    return loop.report();
  }
};

// What every fault must end in: no force in the tick of the fault, nothing after it, the fault told with the state released; and force before,
// or the test would not see it go.
void expect_released(const Rig& run, const LoopReport& report, Fault fault, std::int64_t tick) {
  ASSERT_GE(run.gripper.written.size(), 2u);
  EXPECT_TRUE(is_zero(run.gripper.written.back()));
  EXPECT_FALSE(is_zero(run.gripper.written[run.gripper.written.size() - 2]));
  EXPECT_EQ(report.fault, fault);
  EXPECT_EQ(report.last.fault, fault);
  EXPECT_EQ(report.last.state, SessionState::released);
  EXPECT_EQ(report.last.number, tick);
  EXPECT_TRUE(is_zero(report.last.written));
  EXPECT_TRUE(is_zero(report.last.wanted));
  ASSERT_FALSE(run.sunk.empty());
  EXPECT_EQ(run.sunk.back().state, SessionState::released);
  EXPECT_EQ(run.sunk.back().fault, fault);
}

// ---- without a fault ----

TEST(HapticLoop, TicksUntilItsTimeIsOver) {
  Rig run;
  const LoopReport report = run.go();
  EXPECT_EQ(report.fault, Fault::none);
  EXPECT_EQ(report.ticks, 2000);
  EXPECT_EQ(run.gripper.ticks.size(), 2000u);
  EXPECT_EQ(run.gripper.shown.size(), 2000u);
  for (std::int64_t n = 0; n < 2000; ++n) {
    EXPECT_EQ(run.gripper.ticks[static_cast<std::size_t>(n)], n);
    EXPECT_EQ(run.sunk[static_cast<std::size_t>(n)].number, n);
    EXPECT_TRUE(same(run.sunk[static_cast<std::size_t>(n)].written, run.gripper.written[static_cast<std::size_t>(n)]));
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
  Rig run;
  run.gripper.done = [&] { return run.gripper.ticks.size() >= 700; };
  expect_released(run, run.go(), Fault::none, 700);
}

TEST(HapticLoop, FollowsDictatedTicks) {
  Rig run;
  std::vector<std::int64_t> recorded;
  for (std::int64_t n = 0; n < 900; ++n) recorded.push_back(n + n / 10);
  run.gripper.dictate = [&]() -> std::int64_t {
    const std::size_t next = run.gripper.ticks.size();
    return next < recorded.size() ? recorded[next] : -1;
  };
  run.gripper.done = [&] { return run.gripper.ticks.size() >= recorded.size(); };
  const LoopReport report = run.go();
  EXPECT_EQ(run.gripper.ticks, recorded);
  EXPECT_EQ(report.fault, Fault::none);
}

TEST(HapticLoop, GoesWithoutASink) {
  Rig run;
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
    Rig run;
    run.gripper.words = wrong.name;
    run.gripper.tamper = [&](std::int64_t tick, GripperState& state) {
      return tick == 800 ? wrong.tamper(state) : ReadOutcome::value;
    };
    const LoopReport report = run.go();
    expect_released(run, report, wrong.fault, 800);
    EXPECT_EQ(run.gripper.written.size(), 801u);  // in the very tick
    EXPECT_EQ(report.trouble, wrong.name);
    EXPECT_EQ(run.gripper.ticks.back(), 800);  // and no further read
  }
}

TEST(HapticLoop, LetsGoInTheFirstTickAsWell) {
  Rig run;
  run.gripper.tamper = [](std::int64_t, GripperState&) { return ReadOutcome::error; };
  const LoopReport report = run.go();
  EXPECT_EQ(report.fault, Fault::read_error);
  EXPECT_EQ(report.last.state, SessionState::released);
  ASSERT_EQ(run.gripper.written.size(), 1u);
  EXPECT_TRUE(is_zero(run.gripper.written[0]));
}

TEST(HapticLoop, LetsGoWhereTheForceIsNotTaken) {
  Rig run;
  run.gripper.refuses = [&](const GripperForce& force) { return run.gripper.ticks.back() == 800 && !is_zero(force); };
  expect_released(run, run.go(), Fault::write_error, 800);
  EXPECT_EQ(run.gripper.written.size(), 802u);
}

TEST(HapticLoop, LetsGoWhenTheRecordIsFull) {
  Rig run;
  run.sink = [&](const Tick& tick) {
    run.sunk.push_back(tick);
    return tick.number < 800;
  };
  expect_released(run, run.go(), Fault::ring_full, 800);
  EXPECT_EQ(run.gripper.written.size(), 802u);
}

TEST(HapticLoop, LetsGoWhenItIsStopped) {
  Rig run;
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
    Rig run;
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
    Rig run;
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

// A late step now and then is none too many.
TEST(HapticLoop, ForgivesALateStepAlone) {
  Rig run;
  run.options.is_simulated = false;
  run.options.seconds = 0.4;
  run.scene.live.rate = 250;
  run.scene.live.late_steps = 3;
  run.scene.live.jump = 1000;
  run.gripper.refuses = [&](const GripperForce&) {
    if (run.gripper.written.size() % 10 == 5) std::this_thread::sleep_for(std::chrono::milliseconds(6));
    return false;
  };
  const LoopReport report = run.go();
  EXPECT_EQ(report.fault, Fault::none);
  EXPECT_GE(report.late, 3);
}

// Every tick has the number of its period, whatever was missed; none comes before its time.
TEST(HapticLoop, KeepsTheTimeOfItsClock) {
  Rig run;
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

// The flag is set by one thread and seen by another, and ticks leave through the sink: what the thread sanitizer is to look at.
TEST(HapticLoop, StopsFromAnotherThread) {
  Rig run;
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

// ---- stalls ----

// A force from the first tick on, as large as it will be.
void press_at_once(Rig& run) {
  run.options.is_simulated = false;
  run.options.seconds = 20;
  run.scene.live.ramp = 0;
  run.scene.live.slew = 1e9;
  run.scene.live.late_steps = 1 << 30;
  run.scene.live.jump = 1000;
}

// The process stands still while it waits for a measurement, while it writes, and between two ticks: the next force is none. At every rate, since
// a stall is a time and no number of ticks.
TEST(HapticLoop, AfterAStallTheFirstForceIsZero) {
  for (const double rate : {250.0, 1000.0}) {
    for (const std::string place : {"read", "write", "sink"}) {
      SCOPED_TRACE(place + " " + std::to_string(rate));
      Rig run;
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
      // the numbers say so too, for a replay
      EXPECT_GE(static_cast<double>(run.sunk[after].number - run.sunk[after - 1].number) / rate, STALL);
    }
  }
}

// A measurement that was read before it belongs to the tick in which it is there.
TEST(HapticLoop, TheTickAfterAStallHasTheClocksNumber) {
  Rig run;
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
  EXPECT_EQ(report.ticks + report.missed, run.sunk[run.sunk.size() - 2].number + 1);
}

// What a session with stalls wrote, its replay writes.
TEST(HapticLoop, AReplayOfStallsWritesTheSame) {
  Rig run;
  press_at_once(run);
  run.scene.live.ramp = 0.02;
  int ticks = 0;
  run.gripper.tamper = [&](std::int64_t, GripperState&) {
    if (++ticks % 40 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(14 + ticks / 40));
    return ReadOutcome::value;
  };
  run.gripper.done = [&] { return ticks >= 200; };
  ASSERT_EQ(run.go().fault, Fault::none);
  Rig again;
  again.scene = run.scene;
  again.options.is_simulated = true;
  again.options.seconds = 0;
  Session session(again.scene, run.gripper.limits().gap);
  const auto replay = make_replay(run.sunk, run.gripper.limits());
  HapticLoop loop(again.scene.live, *replay, session, again.sink, again.options);
  loop.run(NEVER);
  ASSERT_EQ(again.sunk.size(), run.sunk.size());
  int zeros = 0;
  for (std::size_t k = 0; k + 1 < run.sunk.size(); ++k) {
    EXPECT_EQ(again.sunk[k].number, run.sunk[k].number);
    EXPECT_TRUE(same(again.sunk[k].written, run.sunk[k].written)) << k;
    zeros += k > 0 && is_zero(run.sunk[k].written) && !is_zero(run.sunk[k].wanted);
  }
  EXPECT_GE(zeros, 4);
}

// ---- calls that take long ----

// Reads are waits for the device, but not for longer than its patience: three in a row end the session, one alone does not.
TEST(HapticLoop, ReadsThatTakeLongAreLateSteps) {
  for (const int most : {1, 3}) {
    Rig run;
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
    Rig run;
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
    const auto news = watch.news();
    ASSERT_TRUE(news);
    EXPECT_EQ(*news, "a call of the device did not return within 12 ms; meanwhile zero force was written");
    EXPECT_FALSE(watch.news()) << "once";
  }
}

// A call that returns while the watch looks at it: its end is told of the zero, or there is none. The short call after it must not
// be told in its place.
TEST(HapticLoop, TheWatchActsOnNoCallThatHasReturned) {
  ScriptedGripper gripper;
  int told = 0;
  // each on a processor of its own, as far as there are two: else the one would stand still while the other looks
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
    // each some tenths of a microsecond long, as long as the watch looks at it; on a busy machine the watch may come for the first
    // time long after a second
    for (double moment = start; moment < start + (gripper.meanwhiles > 0 ? 1 : 60); moment = monotonic_now()) {
      watch.enter(moment - 1000);
      for (int k = 0; k < 4; ++k) monotonic_now();
      told += watch.leave();
      watch.enter(moment + 1000);
      for (int k = 0; k < 4; ++k) monotonic_now();
      watch.leave();
    }
  }
  sched_setaffinity(0, sizeof before, &before);
  EXPECT_GT(gripper.meanwhiles, 0);
  EXPECT_GE(told, gripper.meanwhiles);
}

// ---- what is said of the force ----

TEST(HapticLoop, TellsWhatBecameOfTheForce) {
  for (const bool takes_nothing : {false, true}) {
    Rig run;
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
    EXPECT_EQ(report.trouble, "unplugged") << "the read's, whatever failed afterwards";
    EXPECT_EQ(report.let_go, takes_nothing ? LetGo::not_taken : LetGo::written);
    EXPECT_EQ(report.let_go_trouble, takes_nothing ? "it takes no force" : "");
    EXPECT_TRUE(same(report.force, run.gripper.written[799])) << "the last that was taken";
    const ForceSize noted = run.gripper.noted();
    EXPECT_EQ(noted.arm, takes_nothing ? std::abs(run.gripper.written[799].arm[0]) : 0);
  }
}

// ---- energy ----

// A gripper that is a mass with damping on one axis, integrated exactly between ticks: what the loop writes acts on it until the next tick.
class MassGripper : public Gripper {
 public:
  MassGripper(double rate, core_f64::Plant plant, Vec3 axis, Vec3 start, double speed, double press)
      : plant_(plant), by_(core_f64::propagator(plant, 1 / rate)), axis_(axis), start_(start), press_(press) {
    motion_.speed = speed;
    limits_.force = 1e3;
    limits_.grip = 1e3;
    limits_.gap = {0, 0.12};
  }
  const GripperLimits& limits() const noexcept override { return limits_; }
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    if (tick > 0) motion_ = core_f64::advance(by_, motion_, force_ + press_);
    motions.push_back(motion_);
    state.position = to_triple(start_ + motion_.place * axis_);
    state.gap = gap;
    state.sequence = static_cast<std::uint32_t>(tick + 1);
    return ReadOutcome::value;
  }
  bool write(const GripperForce& force) noexcept override {
    force_ = glm::dot(to_vec3(force.arm), axis_);
    forces.push_back(force_);
    return true;
  }
  std::vector<core_f64::Motion> motions;
  std::vector<double> forces;
  double gap = 0.12;

 private:
  core_f64::Plant plant_;
  core_f64::Propagator by_;
  Vec3 axis_, start_;
  double press_, force_ = 0;
  core_f64::Motion motion_;
  GripperLimits limits_;
};

struct Against {
  const char* name;
  Vec3 axis, start;  // of the middle of the tips
  double slope;      // how many tips push the arm
};

// The thumb alone meets the side; both tips meet the lid, one tip each side of its middle: twice K and B act on the arm.
std::vector<Against> walls() {
  return {{"side", Vec3(-1, 0, 0), Vec3(0.113, 0.05, 0), 1}, {"lid", Vec3(0, -1, 0), Vec3(0, 0.119, 0), 2}};
}

// Whatever the speed it is thrown at, it comes back slower, where b > slope (K T / 2 + |B|): the energy of motion never grows over what it was
// before the contact and what the press puts in.
TEST(Energy, NeverGrowsAgainstAPassiveWall) {
  for (const Against& against : walls()) {
    for (const double rate : {1000.0, 4000.0}) {
      for (const double stiffness : {300.0, 800.0}) {
        for (const double damping : {0.0, 0.3}) {
          const double b = 1.05 * against.slope * (stiffness / rate / 2 + damping);
          for (const double mass : {0.05, 0.2}) {
            for (const double speed : {0.05, 0.2, 0.5}) {
              for (const double press : {0.0, 1.0}) {
                SCOPED_TRACE(std::string(against.name) + " " + std::to_string(rate) + " " + std::to_string(stiffness) + " " +
                             std::to_string(damping) + " " + std::to_string(mass) + " " + std::to_string(speed) + " " +
                             std::to_string(press));
                Rig run;
                run.scene.live.rate = rate;
                run.scene.live.stiffness = stiffness;
                run.scene.live.damping = damping;
                run.scene.live.ramp = 0;
                run.scene.live.slew = 1e9;
                run.scene.live.jump = 1e3;
                run.options.seconds = 1;
                const core_f64::Plant plant{mass, b, 0};
                MassGripper gripper(rate, plant, against.axis, against.start, speed, press);
                if (against.slope == 2) gripper.gap = 0.03;
                Session session(run.scene, gripper.limits().gap);
                HapticLoop loop(run.scene.live, gripper, session, {}, run.options);
                loop.run(NEVER);
                // total energy with the press's potential: it may only fall but for what is stored in the wall, which is gone when it is
                // out of it, so each maximum of it in the air is lower than the one before
                double last = std::numeric_limits<double>::infinity(), strongest = 0;
                for (std::size_t k = 0; k < gripper.motions.size(); ++k) {
                  strongest = std::max(strongest, std::abs(gripper.forces[k]));
                  if (gripper.forces[k] != 0) continue;
                  const core_f64::Motion& m = gripper.motions[k];
                  const double energy = 0.5 * mass * m.speed * m.speed - press * m.place;
                  ASSERT_LE(energy, last + 1e-12) << k;
                  last = energy;
                }
                // it begins a millimetre or two away, and gets m v / b far
                if (press > 0 || mass * speed / b > 4e-3) {
                  EXPECT_GT(strongest, 0);
                }
                const double left =
                    b + against.slope * (damping - stiffness / rate / 2);  // of all damping, beside what sampling costs
                if (press > 0 && left / (2 * mass) > 8) {
                  // and where a second is enough for that it comes to rest on it, held by what presses
                  EXPECT_NEAR(gripper.forces[gripper.forces.size() - 2], -press, 0.02);
                  EXPECT_LT(std::abs(gripper.motions.back().speed), 2e-3);
                }
              }
            }
          }
        }
      }
    }
  }
}

// The same watch sees a wall that is none: too stiff for its rate, the device gains energy.
TEST(Energy, GrowsAgainstAWallThatIsNotPassive) {
  Rig run;
  run.scene.live.stiffness = 2000;
  run.scene.live.damping = 0;
  run.scene.live.ramp = 0;
  run.scene.live.slew = 1e9;
  run.scene.live.jump = 1e3;
  run.options.seconds = 1;
  const core_f64::Plant plant{0.05, 0.1, 0};
  MassGripper gripper(1000, plant, Vec3(-1, 0, 0), Vec3(0.107, 0.05, 0), 0.05, 1);
  Session session(run.scene, gripper.limits().gap);
  HapticLoop loop(run.scene.live, gripper, session, {}, run.options);
  loop.run(NEVER);
  double largest = 0;
  for (std::size_t k = gripper.motions.size() / 2; k < gripper.motions.size(); ++k)
    largest = std::max(largest, std::abs(gripper.motions[k].speed));
  EXPECT_GT(largest, 0.1);
}

}  // namespace
}  // namespace wholehand
