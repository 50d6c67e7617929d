// SPDX-License-Identifier: MIT
// Open grippers over HID, end to end: hidapi on hidraw nodes that umockdev answers for.
#include "device/grippers/hid_gripper.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "base/text/error.h"
#include "tests/support/allocations.h"
#include "tests/support/gripper_checks.h"
#include "tests/support/mock_grippers.h"

namespace wholehand::device {
namespace {

TEST(HidGripper, IsFoundWithItsLimits) {
  MockBench bench;
  EXPECT_TRUE(find_hid_grippers().empty());
  MockSettings second;
  second.identity.flags = protocol::LEFT_HANDED;
  HidMock gripper(bench), other(bench, second, 3);
  const auto found = find_hid_grippers();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].address, "hid:/dev/hidraw0");
  EXPECT_EQ(found[0].name, "mock gripper");
  EXPECT_EQ(found[0].summary, "12 N, grip 8 N, gap 0 to 25 mm, 500 Hz, right-handed");
  EXPECT_EQ(found[0].missing, "");
  EXPECT_EQ(found[1].address, "hid:/dev/hidraw3");
  EXPECT_EQ(found[1].summary, "12 N, grip 8 N, gap 0 to 25 mm, 500 Hz, left-handed, rotation not measured");
}

TEST(HidGripper, FirstFoundIsOpenedWhereNoneIsNamed) {
  MockBench bench;
  expect_error([] { open_hid("", PATIENT_WATCHDOG); }, ExitCode::failure,
               "no gripper found over HID: no device's report descriptor begins with usage 5748");
  HidMock gripper(bench, {}, 7);
  EXPECT_EQ(open_hid("", PATIENT_WATCHDOG)->limits().address, "hid:/dev/hidraw7");
}

TEST(HidGripper, SessionMovesAndFeels) {
  MockBench bench;
  HidMock mock(bench);
  check_session(mock, [&mock] { return open_hid(mock.node(), PATIENT_WATCHDOG); });
}

TEST(HidGripper, ReadAndWriteAllocateNothing) {
  MockBench bench;
  HidMock mock(bench);
  const auto gripper = open_hid(mock.node(), PATIENT_WATCHDOG);
  const long before = allocations();
  GripperState state;
  for (int i = 0; i < 50; ++i) {
    ASSERT_EQ(read_soon(*gripper, state), ReadOutcome::value);
    ASSERT_TRUE(gripper->write({{1, 0, 0}, 0}));
  }
  gripper->panic();
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_GT(before, 0) << "they are not counted";
}

TEST(HidGripper, ClockGoesOnWhereItWraps) {
  check_clock<HidMock>([](const HidMock& mock) { return open_hid(mock.node(), PATIENT_WATCHDOG); });
}

TEST(HidGripper, WrongReportsAreErrors) {
  MockBench bench;
  HidMock mock(bench);
  check_wrong_reports(mock, [&mock] { return open_hid(mock.node(), PATIENT_WATCHDOG); });
}

TEST(HidGripper, SilenceIsATimeoutAndTripsTheWatchdogs) {
  MockBench bench;
  HidMock mock(bench, on_the_clock());
  check_silence(mock, [&mock] { return open_hid(mock.node(), 0.2); });
}

TEST(HidGripper, UnpluggingIsSaid) {
  MockBench bench;
  HidMock mock(bench);
  check_unplugging(mock, [&mock] { return open_hid(mock.node(), PATIENT_WATCHDOG); });
  expect_error([&mock] { open_hid(mock.node(), PATIENT_WATCHDOG); }, ExitCode::failure,
               "hid:/dev/hidraw0: it cannot be opened: No such file or directory");
}

TEST(HidGripper, SignalsAreNoErrors) {
  MockBench bench;
  HidMock mock(bench);
  check_signals(mock, [&mock] { return open_hid(mock.node(), PATIENT_WATCHDOG); });
}

TEST(HidGripper, PanicLeavesNoForce) {
  MockBench bench;
  HidMock mock(bench);
  check_panic(mock, [&mock] { return open_hid(mock.node(), PATIENT_WATCHDOG); });
}

TEST(HidGripper, ASecondThreadTakesTheForceAway) {
  MockBench bench;
  HidMock mock(bench);
  check_release_from_watchdog(mock, [&mock] { return open_hid(mock.node(), PATIENT_WATCHDOG); });
}

TEST(HidGripper, ForceThatIsNotTakenIsAnError) {
  MockBench bench;
  HidMock mock(bench);
  const auto gripper = open_hid(mock.node(), PATIENT_WATCHDOG);
  mock.misbehave(Mischief::takes_no_force);
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_STREQ(gripper->last_error(), "it takes no force");
}

TEST(HidGripper, OldReportsAreNotTakenForNew) {
  MockBench bench;
  HidMock mock(bench, on_the_clock());
  check_old_reports(mock, [&mock] { return open_hid(mock.node(), PATIENT_WATCHDOG); });
}

TEST(HidGripper, DevicesThatCannotBeUsedAreRefused) {
  check_refusals<HidMock>([](const HidMock& mock, double watchdog) { return open_hid(mock.node(), watchdog); });
}

TEST(HidGripper, NoPermissionNamesTheRemedy) {
  MockBench bench;
  HidMock mock(bench);
  {
    const Refusal refusal(bench, mock);
    expect_error([&mock] { open_hid(mock.node(), PATIENT_WATCHDOG); }, ExitCode::failure,
                 "hid:/dev/hidraw0: no permission for /dev/hidraw0: copy device/udev/60-wholehand.rules to /etc/udev/rules.d/, run "
                 "`sudo udevadm "
                 "control --reload`, and plug it in again");
    const auto found = find_hid_grippers();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].address, "");
    EXPECT_EQ(found[0].name, "A wholehand gripper");
    EXPECT_TRUE(found[0].missing.starts_with("no permission for /dev/hidraw0: copy")) << found[0].missing;
  }
  EXPECT_NO_THROW(open_hid(mock.node(), PATIENT_WATCHDOG));
}

TEST(HidGripper, SecondSessionIsRefused) {
  MockBench bench;
  HidMock mock(bench);
  check_second_session(
      mock, [&mock] { return open_hid(mock.node(), PATIENT_WATCHDOG); }, find_hid_grippers);
}

TEST(HidGripper, SessionOfAnotherProcessIsRefused) {
  MockBench bench;
  HidMock mock(bench);
  const auto gripper = open_hid(mock.node(), PATIENT_WATCHDOG);
  const pid_t child = fork();
  if (child == 0) {
    try {
      open_hid(mock.node(), PATIENT_WATCHDOG);
    } catch (const Error& error) {
      _exit(std::string(error.what()) == "hid:/dev/hidraw0: in use by another session" ? 42 : 43);
    }
    _exit(44);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 42);
}

TEST(HidGripper, WhatIsNoGripperIsNotAsked) {
  MockBench bench;
  MockSettings settings;
  settings.is_gripper = false;
  HidMock mock(bench, settings);
  EXPECT_TRUE(find_hid_grippers().empty());
  expect_error([&mock] { open_hid(mock.node(), PATIENT_WATCHDOG); }, ExitCode::failure,
               "hid:/dev/hidraw0: it is no open gripper: its report descriptor does not begin with usage 5748 of page FF00");
  expect_error([] { open_hid("", PATIENT_WATCHDOG); }, ExitCode::failure, "no gripper found over HID");
  EXPECT_TRUE(mock.outputs().empty());
  expect_error([] { open_hid("/dev/null", PATIENT_WATCHDOG); }, ExitCode::failure, "hid:/dev/null: it is no hidraw node");
}

}  // namespace
}  // namespace wholehand::device
