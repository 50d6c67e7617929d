// SPDX-License-Identifier: MIT
// The whole way of a session through real libraries: hidapi and libusb on devices that umockdev plays, and Force Dimension's
// interface on its stand-in. What is felt, and what is left on the device when something goes wrong.
#include "app/commands/open_gripper.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <set>
#include <thread>

#include "base/text/error.h"
#include "device/grippers/omega_gripper.h"
#include "device/loop/haptic_loop.h"
#include "device/session/session.h"
#include "tests/support/carried_beaker.h"
#include "tests/support/mock_grippers.h"
#include "tests/support/stand_in_dhd.h"

namespace wholehand {
namespace {

constexpr double RATE = 250;  // Hz: umockdev answers within a millisecond or two

// A machine that is busy with other tests may let no report through within a read's patience. That is no fault of what is tested
// here.
class Patient final : public device::Gripper {
 public:
  explicit Patient(std::unique_ptr<device::Gripper> gripper) : gripper_(std::move(gripper)) {}
  const device::GripperLimits& limits() const noexcept override { return gripper_->limits(); }
  device::ReadOutcome read(device::GripperState& state, std::int64_t tick) noexcept override {
    device::ReadOutcome outcome = device::ReadOutcome::timeout;
    for (int k = 0; k < patience && outcome == device::ReadOutcome::timeout; ++k) outcome = gripper_->read(state, tick);
    return outcome;
  }
  bool write(const device::GripperForce& force) noexcept override {
    const bool is_taken = gripper_->write(force);
    // once: a next force may be zero and leave the count. After few writes, as a busy machine leaves out many
    if (is_holding && force.grip != 0 && ++written == 10 && at_work) at_work();
    return is_taken;
  }
  device::ReleaseResult release() noexcept override { return gripper_->release(); }
  const char* last_error() const noexcept override { return gripper_->last_error(); }

  int patience = 1000, written = 0;
  std::atomic<bool> is_holding = false;  // the session says so
  std::function<void()> at_work;         // what happens in mid-session, a force being on the gripper

 private:
  std::unique_ptr<device::Gripper> gripper_;
};

struct Carried {
  std::set<device::SessionState> states;
  device::LoopReport report;
  double most = 0;        // force at the fingers, N
  bool was_held = false;  // when it ended
};

// Without a clock, as the mock's goes by what it receives: a machine that stalls takes nothing from the way.
Carried carry(Patient& gripper, const Scene& scene) {
  device::Session session(scene, gripper.limits().gap);
  Carried carried;
  device::SessionState before = device::SessionState::free;
  device::LoopOptions options;
  options.seconds = CARRY_LASTS;
  options.is_simulated = true;
  device::HapticLoop loop(
      scene.live, gripper, session,
      [&](const device::Tick& tick) {
        carried.states.insert(tick.state);
        carried.most = std::max(carried.most, tick.written.grip);
        carried.was_held = device::is_held(before);
        before = tick.state;
        gripper.is_holding = device::is_held(tick.state);
        return true;
      },
      options);
  const std::atomic<bool> stop{false};
  loop.run(stop);
  carried.report = loop.report();
  return carried;
}

void expect_whole_session(const Carried& carried) {
  EXPECT_EQ(carried.report.fault, device::Fault::none) << carried.report.error;
  for (const device::SessionState state : {device::SessionState::free, device::SessionState::lift, device::SessionState::tilt,
                                           device::SessionState::slipped, device::SessionState::released})
    EXPECT_TRUE(carried.states.count(state)) << device::SESSION_STATE_NAMES[static_cast<std::size_t>(state)];
  EXPECT_GT(carried.most, 0.8) << "F_base at least";
  EXPECT_EQ(carried.report.last.grasps, 1);
}

MockSettings carrying() {
  MockSettings settings;
  settings.motion = carried_state;
  settings.step = 1 / RATE;
  return settings;
}

bool is_no_force(const device::protocol::OutputReport& report) {
  return report.arm == std::array<std::int32_t, 3>{} && report.grip == 0;
}

// What arrived last; a mock takes a moment to see it.
device::protocol::OutputReport last_output(const MockGripper& mock) {
  for (int k = 0; k < 6000 && !is_no_force(mock.outputs().back()); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return mock.outputs().back();
}

template <class Mock>
class OpenGripperSession : public testing::Test {};
using Mocks = testing::Types<HidMock, UsbMock>;
TYPED_TEST_SUITE(OpenGripperSession, Mocks);

TYPED_TEST(OpenGripperSession, ABeakerIsCarriedAndFelt) {
  MockBench bench;
  TypeParam mock(bench, carrying());
  const Scene scene = carried_scene(RATE);
  {
    Patient gripper(open_gripper(mock.address(), scene, 1, ""));
    expect_whole_session(carry(gripper, scene));
  }
  const auto outputs = mock.outputs();
  ASSERT_GT(outputs.size(), 100u);
  std::int32_t most = 0;
  for (const auto& output : outputs) most = std::max(most, output.grip);
  EXPECT_GT(most, 800000) << "F_base in micronewtons arrived";
  EXPECT_TRUE(is_no_force(outputs.back())) << "nothing is left";
  EXPECT_FALSE(mock.has_force());
  EXPECT_EQ(mock.rejected(), 0);
}

TYPED_TEST(OpenGripperSession, WhateverTheDeviceDoesWrongEndsInNoForce) {
  const std::vector<std::pair<Mischief, device::Fault>> wrongs{
      {Mischief::silent, device::Fault::timeout},         {Mischief::short_report, device::Fault::read_error},
      {Mischief::long_report, device::Fault::read_error}, {Mischief::wrong_version, device::Fault::read_error},
      {Mischief::same_sequence, device::Fault::stale},    {Mischief::no_rotation, device::Fault::read_error},
      {Mischief::wrong_id, device::Fault::read_error}};
  for (const auto& [mischief, fault] : wrongs) {
    MockBench bench;
    TypeParam mock(bench, carrying());
    const Scene scene = carried_scene(RATE);
    Patient gripper(open_gripper(mock.address(), scene, 1, ""));
    gripper.at_work = [&mock, &gripper, wrong = mischief] {
      mock.misbehave(wrong);
      if (wrong == Mischief::silent) gripper.patience = 1;
    };
    const Carried carried = carry(gripper, scene);
    EXPECT_EQ(carried.report.fault, fault) << static_cast<int>(mischief) << carried.report.error;
    EXPECT_EQ(carried.report.last.state, device::SessionState::released) << static_cast<int>(mischief);
    EXPECT_TRUE(carried.was_held) << "a force was on it";
    EXPECT_EQ(carried.report.last.written.grip, 0);
    EXPECT_TRUE(is_no_force(last_output(mock))) << static_cast<int>(mischief);
  }
}

TYPED_TEST(OpenGripperSession, GarbageIsAFaultWhateverItSays) {
  MockBench bench;
  TypeParam mock(bench, carrying());
  const Scene scene = carried_scene(RATE);
  Patient gripper(open_gripper(mock.address(), scene, 1, ""));
  gripper.at_work = [&mock] { mock.misbehave(Mischief::garbage); };
  const Carried carried = carry(gripper, scene);
  EXPECT_NE(carried.report.fault, device::Fault::none);
  EXPECT_TRUE(is_no_force(last_output(mock)));
}

TYPED_TEST(OpenGripperSession, UnpluggingEndsItAndSaysSo) {
  MockBench bench;
  TypeParam mock(bench, carrying());
  const Scene scene = carried_scene(RATE);
  Patient gripper(open_gripper(mock.address(), scene, 1, ""));
  gripper.at_work = [&mock] { mock.unplug(); };
  const Carried carried = carry(gripper, scene);
  EXPECT_TRUE(carried.report.fault == device::Fault::read_error || carried.report.fault == device::Fault::write_error);
  EXPECT_NE(carried.report.error.find("unplugged"), std::string::npos) << carried.report.error;
  EXPECT_EQ(carried.report.last.state, device::SessionState::released);
  EXPECT_EQ(carried.report.last.written.grip, 0);
}

// ---- a process that stalls ----

// In and out of the beaker's side, a second and a half of every two pressed into it.
device::GripperState pressing_state(double time) {
  const double phase = std::fmod(time, 2.0),
               in = std::clamp((phase - 0.3) / 0.05, 0.0, 1.0) - std::clamp((phase - 1.9) / 0.05, 0.0, 1.0);
  device::GripperState state;
  state.position = {0.121 - 0.010 * in, 0.055, 0};
  state.gap = 25e-3;
  return state;
}

// A session in a child, without an end.
pid_t start_pressing(const std::string& address) {
  const pid_t child = fork();
  if (child != 0) return child;
  Scene scene = carried_scene(RATE);
  scene.live.ramp = 0;
  scene.live.slew = 1e9;
  scene.live.jump = 1e6;
  scene.live.late_steps = 1 << 30;
  Patient gripper(open_gripper(address, scene, 1, ""));
  device::Session session(scene, gripper.limits().gap);
  device::HapticLoop loop(scene.live, gripper, session, {}, {});
  const std::atomic<bool> stop{false};
  loop.run(stop);
  std::fprintf(stderr, "the session ended: %s\n", loop.report().error.c_str());
  _exit(3);
}

// Until `holds` of the last output, for a minute.
template <class Holds>
bool await_output(const MockGripper& mock, std::size_t least, const Holds& holds) {
  for (int k = 0; k < 60000; ++k) {
    const auto outputs = mock.outputs();
    if (outputs.size() >= least && !outputs.empty() && holds(outputs.back())) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TYPED_TEST(OpenGripperSession, TheFirstForceAfterAStopIsZero) {
  MockBench bench;
  MockSettings settings;
  settings.motion = pressing_state;
  settings.step = 1 / RATE;  // and no watchdog trips while the child stalls
  TypeParam mock(bench, settings);
  const pid_t child = start_pressing(mock.address());
  std::deque<int> stops{50, 100, 300};  // ms; the mock needs its turn for what was under way
  int within = 0;                       // stops in a row that met a write
  for (int k = 0; !stops.empty() && k < 20; ++k) {
    const bool has_force = await_output(mock, 1, [](const auto& output) { return !is_no_force(output); });
    EXPECT_TRUE(has_force);
    if (!has_force) break;
    kill(child, SIGSTOP);
    int status = 0;
    waitpid(child, &status, WUNTRACED);
    std::this_thread::sleep_for(std::chrono::milliseconds(stops.front()));  // what is under way arrives meanwhile
    auto count = std::async(std::launch::async, [&] { return mock.outputs().size(); });
    // a mock that is in the midst of an exchange with the child keeps its lock until the child goes on: once more, before the watchdog trips
    const bool is_between = count.wait_for(std::chrono::milliseconds(100)) == std::future_status::ready;
    kill(child, SIGCONT);
    const std::size_t before = count.get();
    EXPECT_TRUE(await_output(mock, before + 1, [](const auto&) { return true; }));
    if (!is_between) continue;
    const auto outputs = mock.outputs();
    ASSERT_GT(outputs.size(), before);
    // a write within which the process was stopped still hands over its force (docs/method.md): not thrice in a row
    within = is_no_force(outputs[before]) ? 0 : within + 1;
    ASSERT_LT(within, 3) << "after " << stops.front() << " ms: " << outputs[before].arm[0];
    if (within == 0) stops.pop_front();
  }
  EXPECT_TRUE(stops.empty());
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

// A recording that does not keep up: the force of that tick may still be on its way, and none must follow it at once.
TYPED_TEST(OpenGripperSession, AFullRingLeavesNoForceWhileTheGripperIsStillOpen) {
  MockBench bench;
  TypeParam mock(bench, carrying());
  const Scene scene = carried_scene(RATE);
  Patient gripper(open_gripper(mock.address(), scene, 1, ""));
  device::Session session(scene, gripper.limits().gap);
  int held = 0;
  device::LoopOptions options;
  options.is_simulated = true;
  device::HapticLoop loop(
      scene.live, gripper, session, [&held](const device::Tick& tick) { return !(tick.written.grip > 1 && ++held > 20); }, options);
  const std::atomic<bool> stop{false};
  loop.run(stop);
  EXPECT_EQ(loop.report().fault, device::Fault::ring_full);
  EXPECT_FALSE(mock.has_force()) << "as soon as the loop has ended";
  EXPECT_TRUE(is_no_force(mock.outputs().back()));
}

TYPED_TEST(OpenGripperSession, ASecondSessionIsRefusedAndTheFirstGoesOn) {
  MockBench bench;
  TypeParam mock(bench, carrying());
  const Scene scene = carried_scene(RATE);
  Patient gripper(open_gripper(mock.address(), scene, 1, ""));
  int refused = 0;
  std::future<void> second;  // beside the first, whose watchdog does not wait for it
  gripper.at_work = [&] {
    second = std::async(std::launch::async, [&] {
      try {
        open_gripper(mock.address(), scene, 1, "");
      } catch (const Error& error) {
        refused += error.code == ExitCode::failure;
      }
    });
  };
  expect_whole_session(carry(gripper, scene));
  ASSERT_TRUE(second.valid());
  second.wait();
  EXPECT_EQ(refused, 1);
}

// ---- Force Dimension's interface ----

// The same way in the SDK's own axes, a pose a read.
void script(StandIn& dhd, double rate, bool is_left) {
  for (int k = 0; k < CARRY_LASTS * rate + 10; ++k) {
    const device::GripperState state = carried_state(k / rate);
    StandInPose pose;
    pose.position = device::to_dhd(state.position);
    pose.gap = state.gap;
    const double side = (is_left ? -1 : 1) * 0.5 * state.gap;
    pose.finger = pose.thumb = pose.position;
    pose.finger[1] += side;
    pose.thumb[1] -= side;
    // its columns are the gripper's axes, under the SDK's names of them
    for (int column = 0; column < 3; ++column) {
      Triple axis{};
      const Triple name = device::from_dhd({column == 0 ? 1.0 : 0.0, column == 1 ? 1.0 : 0.0, column == 2 ? 1.0 : 0.0});
      for (int row = 0; row < 3; ++row)
        for (int m = 0; m < 3; ++m) axis[row] += state.rotation[3 * row + m] * name[m];
      const Triple turned = device::to_dhd(axis);
      for (int row = 0; row < 3; ++row) pose.frame[row][column] = turned[row];
    }
    dhd->motion.push_back(pose);
  }
}

TEST(OmegaSession, ABeakerIsCarriedAndFeltWithEitherHand) {
  for (const bool is_left : {false, true}) {
    StandIn dhd(STAND_IN_DHD);
    dhd->types = {is_left ? 37 : 35};
    script(dhd, RATE, is_left);
    Scene scene = carried_scene(RATE);
    if (is_left) scene.hand.handedness = Handedness::left;
    {
      Patient gripper(open_gripper("omega", scene, 1, STAND_IN_DHD));
      expect_whole_session(carry(gripper, scene));
    }
    double most = 0, weight = 0;
    for (const auto& force : dhd->forces) {
      most = std::max(most, is_left ? -force[6] : force[6]);
      weight = std::min(weight, force[2]);
    }
    EXPECT_GT(most, 0.8) << "positive opens on right-hand devices, negative on left-hand ones";
    EXPECT_LT(weight, -0.5) << "of the empty beaker, along the SDK's own up";
    EXPECT_EQ(dhd->forces.back(), (std::array<double, 7>{}));
  }
}

TEST(OmegaSession, AReadErrorEndsInNoForceAndSaysTheSdksWords) {
  StandIn dhd(STAND_IN_DHD);
  script(dhd, RATE, false);
  const Scene scene = carried_scene(RATE);
  Patient gripper(open_gripper("omega", scene, 1, STAND_IN_DHD));
  gripper.at_work = [&dhd] {
    dhd->error = "communication error";
    dhd->codes["dhdGetPositionAndOrientationFrame"] = -1;
  };
  const Carried carried = carry(gripper, scene);
  EXPECT_EQ(carried.report.fault, device::Fault::read_error);
  EXPECT_NE(carried.report.error.find("communication error"), std::string::npos) << carried.report.error;
  EXPECT_EQ(dhd->forces.back(), (std::array<double, 7>{}));
}

}  // namespace
}  // namespace wholehand
