// SPDX-License-Identifier: MIT
// When the program itself fails: forked children that fail in every way, and a gripper that logs to memory shared with the test. (A sanitizer has
// handlers of its own.)
// sanitizers: none
#include "device/panic.h"

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
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

#include "device/haptic_loop.h"
#include "system/block_signals.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// What survives the child.
struct Log {
  std::atomic<int> writes{0}, panics{0}, ended{0}, meanwhiles{0};
  std::atomic<double> grip{0};  // the last that was written; panic() writes 0
};

class Shared {
 public:
  Shared() : log_(new (mmap(nullptr, sizeof(Log), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Log) {}
  ~Shared() { munmap(log_, sizeof(Log)); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  Log& operator*() const { return *log_; }
  Log* operator->() const { return log_; }

 private:
  Log* log_;
};

class LoggingGripper : public Gripper {
 public:
  explicit LoggingGripper(Log& log) : log_(log) {
    limits_.force = 12;
    limits_.grip = 8;
    limits_.gap = {0, 0.1};
    limits_.watchdog = 20e-3;
  }
  const GripperLimits& limits() const noexcept override { return limits_; }
  ReadOutcome read(GripperState& state, std::int64_t tick) noexcept override {
    if (tick == fails_at) fail();
    state.position = {0, 1, 0};
    state.gap = 0.05;
    state.sequence = static_cast<std::uint32_t>(tick + 1);
    return ReadOutcome::value;
  }
  bool write(const GripperForce& force) noexcept override {
    ++log_.writes;
    log_.grip = force.grip;
    return true;
  }
  LetGo panic() noexcept override {
    ++log_.panics;
    in_panic();
    if (answer == LetGo::written) log_.grip = 0;
    ++log_.ended;
    return answer;
  }
  LetGo let_go_meanwhile() noexcept override {
    ++log_.meanwhiles;
    in_meanwhile();
    log_.grip = 0;
    return LetGo::written;
  }

  std::function<void()> fail = [] {};
  std::function<void()> in_panic = [] {}, in_meanwhile = [] {};
  LetGo answer = LetGo::written;  // of panic()
  std::int64_t fails_at = -1;

 private:
  Log& log_;
  GripperLimits limits_;
};

struct PanicOutcome {
  int code = -1;  // 1000 + signal where one ended it
  std::string said;
};

// Runs in a child, within ten seconds, and keeps what it says on stderr.
PanicOutcome run_in_child(const std::function<void()>& body) {
  std::fflush(nullptr);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    alarm(10);
    body();
    _exit(0);
  }
  close(ends[1]);
  PanicOutcome outcome;
  char part[512];
  for (ssize_t got = 0; (got = read(ends[0], part, sizeof part)) > 0;) outcome.said.append(part, static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  return outcome;
}

int lines_of(const std::string& text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

void expect_panic(const PanicOutcome& outcome, const Log& log, const std::string& why) {
  EXPECT_EQ(outcome.code, 3) << outcome.said;
  EXPECT_EQ(log.panics, 1);
  EXPECT_EQ(log.grip, 0);
  EXPECT_NE(outcome.said.find("wholehand: live: the program failed (" + why +
                              "); zero force was written, state released; please report it\n"),
            std::string::npos)
      << outcome.said;
}

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
      {"assertion", [] { assert(lines_of("") == 1); }, "an assertion or an uncaught error"},
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

// The loop runs on a thread of its own, as in a live session, with a force on the gripper.
void run_loop(LoggingGripper& gripper, const std::function<void()>& on_another_thread = {}) {
  static const std::atomic<bool> stop{false};
  Scene scene = scene_of({beaker1()});
  Session session(scene, {0, 0.1});
  LoopOptions options;
  options.is_simulated = true;
  options.seconds = 100;
  HapticLoop loop(scene.live, gripper, session, {}, options);
  std::thread haptic([&] { loop.run(stop); });
  if (on_another_thread) on_another_thread();
  haptic.join();
}

TEST(PanicGuard, LetsGoWhenTheHapticThreadFails) {
  for (const Failure& failure : failures()) {
    SCOPED_TRACE(failure.name);
    Shared log;
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
    Shared log;
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
  Shared log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    PanicGuard guard(gripper);
    overflow_stack(nullptr);
  });
  expect_panic(outcome, *log, "SIGSEGV");
}

// The haptic thread's, too, if it has been given one.
TEST(PanicGuard, AnotherThreadHasItsOwnStackToo) {
  Shared log;
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
    Shared log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      PanicGuard guard(gripper);
      gripper.write({{}, 5});
      raise(signal);
    });
    EXPECT_EQ(outcome.code, 3) << signal;
    EXPECT_EQ(log->panics, 1) << signal;
    EXPECT_EQ(log->grip, 0) << signal;
    EXPECT_EQ(outcome.said, "wholehand: live: ended by a signal (" + name + "); zero force was written, state released\n");
  }
}

// panic() takes a while; a second thread fails meanwhile: it must not end the process before the force is gone.
TEST(PanicGuard, ASecondFailureDoesNotCutTheFirstShort) {
  Shared log;
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
  EXPECT_EQ(lines_of(outcome.said), 1);
}

TEST(PanicGuard, APanicThatFailsIsGivenUp) {
  for (const int inner : {SIGSEGV, SIGABRT}) {
    Shared log;
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
    Shared log;
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
    EXPECT_EQ(outcome.code, 3) << signal << outcome.said;
    EXPECT_EQ(log->panics, 1) << signal;
  }
}

TEST(PanicGuard, WhatWasIgnoredStaysSo) {
  Shared log;
  const PanicOutcome outcome = run_in_child([&] {
    std::signal(SIGQUIT, SIG_IGN);
    LoggingGripper gripper(*log);
    PanicGuard guard(gripper);
    raise(SIGQUIT);
  });
  EXPECT_EQ(outcome.code, 0) << outcome.said;
  EXPECT_EQ(log->panics, 0);
}

// The write that passes a file's limit fails, and whoever writes says so; afterwards all is as it was.
TEST(PanicGuard, AFileThatGrowsTooLargeEndsNothing) {
  Shared log;
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
  EXPECT_EQ(outcome.code, 1000 + SIGXFSZ) << outcome.said;
  EXPECT_EQ(log->ended, 1);
  EXPECT_EQ(log->panics, 0);
}

// ---- a library that ends the program ----

TEST(PanicGuard, AnExitIsNoWayOutOfASession) {
  for (const bool is_quick : {false, true}) {
    Shared log;
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
    EXPECT_EQ(outcome.said, "wholehand: live: a library ended the program by exit(0); zero force was written, state released\n");
  }
}

TEST(PanicGuard, AnExitAfterItIsAnExit) {
  Shared log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    { PanicGuard guard(gripper); }
    std::exit(7);
  });
  EXPECT_EQ(outcome.code, 7);
  EXPECT_EQ(outcome.said, "");
}

// ---- what is said of the force ----

// The last force as the loop wrote it, whoever fails.
TEST(PanicGuard, SaysWhatIsLeftOnADeviceThatTookNothing) {
  for (const LetGo answer : {LetGo::not_taken, LetGo::not_asked, LetGo::nothing}) {
    Shared log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      gripper.answer = answer;
      PanicGuard guard(gripper);
      gripper.note({{1.2, -1.6, 0}, -2.379});
      raise(SIGSEGV);
    });
    const std::string left =
        "; the last force was 2 N at the arm and 2.38 N at the fingers; the device's own watchdog takes it away within 20 ms, "
        "state "
        "released; please report it\n";
    const std::string words = answer == LetGo::not_taken ? "zero force could not be written" + left
                              : answer == LetGo::not_asked
                                  ? "zero force was not written, since the device's library cannot be called now" + left
                                  : "no force is on a device, state released; please report it\n";
    EXPECT_EQ(outcome.said, "wholehand: live: the program failed (SIGSEGV); " + words);
    EXPECT_EQ(outcome.code, 3);
  }
}

// What a signal handler must not do a second thread does.
TEST(PanicGuard, TheWatchWritesWhatTheHandlerMustNot) {
  for (const bool is_exit : {false, true}) {
    Shared log;
    const PanicOutcome outcome = run_in_child([&] {
      LoggingGripper gripper(*log);
      gripper.answer = LetGo::not_asked;
      CallWatch watch(gripper);
      PanicGuard guard(gripper, &watch);
      gripper.write({{}, 5});
      if (is_exit) std::exit(0);
      raise(SIGSEGV);
    });
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(log->meanwhiles, 1);
    EXPECT_EQ(log->grip, 0);
    EXPECT_NE(outcome.said.find("; zero force was written, state released"), std::string::npos) << outcome.said;
  }
}

// The second thread does not come back either: the process ends without it, and says that nothing was written.
TEST(PanicGuard, AWatchThatIsStuckIsNotWaitedFor) {
  Shared log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    gripper.answer = LetGo::not_asked;
    gripper.in_meanwhile = [] {
      for (;;) pause();
    };
    CallWatch watch(gripper);
    PanicGuard guard(gripper, &watch);
    gripper.note({{}, 5});
    raise(SIGSEGV);
  });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(log->meanwhiles, 1);
  EXPECT_NE(
      outcome.said.find("zero force was not written, since the device's library cannot be called now; the last force was 0 N at "
                        "the arm and 5 N at the fingers"),
      std::string::npos)
      << outcome.said;
}

TEST(PanicGuard, IsGoneWithItsEnd) {
  Shared log;
  const PanicOutcome outcome = run_in_child([&] {
    LoggingGripper gripper(*log);
    { PanicGuard guard(gripper); }
    std::abort();
  });
  EXPECT_EQ(outcome.code, 1000 + SIGABRT);
  EXPECT_EQ(log->panics, 0);
}

}  // namespace
}  // namespace wholehand
