// SPDX-License-Identifier: MIT
// `live` with a device whose library fails in every way, and with signals: the force on the device at the end is the reported one.
// sanitizers: none
#include "app/commands/live.h"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include "base/text/error.h"
#include "device/grippers/omega_gripper.h"
#include "tests/support/device_session.h"
#include "tests/support/stand_in_dhd.h"

namespace wholehand {
namespace {

// ---- failures within the library ----

TEST(LiveDevice, ALibraryThatFailsHasTheForceTakenAwayByAnotherThread) {
  for (const char* function : {GET_POSE, SET_FORCE}) {
    DeviceSession session;
    const EndedSession ended =
        session.run([&](StandIn& dhd, DeviceLog&) { dhd->hooks[function] = in_write(200, [] { raise(SIGSEGV); }); });
    EXPECT_EQ(ended.code, 3);
    EXPECT_GT(session.log->largest(), 0.5);
    EXPECT_EQ(session.log->last().force, 0);
    expect_said(ended, "wholehand: live: the program failed (SIGSEGV); zero force was written, state released; please report it\n");
  }
}

// It fails with its own locks held.
TEST(LiveDevice, ALibraryThatFailsAndLetsNobodyInLeavesItToTheWatchdog) {
  for (const bool is_exit : {false, true}) {
    DeviceSession session;
    const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog&) {
      static std::mutex within;
      dhd->hooks[SET_FORCE] = [is_exit, count = std::make_shared<std::atomic<int>>(0)] {
        const std::lock_guard lock(within);
        if (++*count != 200) return;
        if (is_exit) std::exit(0);
        raise(SIGSEGV);
      };
    });
    EXPECT_EQ(ended.code, 3);
    EXPECT_GT(session.log->last().force, 0.5);
    const std::string what = is_exit ? "a library ended the program by exit(0); " : "the program failed (SIGSEGV); ";
    expect_said(ended, "wholehand: live: " + what +
                           "zero force was not written, since the device's library cannot be called now; the last force was ");
    expect_said(ended, " N at the fingers; the device's own watchdog takes it away within 20 ms, state released");
  }
}

TEST(LiveDevice, ALibraryThatExitsIsAFailure) {
  DeviceSession session;
  const EndedSession ended =
      session.run([&](StandIn& dhd, DeviceLog&) { dhd->hooks[GET_POSE] = in_write(200, [] { std::exit(0); }); });
  EXPECT_EQ(ended.code, 3);
  EXPECT_GT(session.log->largest(), 0.5);
  EXPECT_EQ(session.log->last().force, 0);
  EXPECT_EQ(ended.error_output.substr(ended.error_output.rfind("wholehand")),
            "wholehand: live: a library ended the program by exit(0); zero force was written, state released\n");
}

// The library exits before the loop, after it, and while the program only searches for devices.
TEST(LiveDevice, ALibraryThatExitsOutsideTheLoopIsAFailure) {
  for (const bool is_quick : {false, true}) {
    const auto leave = [is_quick] { is_quick ? std::quick_exit(0) : std::exit(0); };
    for (const char* function : {"dhdOpenID", "dhdEnableForce", "dhdStop", "dhdClose"}) {
      SCOPED_TRACE(function);
      DeviceSession session;
      session.options.seconds = 0.3;
      const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog&) { dhd->hooks[function] = leave; });
      EXPECT_EQ(ended.code, 3);
      const bool is_open = function == std::string("dhdStop") || function == std::string("dhdClose");
      expect_said(ended, is_open
                             ? "wholehand: live: a library ended the program by exit(0); no force is on a device, state released\n"
                             : "wholehand: omega: a library ended the program by exit(0)\n");
      if (is_open) {
        EXPECT_EQ(session.log->last().force, 0);
      }
    }
    for (const char* function : {"dhdOpenID", "dhdClose"}) {
      DeviceSession session;
      session.action = [](const LiveOptions& options) {
        device::find_omega_grippers(options.dhd_library);
        return ExitCode::done;
      };
      const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog&) { dhd->hooks[function] = leave; });
      EXPECT_EQ(ended.code, 3) << function;
      EXPECT_EQ(ended.error_output, "wholehand: omega: a library ended the program by exit(0)\n") << function;
    }
  }
}

// Every call fails from some moment on: the reason is that of the first failed call, and the report says that the force is left.
TEST(LiveDevice, WhereEveryCallFailsTheForceIsSaidToBeLeft) {
  for (const bool is_read : {false, true}) {
    DeviceSession session;
    const EndedSession ended = session.run([&](StandIn& dhd, DeviceLog&) {
      dhd->hooks[is_read ? GET_POSE : SET_FORCE] = in_write(200, [&dhd] {
        dhd->error = "communication \xff error";
        dhd->codes[SET_FORCE] = dhd->codes[GET_POSE] = -1;
        dhd->on_force = {};
      });
    });
    EXPECT_EQ(ended.code, 3);
    EXPECT_GT(session.log->last().force, 0.5);
    expect_said(ended, is_read ? ": read error (pose not read: communication ? error); "
                               : ": write error (force not taken: communication ? error); ");
    expect_said(ended, "zero force could not be written (force not taken: communication ? error); the last force was ");
    expect_said(ended, "; the device's own watchdog takes it away within 20 ms\n");
  }
}

// A session that ends well by itself, but for its last write.
TEST(LiveDevice, AnEndWhoseZeroForceIsNotTakenIsAFailure) {
  DeviceSession session;
  const EndedSession ended = session.run([](StandIn& dhd, DeviceLog&) {
    dhd->hooks[SET_FORCE] = [&dhd, count = 0]() mutable {
      if (++count == 200) raise(SIGINT);  // the loop's next look sees it
      if (count > 200) dhd->codes[SET_FORCE] = -1;
    };
  });
  EXPECT_EQ(ended.code, 3);
  expect_said(ended, "wholehand: live: the session ended after ");
  expect_said(ended, "zero force could not be written (force not taken: no error); the last force was ");
}

// ---- signals ----

TEST(LiveDevice, SignalsThatWouldEndItAtOnceLetGo) {
  for (const int signal : {SIGPWR, SIGSYS, SIGTRAP, SIGIO, SIGSTKFLT, SIGRTMIN, SIGRTMAX}) {
    DeviceSession session;
    session.start([](StandIn&, DeviceLog&) {});
    ASSERT_TRUE(session.has_written(100));
    session.send(signal);
    const EndedSession ended = session.wait();
    EXPECT_EQ(ended.code, 3) << signal;
    expect_said(ended, "zero force was written, state released");
    EXPECT_EQ(session.log->last().force, 0) << signal;
  }
}

// Ctrl-C is a request that the loop checks; where the loop hangs in the library, the next Ctrl-C takes the force away itself.
TEST(LiveDevice, ASecondInterruptLetsGo) {
  for (const auto& [signal, name] : {std::pair{SIGINT, "SIGINT"}, std::pair{SIGTERM, "SIGTERM"}, std::pair{SIGHUP, "SIGHUP"}}) {
    DeviceSession session;
    session.start([](StandIn& dhd, DeviceLog&) {
      dhd->hooks[GET_POSE] = in_write(200, [] {
        raise(SIGSTOP);  // for the test to see where it is
        hang();
      });
    });
    session.go_on_after(std::chrono::milliseconds(1));
    session.send(signal);
    // two within a quarter of a second are one, and a busy machine may bring them together: another one follows
    constexpr int MOST_SIGNALS = 30;
    for (int k = 0; k < MOST_SIGNALS && !session.has_ended(); ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1000));
      session.send(signal);
      std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    }
    if (!session.has_ended()) FAIL() << name << ": it still runs after " << MOST_SIGNALS << " further signals";
    const EndedSession ended = session.wait();
    EXPECT_EQ(ended.code, 3) << name;
    EXPECT_GT(session.log->largest(), 0.5);
    EXPECT_EQ(session.log->last().force, 0);
    expect_said(ended, std::string("wholehand: live: ended by a signal (") + name + "); zero force was written, state released\n");
  }
}

// Standard output is a file that has grown to its limit: what cannot be printed ends the session, and the signal does not.
TEST(LiveDevice, AFileThatMayNotGrowEndsItByTheWrite) {
  DeviceSession session;
  session.options.seconds = 0.5;
  const EndedSession ended = session.run([](StandIn&, DeviceLog&) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_FSIZE, &none);
  });
  EXPECT_EQ(ended.code, 3);
  EXPECT_GT(session.log->largest(), 0.5);
  EXPECT_EQ(session.log->last().force, 0);
}

}  // namespace
}  // namespace wholehand
