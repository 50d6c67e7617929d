// SPDX-License-Identifier: MIT
// When the program itself fails: the message about the force, and who writes it. (Not under a sanitizer, which has its own handlers.)
// sanitizers: none
#include "device/loop/panic.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <new>
#include <string>

#include "tests/support/panicking.h"

namespace wholehand::device {
namespace {

// ---- messages about the force ----

// The last force as the loop wrote it, whoever fails.
TEST(PanicGuard, SaysWhatIsLeftOnADeviceThatTookNothing) {
  for (const ReleaseResult answer : {ReleaseResult::refused, ReleaseResult::not_attempted, ReleaseResult::no_force}) {
    SharedPanicLog log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      gripper.answer = answer;
      PanicGuard guard(gripper);
      gripper.set_last_written_force({{1.2, -1.6, 0}, -2.379});
      raise(SIGSEGV);
    });
    const std::string left =
        "; the last force was 2 N at the arm and 2.38 N at the fingers; the device's own watchdog takes it away within 20 ms, "
        "state "
        "released; please report it\n";
    const std::string words = answer == ReleaseResult::refused ? "zero force could not be written" + left
                              : answer == ReleaseResult::not_attempted
                                  ? "zero force was not written, since the device's library cannot be called now" + left
                                  : "no force is on a device, state released; please report it\n";
    EXPECT_EQ(outcome.error_output, "wholehand: live: the program failed (SIGSEGV); " + words);
    EXPECT_EQ(outcome.code, 3);
  }
}

// A second thread does what a signal handler must not do.
TEST(PanicGuard, TheWatchWritesWhatTheHandlerMustNot) {
  for (const bool is_exit : {false, true}) {
    SharedPanicLog log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      gripper.answer = ReleaseResult::not_attempted;
      CallWatch watch(gripper);
      PanicGuard guard(gripper, &watch);
      gripper.write({{}, 5});
      if (is_exit) std::exit(0);
      raise(SIGSEGV);
    });
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(log->meanwhiles, 1);
    EXPECT_EQ(log->grip, 0);
    EXPECT_NE(outcome.error_output.find("; zero force was written, state released"), std::string::npos) << outcome.error_output;
  }
}

// The second thread does not come back either: the process ends without it, and says that nothing was written.
TEST(PanicGuard, AWatchThatIsStuckIsNotWaitedFor) {
  SharedPanicLog log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    gripper.answer = ReleaseResult::not_attempted;
    gripper.in_meanwhile = [] {
      for (;;) pause();
    };
    CallWatch watch(gripper);
    PanicGuard guard(gripper, &watch);
    gripper.set_last_written_force({{}, 5});
    raise(SIGSEGV);
  });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(log->meanwhiles, 1);
  EXPECT_NE(outcome.error_output.find(
                "zero force was not written, since the device's library cannot be called now; the last force was 0 N at "
                "the arm and 5 N at the fingers"),
            std::string::npos)
      << outcome.error_output;
}

TEST(PanicGuard, IsGoneWithItsEnd) {
  SharedPanicLog log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    { PanicGuard guard(gripper); }
    std::abort();
  });
  EXPECT_EQ(outcome.code, 1000 + SIGABRT);
  EXPECT_EQ(log->panics, 0);
}

}  // namespace
}  // namespace wholehand::device
