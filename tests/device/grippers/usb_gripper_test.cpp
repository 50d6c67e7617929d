// SPDX-License-Identifier: MIT
// Open grippers over USB, end to end: libusb on device nodes that umockdev answers for.
#include "device/grippers/usb_gripper.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "base/text/error.h"
#include "tests/support/allocations.h"
#include "tests/support/gripper_checks.h"
#include "tests/support/mock_grippers.h"

namespace wholehand::device {
namespace {

TEST(UsbGripper, IsFoundWithItsLimits) {
  MockBench bench;
  EXPECT_TRUE(find_usb_grippers().empty());
  UsbMock gripper(bench);
  const auto found = find_usb_grippers();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].address, "usb:f055:5748");
  EXPECT_EQ(found[0].name, "mock gripper");
  EXPECT_EQ(found[0].summary, "12 N, grip 8 N, gap 0 to 25 mm, 500 Hz, right-handed");
  EXPECT_EQ(found[0].missing, "");
}

TEST(UsbGripper, IsOpenedByItsIdOrAsTheFirst) {
  MockBench bench;
  expect_error([] { open_usb("", PATIENT_WATCHDOG); }, ExitCode::failure,
               "no gripper found over USB: no device has an interface of class FF");
  expect_error([] { open_usb("f055:5748", PATIENT_WATCHDOG); }, ExitCode::failure, "usb:f055:5748: no such device is plugged in");
  UsbMock gripper(bench);
  EXPECT_EQ(open_usb("", PATIENT_WATCHDOG)->limits().address, "usb:f055:5748");
  EXPECT_EQ(open_usb("F055:5748", PATIENT_WATCHDOG)->limits().address, "usb:f055:5748");
  expect_error([] { open_usb("f055:5749", PATIENT_WATCHDOG); }, ExitCode::failure, "usb:f055:5749: no such device is plugged in");
}

TEST(UsbGripper, IdsHaveOneForm) {
  for (const char* text : {"f055", "f055:574", "f055:57480", "f05x:5748", "f055-5748", "-055:5748", "f055: 748", ":", "0xf0:0x57"})
    expect_error([text] { open_usb(text, PATIENT_WATCHDOG); }, ExitCode::usage,
                 std::string("usb:") + text + ": give the vendor and product id as VVVV:PPPP, four hexadecimal digits each");
}

TEST(UsbGripper, SessionMovesAndFeels) {
  MockBench bench;
  UsbMock mock(bench);
  check_session(mock, [] { return open_usb("", PATIENT_WATCHDOG); });
}

// libusb itself takes a block for each transfer it submits, and has no way around it: one for the output, one for each input.
TEST(UsbGripper, ReadAndWriteAllocateOnlyWhatLibusbMust) {
  MockBench bench;
  UsbMock mock(bench);
  const auto gripper = open_usb("", PATIENT_WATCHDOG);
  GripperState state;
  ASSERT_EQ(read_soon(*gripper, state), ReadOutcome::value);
  const std::uint32_t first = state.sequence;
  const long before = allocations();
  for (int i = 0; i < 50; ++i) {
    ASSERT_EQ(read_soon(*gripper, state), ReadOutcome::value);
    ASSERT_TRUE(gripper->write({{1, 0, 0}, 0}));
  }
  gripper->panic();
  const long inputs = state.sequence - first + 2;  // and what came since
  EXPECT_LE(allocations() - before, 50 + inputs);
}

TEST(UsbGripper, ClockGoesOnWhereItWraps) {
  check_clock<UsbMock>([](const UsbMock&) { return open_usb("", PATIENT_WATCHDOG); });
}

TEST(UsbGripper, WrongReportsAreErrors) {
  MockBench bench;
  UsbMock mock(bench);
  check_wrong_reports(mock, [] { return open_usb("", PATIENT_WATCHDOG); });
}

TEST(UsbGripper, SilenceIsATimeoutAndTripsTheWatchdogs) {
  MockBench bench;
  UsbMock mock(bench, on_the_clock());
  check_silence(mock, [] { return open_usb("", 0.2); });
}

TEST(UsbGripper, UnpluggingIsSaid) {
  MockBench bench;
  UsbMock mock(bench);
  check_unplugging(mock, [] { return open_usb("", PATIENT_WATCHDOG); });
  expect_error([] { open_usb("f055:5748", PATIENT_WATCHDOG); }, ExitCode::failure, "usb:f055:5748: no such device is plugged in");
}

TEST(UsbGripper, PanicLeavesNoForce) {
  MockBench bench;
  UsbMock mock(bench);
  check_panic(mock, [] { return open_usb("", PATIENT_WATCHDOG); });
}

TEST(UsbGripper, ASecondThreadTakesTheForceAway) {
  MockBench bench;
  UsbMock mock(bench);
  check_release_from_watchdog(mock, [] { return open_usb("", PATIENT_WATCHDOG); });
}

// One force is under way to a device that takes none, and another waits. `before`: what had arrived until then.
void leave_a_force_waiting(UsbMock& mock, Gripper& gripper, GripperState& state, std::size_t& before) {
  ASSERT_EQ(read_soon(gripper, state), ReadOutcome::value);
  before = mock.outputs().size();
  mock.misbehave(Mischief::takes_no_force);
  ASSERT_TRUE(gripper.write({{1, 0, 0}, 0}));
  ASSERT_TRUE(gripper.write({{2, 0, 0}, 0}));
}

// A force that waits for a slow device while the process stalls is not sent afterwards.
TEST(UsbGripper, AForceThatWaitedIsNotSentAfterAStall) {
  MockBench bench;
  UsbMock mock(bench);
  const auto gripper = open_usb("", PATIENT_WATCHDOG);
  GripperState state;
  std::size_t before = 0;
  leave_a_force_waiting(mock, *gripper, state, before);
  rest(0.02);
  mock.misbehave(Mischief::none);
  ASSERT_TRUE(arrives(mock, before + 1)) << "the kernel has it";
  for (int k = 0; k < 10; ++k) ASSERT_EQ(read_soon(*gripper, state), ReadOutcome::value);
  EXPECT_EQ(mock.outputs().size(), before + 1);
  EXPECT_TRUE(gripper->write({}));
  ASSERT_TRUE(arrives(mock, before + 2));
  EXPECT_EQ(mock.outputs().back().arm, (std::array<std::int32_t, 3>{}));
}

// A waiting force is not sent after the zero of a signal handler or a second thread either.
TEST(UsbGripper, AForceThatWaitedDoesNotFollowTheZeroOfAnotherThread) {
  for (const bool is_panic : {false, true}) {
    MockBench bench;
    UsbMock mock(bench);
    const auto gripper = open_usb("", PATIENT_WATCHDOG);
    GripperState state;
    std::size_t before = 0;
    leave_a_force_waiting(mock, *gripper, state, before);
    mock.misbehave(Mischief::none);
    EXPECT_EQ(is_panic ? gripper->panic() : gripper->release_from_watchdog(), ReleaseResult::written);
    for (int k = 0; k < 10; ++k) ASSERT_EQ(read_soon(*gripper, state), ReadOutcome::value);
    EXPECT_EQ(mock.outputs().size(), before + 2) << "the one under way and the zero";
    EXPECT_TRUE(is_nothing(mock.outputs().back()));
    EXPECT_FALSE(mock.has_force());
    EXPECT_TRUE(gripper->write({{3, 0, 0}, 0}));
    ASSERT_TRUE(arrives(mock, before + 3));
    EXPECT_EQ(is_nothing(mock.outputs().back()), is_panic) << "a session goes on after the second thread's";
  }
}

// A slow device is no error yet: the next force waits. A device that never takes a force is one, after ten.
TEST(UsbGripper, ForceThatIsNotTakenIsAnError) {
  MockBench bench;
  UsbMock mock(bench);
  const auto gripper = open_usb("", PATIENT_WATCHDOG);
  mock.misbehave(Mischief::takes_no_force);
  for (int i = 0; i < 11; ++i) ASSERT_TRUE(gripper->write({{1, 0, 0}, 0})) << i;
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_STREQ(gripper->last_error(), "it takes no force");
}

TEST(UsbGripper, OldReportsAreNotTakenForNew) {
  MockBench bench;
  UsbMock mock(bench, on_the_clock());
  check_old_reports(mock, [] { return open_usb("", PATIENT_WATCHDOG); });
}

TEST(UsbGripper, DevicesThatCannotBeUsedAreRefused) {
  check_refusals<UsbMock>([](const UsbMock&, double watchdog) { return open_usb("", watchdog); });
}

TEST(UsbGripper, NoPermissionNamesTheRemedy) {
  MockBench bench;
  UsbMock mock(bench);
  {
    const Refusal refusal(bench, mock);
    expect_error(
        [] { open_usb("", PATIENT_WATCHDOG); }, ExitCode::failure,
        "usb:f055:5748: no permission for /dev/bus/usb/001/001: copy device/udev/60-wholehand.rules to /etc/udev/rules.d/");
    const auto found = find_usb_grippers();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].address, "");
    EXPECT_TRUE(found[0].missing.starts_with("no permission for /dev/bus/usb/001/001: copy")) << found[0].missing;
  }
  EXPECT_NO_THROW(open_usb("", PATIENT_WATCHDOG));
}

TEST(UsbGripper, WhatIsNoGripperIsNotAsked) {
  MockBench bench;
  MockSettings settings;
  settings.is_gripper = false;
  UsbMock mock(bench, settings);
  EXPECT_TRUE(find_usb_grippers().empty());
  expect_error([] { open_usb("f055:5748", PATIENT_WATCHDOG); }, ExitCode::failure,
               "usb:f055:5748: it is no open gripper: it has no interface of class FF, subclass 57, protocol 48");
  expect_error([] { open_usb("", PATIENT_WATCHDOG); }, ExitCode::failure, "no gripper found over USB");
  EXPECT_TRUE(mock.outputs().empty());
}

TEST(UsbGripper, SecondSessionIsRefused) {
  MockBench bench;
  UsbMock mock(bench);
  check_second_session(
      mock, [] { return open_usb("", PATIENT_WATCHDOG); }, find_usb_grippers);
}

}  // namespace
}  // namespace wholehand::device
