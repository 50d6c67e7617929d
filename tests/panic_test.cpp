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
#include <vector>

#undef NDEBUG  // a failing assertion is wanted here
#include <cassert>

#include "device/haptic_loop.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// What survives the child.
struct Log {
  std::atomic<int> writes{0}, panics{0}, ended{0};
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
  void panic() noexcept override {
    ++log_.panics;
    in_panic();
    log_.grip = 0;
    ++log_.ended;
  }

  std::function<void()> fail = [] {};
  std::function<void()> in_panic = [] {};
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
  EXPECT_NE(outcome.said.find("wholehand: live: the program failed (" + why + "); the force was let go, state released"),
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
  for (const int signal : {SIGQUIT, SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU, SIGVTALRM, SIGPROF}) {
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
    EXPECT_EQ(outcome.said.rfind("wholehand: live: ended by a signal (SIG", 0), 0u) << outcome.said;
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
