// SPDX-License-Identifier: MIT
// The page as a gripper: where controls put the hand, that the steps of a mouse pass the guard, and a whole session by posted
// controls.
// sanitizers: thread
#include "device/grippers/view_gripper.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <set>
#include <thread>
#include <vector>

#include "device/loop/guard.h"
#include "device/loop/haptic_loop.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

const std::atomic<bool> NO_STOP{false};

ViewControl control_at(Triple position, const Rotation& rotation, double gap, std::int64_t sequence) {
  return {position, rotation, gap, 0, sequence};
}

// Passes a gripper on and lets somebody post before each read.
class Posted final : public Gripper {
 public:
  Posted(std::unique_ptr<Gripper> gripper, std::function<void(std::int64_t)> before)
      : gripper_(std::move(gripper)), before_(std::move(before)) {}
  const GripperLimits& limits() const noexcept override { return gripper_->limits(); }
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    before_(tick);
    return gripper_->read(state, tick);
  }
  bool write(const GripperForce& force) noexcept override { return gripper_->write(force); }

 private:
  std::unique_ptr<Gripper> gripper_;
  std::function<void(std::int64_t)> before_;
};

std::vector<Tick> run(const Scene& scene, Gripper& gripper, double seconds, LoopReport* report = nullptr) {
  Session session(scene, gripper.limits().gap);
  std::vector<Tick> ticks;
  LoopOptions options;
  options.seconds = seconds;
  options.is_simulated = true;
  HapticLoop loop(
      scene.live, gripper, session,
      [&ticks](const Tick& tick) {
        ticks.push_back(tick);
        return true;
      },
      options);
  loop.run(NO_STOP);
  EXPECT_EQ(loop.report().fault, Fault::none) << FAULT_NAMES[static_cast<std::size_t>(loop.report().fault)] << loop.guard().jump();
  if (report) *report = loop.report();
  return ticks;
}

// A scene whose [device] turns, scales and shifts everything there is.
Scene odd_device(Scene scene) {
  scene.device.has_gap = true;
  scene.device.gap = {2e-3, 25e-3};
  scene.device.workspace_scale = 2.5;
  scene.device.origin = {0.1, -0.2, 0.3};
  scene.device.axes = {"-z", "y", "x"};
  return scene;
}

TEST(ViewGripper, RestsOpenInFrontOfAllVesselsUntilTheFirstControl) {
  for (const bool is_left : {false, true}) {
    Scene scene = live_scene();
    if (is_left) scene.hand = left_hand();
    ViewInput input(scene);
    const auto gripper = open_view(scene, input);
    const auto ticks = run(scene, *gripper, 0.5);
    const ViewControl& start = input.limits().start;
    ASSERT_EQ(ticks.size(), 501u);
    for (const Tick& tick : ticks) {
      if (tick.state == SessionState::released) break;
      ASSERT_EQ(tick.state, SessionState::free);
      ASSERT_LT(distance(tick.middle, start.position), 1e-12);
      ASSERT_NEAR(tick.gap, input.limits().gap[1], 1e-12);
    }
    EXPECT_LT(distance(start.position, input.limits().center), input.limits().reach);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const VesselData& vessel = scene.vessels[v];
      EXPECT_GT(start.position[2] - vessel.place[2] - largest_radius(vessel), VIEW_CLEARANCE - 1e-12) << vessel.name;
      EXPECT_LT(distance(vessel.place, input.limits().center) + VIEW_REACH - 0.2, input.limits().reach) << "in reach";
    }
  }
}

// The control is of the hand in the world; whatever [device] does to a gripper is undone.
TEST(ViewGripper, TheHandGoesWhereTheControlSaysWhateverTheDevice) {
  for (const bool is_left : {false, true}) {
    for (const bool is_odd : {false, true}) {
      Scene scene = is_odd ? odd_device(live_scene()) : live_scene();
      if (is_left) scene.hand = left_hand();
      ViewInput input(scene);
      const auto view = open_view(scene, input);
      const Triple place{-0.15, 0.21, 0.17};
      const Rotation rotation = product(turned('y', 0.4), turned('x', -0.9));
      Posted gripper(open_view(scene, input), [&](std::int64_t tick) {
        if (tick == 3) input.post(control_at(place, rotation, 0.06, 1));
      });
      const auto ticks = run(scene, gripper, 2);
      const Tick& last = ticks[ticks.size() - 2];
      // two seconds are 120 time constants; what is left is rounding, of lengths up to a meter times the scale
      EXPECT_LT(distance(last.middle, place), 1e-12) << is_left << is_odd;
      EXPECT_NEAR(last.gap, 0.06, 1e-12) << is_left << is_odd;
      for (int k = 0; k < 9; ++k) EXPECT_NEAR(last.hand_rotation[k], rotation[k], 1e-12) << is_left << is_odd << k;
      const Triple& index = last.tips[1];
      const double ahead = (is_left ? -1 : 1) * 0.03;
      EXPECT_LT(distance(index, {place[0] + ahead * rotation[0], place[1] + ahead * rotation[3], place[2] + ahead * rotation[6]}),
                1e-12)
          << "+x runs to the index finger of a right hand, to the thumb of a left one";
    }
  }
}

TEST(ViewGripper, WhatIsBeyondTheLimitsIsMovedToThem) {
  const Scene scene = live_scene();
  ViewInput input(scene);
  const ViewLimits& limits = input.limits();
  const auto state = [&input](const Triple& position, double gap) {
    static std::int64_t sequence = 0;
    GripperState taken;
    EXPECT_TRUE(input.post(control_at(position, NO_ROTATION, gap, ++sequence)));
    EXPECT_TRUE(input.take(taken));
    return taken;
  };
  EXPECT_EQ(state(limits.center, -5).gap, limits.gap[0]);
  EXPECT_EQ(state(limits.center, 1e9).gap, limits.gap[1]);
  for (const Triple& far : {Triple{100, 0, 0}, Triple{-3, 700, 2}, Triple{1e3, 1e3, -1e3}}) {
    const Triple place = state(far, 0.1).position;
    EXPECT_NEAR(distance(place, limits.center), limits.reach, 1e-12);
    const double share = (place[0] - limits.center[0]) / (far[0] - limits.center[0]);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(place[k] - limits.center[k], share * (far[k] - limits.center[k]), 1e-9) << "straight back";
  }
  EXPECT_EQ(state({0.1, 0.1, 0.1}, 0.1).position, (Triple{0.1, 0.1, 0.1}));
}

TEST(ViewGripper, AControlThatWasOvertakenIsLeftOut) {
  const Scene scene = live_scene();
  ViewInput input(scene);
  GripperState state;
  const auto post = [&input](std::int64_t sequence, double x) {
    return input.post(control_at({x, 0.1, 0}, NO_ROTATION, 0.1, sequence));
  };
  EXPECT_FALSE(input.take(state));
  EXPECT_TRUE(post(1'700'000'000'000, 0.01));
  EXPECT_TRUE(post(1'700'000'000'016, 0.02));
  EXPECT_FALSE(post(1'700'000'000'008, 0.03)) << "it was sent before";
  EXPECT_FALSE(post(1'700'000'000'016, 0.03)) << "the same again";
  ASSERT_TRUE(input.take(state));
  EXPECT_EQ(state.position[0], 0.02);
  EXPECT_FALSE(input.take(state));
  EXPECT_TRUE(post(1, 0.04)) << "another clock";
  EXPECT_TRUE(post(2, 0.05));
  EXPECT_FALSE(post(1, 0.06));
  ASSERT_TRUE(input.take(state));
  EXPECT_EQ(state.position[0], 0.05);
}

TEST(ViewGripper, EveryReadHasAValueOfItsOwn) {
  const Scene scene = live_scene();
  ViewInput input(scene);
  const auto gripper = open_view(scene, input);
  GripperState before, state;
  for (const std::int64_t tick : {0, 1, 2, 3, 40, 41, 5000}) {
    before = state;
    ASSERT_EQ(gripper->read(state, tick), ReadOutcome::value);
    EXPECT_EQ(state.sequence, before.sequence + 1) << "never stale, though nobody posts";
    EXPECT_EQ(state.time, static_cast<double>(tick) / scene.live.rate);
    EXPECT_TRUE(gripper->write({{1, 2, 3}, 4}));
    EXPECT_FALSE(gripper->is_done());
  }
  input.post({{0, 0.1, 0}, NO_ROTATION, 0.1, 5, 1});
  gripper->read(state, 5001);
  EXPECT_EQ(state.buttons, 5u) << "at once";
  EXPECT_EQ(gripper->limits().address, "view");
  EXPECT_EQ(gripper->limits().force, 12);
  EXPECT_EQ(gripper->limits().grip, 8);
  EXPECT_EQ(gripper->limits().gap, own_gap(scene.hand));
}

// Whatever a mouse does sixty times a second, and whatever the scene calls a jump, at every rate and with ticks that are missed.
TEST(ViewGripper, NoControlIsAJump) {
  for (const double rate : {250.0, 1000.0, 8000.0}) {
    for (const double jump : {0.01, 5.0, 1000.0}) {
      Scene scene = odd_device(live_scene());
      scene.live.rate = rate;
      scene.live.jump = jump;
      ViewInput input(scene);
      const auto gripper = open_view(scene, input);
      Guard guard(scene.live, gripper->limits());
      Random random(static_cast<std::uint64_t>(rate + jump));
      std::int64_t tick = 0, sequence = 0;
      double next = 0, furthest = 0;
      GripperState state, first;
      for (int k = 0; k < 20000; ++k) {
        if (static_cast<double>(tick) / rate >= next) {
          next += 1.0 / 60;
          const Rotation turn = product(turned('y', random.uniform(-3.1, 3.1)), turned('x', random.uniform(-3.1, 3.1)));
          const Triple place{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
          ASSERT_TRUE(input.post(control_at(place, turn, random.uniform(-0.1, 0.3), ++sequence)));
        }
        ASSERT_EQ(gripper->read(state, tick), ReadOutcome::value);
        ASSERT_EQ(guard.check(ReadOutcome::value, state, tick), Fault::none) << rate << " " << jump << " " << guard.jump();
        if (k == 0) first = state;
        furthest = std::max(furthest, distance(state.position, first.position));
        tick += k % 100 == 99 ? 30 : 1;
      }
      EXPECT_GT(furthest, 0.1 * std::min(0.1, jump / 2 * static_cast<double>(tick) / rate)) << "it moved";
    }
  }
}

// The user's way of the session's own tests, as a page would post it: the newest place sixty times a second.
TEST(ViewGripper, PostedControlsGraspLiftTiltAndPour) {
  for (const bool is_odd : {false, true}) {
    Scene scene = live_scene();
    LiveScript script;
    script.vessel = scene.vessels[0].place;
    if (is_odd) scene = odd_device(scene);
    if (is_odd) scene.live.slip = 2e-3;
    ViewInput input(scene);
    constexpr double COMES = 1;  // s for the way from the start to the script's own
    double next = 0;
    std::int64_t sequence = 0;
    Posted gripper(open_view(scene, input), [&](std::int64_t tick) {
      const double time = static_cast<double>(tick) / scene.live.rate;
      if (time < next) return;
      next += 1.0 / 60;
      const GripperState state = script.at(static_cast<std::int64_t>(std::max(0.0, time - COMES) * script.rate));
      input.post(control_at(state.position, state.rotation, state.gap, ++sequence));
    });
    LoopReport report;
    const auto ticks = run(scene, gripper, COMES + script.seconds() + 1, &report);
    std::set<SessionState> states;
    double most = 0, tilt = 0;
    for (const Tick& tick : ticks) {
      states.insert(tick.state);
      most = std::max(most, tick.written.grip);
      tilt = std::max(tilt, tick.tilt);
    }
    for (int s = 0; s < SESSION_STATES; ++s)  // the vessel is let go in the air, and so slips
      EXPECT_EQ(states.count(static_cast<SessionState>(s)) > 0, static_cast<SessionState>(s) != SessionState::let_go)
          << SESSION_STATE_NAMES[s];
    EXPECT_EQ(report.last.grasps, 1);
    EXPECT_GT(most, 0.8) << "F_base at least is shown";
    EXPECT_NEAR(tilt, script.tilt, radians(0.5)) << "it rests there for 48 time constants";
    EXPECT_GT(report.last.arrived[0], 100e-6) << "poured into the target";
    EXPECT_LT(report.last.volume[0], report.last.arrived[0]);
  }
}

// Between two ticks no force jumps because a mouse does: the motion between posts is that of a hand.
TEST(ViewGripper, MovesWithoutSteps) {
  const Scene scene = live_scene();
  ViewInput input(scene);
  std::int64_t sequence = 0;
  // 0.3 m/s along x in steps of 5 mm
  Posted gripper(open_view(scene, input), [&](std::int64_t tick) {
    if (tick % 17 != 0) return;
    const Triple& start = input.limits().start.position;
    input.post(control_at({start[0] - 0.1 + 0.3e-3 * static_cast<double>(tick), start[1], start[2]}, NO_ROTATION, 0.1, ++sequence));
  });
  const auto ticks = run(scene, gripper, 0.9);
  double least = 1, most = 0;
  for (std::size_t k = 400; k + 2 < ticks.size(); ++k) {
    const double speed = (ticks[k + 1].middle[0] - ticks[k].middle[0]) * scene.live.rate;
    least = std::min(least, speed);
    most = std::max(most, speed);
  }
  // each harmonic k of the steps is twice the speed, of which 1 / (1 + 38 k^2) is left: in all less than 2 / 38 pi^2 / 6 = 0.087
  EXPECT_GT(least, 0.3 * (1 - 0.087));
  EXPECT_LT(most, 0.3 * (1 + 0.087));
}

// Posts from several threads, as a server has them, at full speed under a loop on the clock.
TEST(ViewGripper, ManyThreadsMayPostWhileTheLoopRuns) {
  Scene scene = live_scene();
  scene.live.rate = 500;
  scene.live.late_steps = 1000;  // a machine that is busy
  ViewInput input(scene);
  const auto gripper = open_view(scene, input);
  Session session(scene, gripper->limits().gap);
  LoopOptions options;
  options.seconds = 0.6;
  std::int64_t ticks = 0;
  HapticLoop loop(
      scene.live, *gripper, session, [&ticks](const Tick&) { return ++ticks; }, options);
  std::atomic<bool> is_over{false};
  std::atomic<std::int64_t> sequence{0};
  std::vector<std::thread> posting;
  for (int k = 0; k < 3; ++k) {
    posting.emplace_back([&, k] {
      Random random(static_cast<std::uint64_t>(k));
      while (!is_over) {
        const Triple place{random.uniform(-0.5, 0.5), random.uniform(0, 0.4), random.uniform(-0.5, 0.5)};
        input.post(control_at(place, turned('x', random.uniform(-1, 1)), random.uniform(0, 0.1), ++sequence));
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    });
  }
  loop.run(NO_STOP);
  is_over = true;
  for (std::thread& thread : posting) thread.join();
  EXPECT_EQ(loop.report().fault, Fault::none) << FAULT_NAMES[static_cast<std::size_t>(loop.report().fault)];
  EXPECT_GT(ticks, 10);
  EXPECT_GT(sequence, 100);
}

}  // namespace
}  // namespace wholehand::device
