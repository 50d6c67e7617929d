// SPDX-License-Identifier: MIT
// Removes the force from the fingers if the program itself fails.
#pragma once

#include <csignal>
#include <vector>

#include "device/loop/call_watch.h"
#include "device/loop/gripper.h"

namespace wholehand::device {

// A separate stack for signal handlers of the thread that makes it, in case the thread's own stack is what failed. Restores the previous one.
class HandlerStack {
 public:
  HandlerStack();
  ~HandlerStack();
  HandlerStack(const HandlerStack&) = delete;
  HandlerStack& operator=(const HandlerStack&) = delete;

 private:
  std::vector<char> bytes_;
  stack_t before_{};
};

// Whether a signal or an exit is ending the process: then no thread may write a nonzero force. One load of an atomic.
bool is_releasing() noexcept;

// Does what a PanicGuard does at a fatal signal, for the handler of a signal that it does not take over: SIGINT, SIGTERM or SIGHUP for the second
// time. Safe in a signal handler.
[[noreturn]] void end_by_signal(int signal) noexcept;

// While it lives, it handles these on any thread: a failed assertion, an uncaught exception, std::terminate; a failure signal (SIGABRT, SIGSEGV,
// SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS); another signal that would end the process at once (SIGQUIT, SIGALRM, SIGUSR1 and 2, SIGXCPU, SIGVTALRM,
// SIGPROF, SIGPWR, SIGIO, SIGSTKFLT and the real-time ones, unless they were ignored before); and exit() or quick_exit() by any library. Each first
// calls gripper.panic(), or has `watch` write zero force where panic() cannot, then writes a line on the force's fate to stderr and ends the process
// with exit code 3. SIGXFSZ and SIGPIPE are ignored meanwhile, so that the write that causes them fails and says so. Only one may exist at a time.
// Gripper and watch must outlive it; the watch may be null.
class PanicGuard {
 public:
  explicit PanicGuard(Gripper& gripper, CallWatch* watch = nullptr);
  ~PanicGuard();
  PanicGuard(const PanicGuard&) = delete;
  PanicGuard& operator=(const PanicGuard&) = delete;

 private:
  void set(int signal, const struct sigaction& action);

  HandlerStack stack_;
  struct Before {
    int signal = 0;
    struct sigaction action {};
  };
  std::vector<Before> before_;
};

// While it lives, exit() and quick_exit() by any library write a line that begins with `place` and end the process with exit code 3, as with a
// PanicGuard. For a device's library that is called before, after or without a session. Any number may exist; `place` must outlive them.
class ExitGuard {
 public:
  explicit ExitGuard(const char* place);
  ~ExitGuard();
  ExitGuard(const ExitGuard&) = delete;
  ExitGuard& operator=(const ExitGuard&) = delete;
};

}  // namespace wholehand::device
