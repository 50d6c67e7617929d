// SPDX-License-Identifier: MIT
// Haply's devices on a stand-in for their service: the right forces on the right tips, the fate of all wrong messages, and that no force is left on
// any way out. The ticks are counted by the tests; only the messages are real.
// sanitizers: thread
#include "device/grippers/haply_gripper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/prepare.h"
#include "core/vectors.h"
#include "device/loop/haptic_loop.h"
#include "tests/support/haply_rig.h"

namespace wholehand::device {
namespace {

using stand_in::HaplyFault;
using stand_in::HaplyMotion;
using stand_in::HaplyOptions;

HaplyOptions with_grip() {
  HaplyOptions options;
  options.sides = {"right"};
  options.has_grip = true;
  return options;
}

TEST(HaplyGripper, TwoDevicesAreTheTipsOfThumbAndIndexFinger) {
  HaplyRig rig;
  const GripperLimits& limits = rig.gripper->limits();
  EXPECT_EQ(limits.name, "two Inverse3");
  EXPECT_EQ(limits.address, rig.place() + "/0A01,0A02");
  EXPECT_LE(limits.force / 2 + limits.grip, INVERSE3_FORCE) << "then no tip gets more than its device bears";
  EXPECT_EQ(limits.gap[0], 0);
  EXPECT_NEAR(limits.gap[1], own_gap(rig.scene.hand)[1] - own_gap(rig.scene.hand)[0], 1e-15);
  EXPECT_EQ(limits.watchdog, UNKNOWN_WATCHDOG);
  ASSERT_EQ(rig.said.size(), 2u);
  EXPECT_NE(rig.said[0].find("touch the tips together"), std::string::npos) << rig.said[0];
  ASSERT_TRUE(rig.reads_until([] { return true; }));
  EXPECT_NEAR(rig.state.gap, 0, 1e-12) << "they touch where they were calibrated";
  EXPECT_EQ(rig.state.position, (Triple{0, 0, 0}));
  EXPECT_EQ(rig.state.rotation, NO_ROTATION);
  // 60 mm apart in height and to the right, moved forward by 20 mm
  rig.service.rest_at(haply_moved({-0.024, 0.02, 0.018}, {0.024, 0.02, -0.018}));
  ASSERT_TRUE(rig.reads_until([&] { return std::abs(rig.state.gap - 0.06) < 1e-12; })) << rig.state.gap;
  EXPECT_NEAR(distance(rig.state.position, {0, 0, -0.02}), 0, 1e-12);
  const Triple along{rig.state.rotation[0], rig.state.rotation[3], rig.state.rotation[6]};
  EXPECT_NEAR(distance(along, {0.8, -0.6, 0}), 0, 1e-9) << "+x is from the left tip to the right one, for either hand";
}

TEST(HaplyGripper, EachReadIsANewStateAndTheNewestOne) {
  HaplyRig rig;
  ASSERT_TRUE(rig.reads_until([] { return true; }));
  const std::uint32_t first = rig.state.sequence;
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(rig.reads_until([] { return true; }));
  EXPECT_EQ(rig.state.sequence, first + 100);
  // states that were asked for before the last message to the service are not read after it
  for (int k = 1; k <= 20; ++k) {
    rig.service.rest_at(haply_moved({0, 0, k * 1e-3}, {0, 0, k * 1e-3}));
    const std::int64_t messages = rig.service.messages();
    ASSERT_TRUE(rig.service.wait([&] { return rig.service.messages() >= messages + 3; }));
    ASSERT_TRUE(rig.reads_until([] { return true; }));
    EXPECT_NEAR(rig.state.position[1], k * 1e-3, 1e-12);
  }
}

TEST(HaplyGripper, EachTipGetsItsForce) {
  HaplyRig rig;
  rig.service.rest_at(haply_moved({-0.03, 0, 0}, {0.03, 0, 0}));
  ASSERT_TRUE(rig.reads_until([&] { return std::abs(rig.state.gap - 0.06) < 1e-12; }));
  // arm 2 N down and 1 N towards the person, grip 1.5 N that opens, on +x of the device frame
  const GripperForce force{{0, -2, 1}, 1.5};
  EXPECT_TRUE(rig.arrives(force, 0, {-1.5, -0.5, -1})) << "left: away from the right one, backwards, down";
  EXPECT_TRUE(rig.arrives(force, 1, {1.5, -0.5, -1}));
  // larger than what a device bears: its direction stays
  EXPECT_TRUE(rig.arrives({{0, -100, 0}, 0}, 0, {0, 0, -INVERSE3_FORCE}));
  EXPECT_FALSE(rig.gripper->write({{0, std::numeric_limits<double>::quiet_NaN(), 0}, 0}));
  EXPECT_STREQ(rig.gripper->last_error(), "a force that is NaN or infinite");
  EXPECT_TRUE(rig.has_zero()) << "instead of it";
}

// Closed form: the work of the grip on both tips is the grip times the change of the gap, wherever the line points.
TEST(HaplyGripper, AGripForceOpensAlongTheLineOfTheTips) {
  HaplyRig rig;
  const Triple left{-0.02, 0.01, -0.01}, right{0.02, -0.01, 0.03};
  rig.service.rest_at(haply_moved(left, right));
  const double gap = distance(left, right);
  ASSERT_TRUE(rig.reads_until([&] { return std::abs(rig.state.gap - gap) < 1e-12; }));
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(rig.reads_until([] { return true; }));  // the line has followed
  Triple wanted;
  for (std::size_t axis = 0; axis < 3; ++axis) wanted[axis] = 2 * (right[axis] - left[axis]) / gap;
  EXPECT_TRUE(rig.arrives({{}, 2}, 1, wanted));
  for (double& part : wanted) part = -part;
  EXPECT_TRUE(rig.arrives({{}, 2}, 0, wanted));
}

TEST(HaplyGripper, OneDeviceWithAGripClosesByItsButton) {
  HaplyRig rig(with_grip());
  const GripperLimits& limits = rig.gripper->limits();
  EXPECT_EQ(limits.name, "Inverse3 with VerseGrip");
  EXPECT_EQ(limits.address, rig.place() + "/0A01");
  EXPECT_EQ(limits.grip, 0) << "no grip force can be felt";
  EXPECT_EQ(limits.force, INVERSE3_FORCE);
  EXPECT_NE(rig.said.back().find("first button closes the hand"), std::string::npos) << rig.said.back();
  ASSERT_TRUE(rig.reads_until([] { return true; }));
  EXPECT_EQ(rig.state.gap, limits.gap[1]) << "open";
  // turned by 90 degrees about Haply's +z, which is up: +x of the grip then points away from the person
  HaplyMotion motion = haply_moved({0, 0, 0.01});
  motion.orientation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  motion.is_pressed = true;
  rig.service.rest_at(motion);
  ASSERT_TRUE(rig.reads_until([&] { return rig.state.buttons == 1; }));
  EXPECT_NEAR(distance(rig.state.position, {0, 0.01, 0}), 0, 1e-12);
  EXPECT_NEAR(distance({rig.state.rotation[0], rig.state.rotation[3], rig.state.rotation[6]}, {0, 0, -1}), 0, 1e-12);
  ASSERT_TRUE(rig.reads_until([&] { return rig.state.gap == 0; }));
  motion.is_pressed = false;
  rig.service.rest_at(motion);
  ASSERT_TRUE(rig.reads_until([&] { return rig.state.buttons == 0; }));
  // ticks of a millisecond: open again after half a second of them
  const std::int64_t start = rig.tick;
  ASSERT_TRUE(rig.reads_until([&] { return rig.state.gap == limits.gap[1]; }));
  EXPECT_NEAR(static_cast<double>(rig.tick - start), 500, 60) << "a silence of the service on a busy machine is one long tick";
  EXPECT_TRUE(rig.arrives({{1, 2, 3}, 5}, 0, {1, -3, 2})) << "the whole arm, and nothing of the grip";
}

// A grip that is not upright when it is calibrated is not turned there.
TEST(HaplyGripper, TheGripIsTurnedFromWhereItWasCalibrated) {
  HaplyOptions options = with_grip();
  const Scene scene = live_scene();
  stand_in::HaplyService service(options);
  static const std::atomic<bool> is_over{false};  // beyond the service's threads
  service.move([greeting = haply_greeting(is_over)](double time) {
    HaplyMotion motion = greeting(time);
    motion.orientation = {0.5, 0.5, 0.5, 0.5};
    return motion;
  });
  const auto gripper = open_haply(
      {{"127.0.0.1", service.port()}, {}}, scene, LONG_WATCHDOG, [](const std::string&) {}, QUICK_CALIBRATION);
  GripperState state;
  for (int tick = 0; tick < 1000 && gripper->read(state, tick) != ReadOutcome::value; ++tick) {
  }
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(state.rotation[k], NO_ROTATION[k], 1e-12);
}

TEST(HaplyGripper, AServiceBefore35GetsValues) {
  HaplyOptions options;
  options.version = "3.3.1.0";
  HaplyRig rig(options);
  ASSERT_TRUE(rig.reads_until([] { return true; }));
  EXPECT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0})) << "the stand-in ignores any other key, as the service does";
}

// ---- what the service may do ----

TEST(HaplyGripper, SilenceIsATimeoutAndEndsTheForce) {
  HaplyRig rig({}, 20e-3);
  ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
  rig.service.misbehave(HaplyFault::silent);
  ASSERT_EQ(rig.first_failure(ReadOutcome::timeout), ReadOutcome::timeout);
  EXPECT_STREQ(rig.gripper->last_error(), "no new state of the service for 10 ms");
  EXPECT_TRUE(rig.has_zero()) << "it is sent to a service that answers nothing, too";
  EXPECT_EQ(rig.gripper->release(), ReleaseResult::refused) << "nobody can know what became of it";
  EXPECT_STREQ(rig.gripper->last_error(), "the service does not answer zero force");
}

TEST(HaplyGripper, AMessageThatIsNoStateIsNone) {
  for (const auto& sample :
       std::vector<std::pair<HaplyFault, const char*>>{{HaplyFault::no_json, "a message that is not a JSON object"},
                                                       {HaplyFault::no_number, "a message that is not a JSON object"},
                                                       {HaplyFault::no_finite, "a message that is not a JSON object"},
                                                       {HaplyFault::no_state, "a state without the first Inverse3"},
                                                       {HaplyFault::vanished, "a state without the right Inverse3"}}) {
    const char* const words = sample.second;
    HaplyRig rig({}, 20e-3);
    ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
    rig.service.misbehave(sample.first);
    ASSERT_TRUE(rig.service.wait([&] {
      return rig.read() == ReadOutcome::timeout && std::string(rig.gripper->last_error()) == words;
    })) << words;
    EXPECT_TRUE(rig.has_zero()) << words;
    EXPECT_EQ(rig.gripper->release(), ReleaseResult::written) << "the service still answers";
    EXPECT_FALSE(rig.gripper->notes_for_report().empty()) << words;
  }
  HaplyRig rig(with_grip());
  rig.service.misbehave(HaplyFault::vanished);
  EXPECT_TRUE(rig.service.wait([&] {
    return rig.read() == ReadOutcome::timeout && std::string(rig.gripper->last_error()) == "a state without the VerseGrip";
  }));
}

// In a flood nobody can say which state answers which force.
TEST(HaplyGripper, AFloodIsAnErrorAndEndsTheForce) {
  HaplyRig rig;
  ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
  rig.service.misbehave(HaplyFault::flood);
  ASSERT_EQ(rig.first_failure(ReadOutcome::error), ReadOutcome::error);
  EXPECT_STREQ(rig.gripper->last_error(), "the service sends more than it is asked for");
  EXPECT_TRUE(rig.has_zero());
  EXPECT_EQ(rig.gripper->release(), ReleaseResult::refused);
}

TEST(HaplyGripper, OthersDevicesAndClientsChangeNothing) {
  HaplyRig rig;
  rig.service.misbehave(HaplyFault::foreign);
  rig.service.rest_at(haply_moved({0, 0, 0.01}, {0, 0, 0.01}));
  EXPECT_TRUE(rig.reads_until([&] { return std::abs(rig.state.position[1] - 0.01) < 1e-12; }));
  rig.service.push({7, 7, 7});
  EXPECT_TRUE(rig.has_zero()) << "the next message renews the own force";
}

// An answer that never comes costs its own wait alone: zero force is confirmed again, and states arrive.
TEST(HaplyGripper, AMissingAnswerIsForgotten) {
  for (const HaplyFault fault : {HaplyFault::skips_one, HaplyFault::halves}) {
    HaplyRig rig;
    ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
    const std::int64_t messages = rig.service.messages();
    rig.service.misbehave(fault);
    ASSERT_TRUE(rig.service.wait([&] { return rig.service.messages() > messages + 4; }));
    // 20 messages that each wait 5 ms for the missing answer take 100 ms; some 20 take less than half of it, on a busy machine too
    const auto is_swift = [&rig] {
      const double start = monotonic_now();
      const std::int64_t before = rig.service.messages();
      return rig.service.wait([&] { return rig.service.messages() >= before + 20; }) && monotonic_now() - start < 50e-3;
    };
    EXPECT_TRUE(fault != HaplyFault::skips_one || rig.service.wait(is_swift));
    rig.service.rest_at(haply_moved({0, 0, 0.01}, {0, 0, 0.01}));
    EXPECT_TRUE(rig.reads_until([&] { return std::abs(rig.state.position[1] - 0.01) < 1e-12; }));
    EXPECT_TRUE(rig.service.wait([&] { return rig.gripper->release() == ReleaseResult::written; }));
    EXPECT_FALSE(rig.service.has_force()) << "only an answer to zero force counts";
  }
}

TEST(HaplyGripper, AStateInPiecesIsAState) {
  HaplyRig rig;
  rig.service.misbehave(HaplyFault::split);
  rig.service.rest_at(haply_moved({0, 0, 0.01}, {0, 0, 0.01}));
  EXPECT_TRUE(rig.reads_until([&] { return std::abs(rig.state.position[1] - 0.01) < 1e-12; }));
  EXPECT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
}

// A closed connection ends the session, and no other one is opened: the person has to calibrate again.
TEST(HaplyGripper, AClosedConnectionIsAnErrorForGood) {
  HaplyRig rig;
  ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
  rig.service.misbehave(HaplyFault::closed);
  ASSERT_EQ(rig.first_failure(ReadOutcome::error), ReadOutcome::error);
  EXPECT_STREQ(rig.gripper->last_error(), "the service closed the connection");
  EXPECT_TRUE(rig.has_zero());
  EXPECT_EQ(rig.service.other_messages(), 1) << "zero force by the connection that is left";
  rig.service.misbehave(HaplyFault::none);
  EXPECT_FALSE(rig.gripper->write({{1, 0, 0}, 0}));
  EXPECT_EQ(rig.read(), ReadOutcome::error);
  EXPECT_EQ(rig.gripper->release(), ReleaseResult::refused);
  EXPECT_STREQ(rig.gripper->last_error(), "the service closed the connection");
  EXPECT_TRUE(rig.service.wait([&] { return rig.service.clients() == 0; }));
  const std::int64_t messages = rig.service.messages();
  for (int k = 0; k < 100; ++k) EXPECT_EQ(rig.read(), ReadOutcome::error);
  EXPECT_EQ(rig.service.messages(), messages);
}

// ---- no force is left ----

TEST(HaplyGripper, AForceThatIsNotRenewedEnds) {
  HaplyRig rig({}, 20e-3);
  ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
  EXPECT_TRUE(rig.has_zero());
  EXPECT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0})) << "the next write counts again";
}

TEST(HaplyGripper, AReleaseIsTheLastForce) {
  HaplyRig rig;
  ASSERT_TRUE(rig.arrives({{2, 0, 0}, 3}, 0, {-2, 0, 0}));
  ASSERT_TRUE(rig.service.wait([&] { return rig.gripper->release() == ReleaseResult::written; }));
  EXPECT_FALSE(rig.service.has_force()) << "the service has answered it";
  const std::int64_t messages = rig.service.messages();
  ASSERT_TRUE(rig.service.wait([&] {
    rig.gripper->write({{2, 0, 0}, 3});
    return rig.service.messages() > messages + 20;
  }));
  EXPECT_FALSE(rig.service.has_force());
}

TEST(HaplyGripper, TheWatchTakesTheForceAwayUntilTheNextWrite) {
  HaplyRig rig;
  ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
  ASSERT_TRUE(rig.service.wait([&] { return rig.gripper->release_from_watchdog() == ReleaseResult::written; }));
  EXPECT_FALSE(rig.service.has_force());
  EXPECT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
}

TEST(HaplyGripper, ClosingLeavesNoForceAndNoClient) {
  for (const bool is_closed_first : {true, false}) {
    HaplyRig rig;
    EXPECT_TRUE(rig.service.wait([&] { return rig.service.clients() == 2; })) << "one speaks, one waits for a crash";
    ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
    if (is_closed_first) rig.gripper->close();
    rig.gripper.reset();
    EXPECT_TRUE(rig.has_zero());
    EXPECT_TRUE(rig.service.wait([&] { return rig.service.clients() == 0; }));
  }
}

TEST(HaplyGripper, APanicSendsZeroOnBothConnections) {
  HaplyRig rig;
  ASSERT_TRUE(rig.arrives({{2, 0, 0}, 0}, 0, {1, 0, 0}));
  EXPECT_EQ(rig.gripper->panic(), ReleaseResult::written);
  EXPECT_TRUE(rig.has_zero());
  EXPECT_TRUE(rig.service.wait([&] { return rig.service.other_messages() > 0; })) << "by the idle connection";
  rig.gripper->write({{2, 0, 0}, 0});
  EXPECT_TRUE(rig.has_zero());
}

// A whole session on the stand-in: the guard and the loop find nothing wrong, and the end is zero force. A service that is silent on a busy machine
// must end the session; not five times in a row.
TEST(HaplyGripper, ASessionEndsWithZeroForce) {
  bool is_clean = false;
  for (int k = 0; k < 5 && !is_clean; ++k) {
    HaplyRig rig;
    rig.service.rest_at(haply_moved({-0.03, 0, 0}, {0.03, 0, 0}));
    ASSERT_TRUE(rig.reads_until([&] { return std::abs(rig.state.gap - 0.06) < 1e-12; }));
    Session session(rig.scene, rig.gripper->limits().gap);
    LoopOptions options;
    options.seconds = 0.2;
    options.is_simulated = true;  // no clock: one tick for each state of the service
    HapticLoop loop(rig.scene.live, *rig.gripper, session, {}, options);
    const std::atomic<bool> stop{false};
    loop.run(stop);
    const LoopReport& report = loop.report();
    EXPECT_TRUE(report.fault == Fault::none || report.fault == Fault::timeout) << report.error;
    is_clean = report.fault == Fault::none && report.release == ReleaseResult::written;
    EXPECT_TRUE(rig.has_zero());
  }
  EXPECT_TRUE(is_clean);
}

}  // namespace
}  // namespace wholehand::device
