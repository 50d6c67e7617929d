// SPDX-License-Identifier: MIT
// When the program itself fails: forked children that fail in every way. (Not under a sanitizer, which has handlers of its own.)
// sanitizers: none
#include "device/loop/panic.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#undef NDEBUG  // a failing assertion is wanted here
#include <cassert>

#include "base/system/block_signals.h"
#include "tests/support/panicking.h"

namespace wholehand::device {
namespace {

void overflow_stack(volatile char* before);
void (*volatile again)(volatile char*) = overflow_stack;  // so that the compiler does not see where it leads

void overflow_stack(volatile char* before) {
  volatile char here[4096];
  here[0] = before ? before[0] : 0;
  again(here);
  here[1] = 1;  // no tail call
}

void throw_something() { throw std::runtime_error("nobody catches this"); }

struct Failure {
  const char* name;
  std::function<void()> fail;
  const char* why;
};

std::vector<Failure> failures() {
  return {
      {"assertion", [] { assert(line_count("") == 1); }, "an assertion or an uncaught error"},
      {"exception out of noexcept", []() noexcept { throw_something(); }, "an assertion or an uncaught error"},
      {"terminate", [] { std::terminate(); }, "an assertion or an uncaught error"},
      {"no memory", [] { raise(SIGABRT); }, "an assertion or an uncaught error"},
      {"segmentation fault", [] { *static_cast<volatile int*>(nullptr) = 1; }, "SIGSEGV"},
      {"bus error", [] { raise(SIGBUS); }, "SIGBUS"},
      {"arithmetic", [] { raise(SIGFPE); }, "SIGFPE"},
      {"instruction", [] { __builtin_trap(); }, "SIGILL"},
      {"trap", [] { raise(SIGTRAP); }, "SIGTRAP"},
      {"system call", [] { raise(SIGSYS); }, "SIGSYS"},
  };
}

TEST(PanicGuard, LetsGoWhenTheHapticThreadFails) {
  for (const Failure& failure : failures()) {
    SCOPED_TRACE(failure.name);
    SharedPanicLog log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      PanicGuard guard(gripper);
      gripper.fails_at = 100;
      gripper.fail = [&] {
        gripper.write({{}, 5});
        failure.fail();
      };
      run_loop(gripper);
    });
    expect_panic(outcome, *log, failure.why);
    EXPECT_EQ(log->writes, 101);
  }
}

TEST(PanicGuard, LetsGoWhenAnotherThreadFails) {
  for (const Failure& failure : failures()) {
    SCOPED_TRACE(failure.name);
    SharedPanicLog log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      PanicGuard guard(gripper);
      std::atomic<bool> is_running{false};
      gripper.fails_at = 50;
      gripper.fail = [&] {  // the haptic thread itself is well, and waits in its read
        gripper.write({{}, 5});
        is_running = true;
        for (;;) pause();
      };
      run_loop(gripper, [&] {
        while (!is_running) std::this_thread::yield();
        failure.fail();
      });
    });
    expect_panic(outcome, *log, failure.why);
  }
}

TEST(PanicGuard, HasAStackOfItsOwn) {
  SharedPanicLog log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    PanicGuard guard(gripper);
    overflow_stack(nullptr);
  });
  expect_panic(outcome, *log, "SIGSEGV");
}

// The haptic thread's handler has a stack of its own too, if the thread sets one up.
TEST(PanicGuard, AnotherThreadHasItsOwnStackToo) {
  SharedPanicLog log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    PanicGuard guard(gripper);
    std::thread haptic([] {
      const HandlerStack stack;
      overflow_stack(nullptr);
    });
    haptic.join();
  });
  expect_panic(outcome, *log, "SIGSEGV");
}

// Signals that nobody handles and that would end the process at once.
TEST(PanicGuard, LetsGoAtSignalsThatEndTheProcess) {
  for (const auto& [signal, name] : std::vector<std::pair<int, std::string>>{{SIGQUIT, "SIGQUIT"},
                                                                             {SIGALRM, "SIGALRM"},
                                                                             {SIGUSR1, "SIGUSR1"},
                                                                             {SIGUSR2, "SIGUSR2"},
                                                                             {SIGXCPU, "SIGXCPU"},
                                                                             {SIGVTALRM, "SIGVTALRM"},
                                                                             {SIGPROF, "SIGPROF"},
                                                                             {SIGPWR, "SIGPWR"},
                                                                             {SIGIO, "SIGIO"},
                                                                             {SIGSTKFLT, "SIGSTKFLT"},
                                                                             {SIGRTMIN, "SIGRTMIN+0"},
                                                                             {SIGRTMIN + 5, "SIGRTMIN+5"},
                                                                             {SIGRTMAX, "SIGRTMIN+30"}}) {
    SharedPanicLog log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      PanicGuard guard(gripper);
      gripper.write({{}, 5});
      raise(signal);
    });
    EXPECT_EQ(outcome.code, 3) << signal;
    EXPECT_EQ(log->panics, 1) << signal;
    EXPECT_EQ(log->grip, 0) << signal;
    EXPECT_EQ(outcome.error_output, "wholehand: live: ended by a signal (" + name + "); zero force was written, state released\n");
  }
}

// panic() takes a while; a second thread fails meanwhile: it must not end the process before the force is gone.
TEST(PanicGuard, ASecondFailureDoesNotCutTheFirstShort) {
  SharedPanicLog log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    PanicGuard guard(gripper);
    std::atomic<bool> is_in_panic{false};
    gripper.write({{}, 5});
    gripper.in_panic = [&] {
      is_in_panic = true;
      usleep(50'000);
    };
    std::thread other([&] {
      while (!is_in_panic) {
      }
      std::abort();
    });
    raise(SIGSEGV);
  });
  expect_panic(outcome, *log, "SIGSEGV");
  EXPECT_EQ(log->ended, 1);
  EXPECT_EQ(line_count(outcome.error_output), 1);
}

TEST(PanicGuard, APanicThatFailsIsGivenUp) {
  for (const int inner : {SIGSEGV, SIGABRT}) {
    SharedPanicLog log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      PanicGuard guard(gripper);
      gripper.in_panic = [&] { raise(inner); };
      raise(SIGSEGV);
    });
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(log->panics, 1);
    EXPECT_EQ(log->ended, 0);
  }
}

// A thread that started with its signals blocked fails like any other.
TEST(PanicGuard, LetsGoWhenAThreadOfBlockedSignalsFails) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGABRT}) {
    SharedPanicLog log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      PanicGuard guard(gripper);
      std::thread other;
      {
        const BlockSignals inherited;
        other = std::thread([signal] { raise(signal); });
      }
      other.join();
    });
    EXPECT_EQ(outcome.code, 3) << signal << outcome.error_output;
    EXPECT_EQ(log->panics, 1) << signal;
  }
}

TEST(PanicGuard, WhatWasIgnoredStaysSo) {
  SharedPanicLog log;
  const PanicOutcome outcome = run_in_child([&] {
    std::signal(SIGQUIT, SIG_IGN);
    LoggingGripper gripper(*log);
    PanicGuard guard(gripper);
    raise(SIGQUIT);
  });
  EXPECT_EQ(outcome.code, 0) << outcome.error_output;
  EXPECT_EQ(log->panics, 0);
}

// The write that passes a file's limit fails, and whoever writes says so; afterwards all is as it was.
TEST(PanicGuard, AFileThatGrowsTooLargeEndsNothing) {
  SharedPanicLog log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    {
      PanicGuard guard(gripper);
      raise(SIGXFSZ);
      raise(SIGPIPE);
      ++log->ended;
    }
    raise(SIGXFSZ);
  });
  EXPECT_EQ(outcome.code, 1000 + SIGXFSZ) << outcome.error_output;
  EXPECT_EQ(log->ended, 1);
  EXPECT_EQ(log->panics, 0);
}

// ---- a library that ends the program ----

TEST(PanicGuard, AnExitIsNoWayOutOfASession) {
  for (const bool is_quick : {false, true}) {
    SharedPanicLog log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      PanicGuard guard(gripper);
      gripper.fails_at = 100;
      gripper.fail = [&] {
        gripper.write({{}, 5});
        if (is_quick) std::quick_exit(0);
        std::exit(0);
      };
      run_loop(gripper);
    });
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(log->grip, 0);
    EXPECT_EQ(log->panics, 1);
    EXPECT_EQ(outcome.error_output,
              "wholehand: live: a library ended the program by exit(0); zero force was written, state released\n");
  }
}

TEST(PanicGuard, AnExitAfterItIsAnExit) {
  SharedPanicLog log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    { PanicGuard guard(gripper); }
    std::exit(7);
  });
  EXPECT_EQ(outcome.code, 7);
  EXPECT_EQ(outcome.error_output, "");
}

}  // namespace
}  // namespace wholehand::device
