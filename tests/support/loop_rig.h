// SPDX-License-Identifier: MIT
// A haptic loop around a gripper that does what its test says, with all that was read and written.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <vector>

#include "base/system/clock.h"
#include "core/loop.h"
#include "device/loop/haptic_loop.h"
#include "tests/support/scenes.h"

namespace wholehand {

inline const std::atomic<bool> NEVER_STOPPED{false};

inline bool same_force(const device::GripperForce& a, const device::GripperForce& b) { return a.arm == b.arm && a.grip == b.grip; }
inline bool is_zero(const device::GripperForce& force) { return same_force(force, {}); }

// A scripted gripper: the state of a tick by a function, and faults where they are wanted.
class ScriptedGripper : public device::Gripper {
 public:
  ScriptedGripper() {
    limits_.name = "scripted";
    limits_.force = 12;
    limits_.grip = 8;
    limits_.gap = {0, 0.12};
    limits_.rate = 1000;
  }
  const device::GripperLimits& limits() const noexcept override { return limits_; }
  device::ReadOutcome read(device::GripperState& state, std::int64_t tick) noexcept override {
    ticks.push_back(tick);
    device::GripperState next = at(tick);
    next.sequence = static_cast<std::uint32_t>(++reads_);
    const device::ReadOutcome outcome = tamper ? tamper(tick, next) : device::ReadOutcome::value;
    if (outcome == device::ReadOutcome::value) state = next;
    return outcome;
  }
  bool write(const device::GripperForce& force) noexcept override {
    written.push_back(force);
    return !refuses || !refuses(force);
  }
  device::ReleaseResult release() noexcept override {
    return write({}) ? device::ReleaseResult::written : device::ReleaseResult::refused;
  }
  const char* last_error() const noexcept override { return words; }
  device::ReleaseResult release_from_watchdog() noexcept override {
    ++meanwhiles;
    return device::ReleaseResult::written;
  }
  void show(const device::Tick& tick) noexcept override { shown.push_back(tick.number); }
  std::int64_t replayed_tick() const noexcept override { return replay ? replay() : -1; }
  bool is_done() const noexcept override { return done && done(); }

  std::function<device::GripperState(std::int64_t)> at;
  std::function<device::ReadOutcome(std::int64_t, device::GripperState&)> tamper;
  std::function<bool(const device::GripperForce&)> refuses;
  std::function<std::int64_t()> replay;
  std::function<bool()> done;
  const char* words = "";
  std::atomic<int> meanwhiles{0};
  std::vector<device::GripperForce> written;
  std::vector<std::int64_t> ticks, shown;

 private:
  device::GripperLimits limits_;
  int reads_ = 0;
};

// A finger presses on the beaker's side, both tips at one side of it: a force of some newtons is felt from the start of its ramp.
inline device::GripperState pressing(std::int64_t) {
  device::GripperState state;
  state.position = {0.03, 0.05, 0};
  state.gap = 0.12;
  return state;
}

inline device::GripperState approaching(std::int64_t tick) {
  device::GripperState state = pressing(tick);
  // from the right at 0.1 m/s, to where the thumb is 5 mm in
  state.position[0] = std::max(0.107, 0.115 - 1e-4 * static_cast<double>(tick));
  return state;
}

struct LoopRig {
  Scene scene = scene_of({beaker1()});
  ScriptedGripper gripper;
  device::LoopOptions options;
  device::TickSink sink;
  std::vector<device::Tick> sunk;

  LoopRig() {
    options.is_simulated = true;
    options.seconds = 2;
    gripper.at = approaching;
    sink = [this](const device::Tick& tick) {
      sunk.push_back(tick);
      return true;
    };
  }
  device::LoopReport go(const std::atomic<bool>& stop = NEVER_STOPPED) {
    device::Session session(scene, gripper.limits().gap);
    device::HapticLoop loop(scene.live, gripper, session, sink, options);
    loop.run(stop);
    return loop.report();
  }
};

// What every fault must end in: no force in the tick of the fault, nothing after it, the fault reported with the state released; and
// force before, or the test would not see it go.
inline void expect_released(const LoopRig& run, const device::LoopReport& report, device::Fault fault, std::int64_t tick) {
  ASSERT_GE(run.gripper.written.size(), 2u);
  EXPECT_TRUE(is_zero(run.gripper.written.back()));
  EXPECT_FALSE(is_zero(run.gripper.written[run.gripper.written.size() - 2]));
  EXPECT_EQ(report.fault, fault);
  EXPECT_EQ(report.last.fault, fault);
  EXPECT_EQ(report.last.state, device::SessionState::released);
  EXPECT_EQ(report.last.number, tick);
  EXPECT_TRUE(is_zero(report.last.written));
  EXPECT_TRUE(is_zero(report.last.wanted));
  ASSERT_FALSE(run.sunk.empty());
  EXPECT_EQ(run.sunk.back().state, device::SessionState::released);
  EXPECT_EQ(run.sunk.back().fault, fault);
}

}  // namespace wholehand
