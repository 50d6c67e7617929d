// SPDX-License-Identifier: MIT
// No force on the fingers when the program itself fails.
#pragma once

#include <csignal>
#include <vector>

#include "device/loop/call_watch.h"
#include "device/loop/gripper.h"

namespace wholehand {

// A stack of its own for the handlers of the thread that makes it, for when that thread's own is what has failed. The one that was
// there before comes back.
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

// Whether a signal or an exit is ending the process: then no thread may write another force than zero. One load of an atomic.
bool is_releasing() noexcept;

// What a PanicGuard does at a signal that would end the process at once, for the handler of a signal that it does not take over:
// SIGINT, SIGTERM or SIGHUP for the second time. Safe in a signal handler.
[[noreturn]] void end_by_signal(int signal) noexcept;

// While it lives, on any thread: a failed assertion, an uncaught exception, std::terminate; a failure that comes as a signal (SIGABRT, SIGSEGV,
// SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS); another signal that would end the process at once (SIGQUIT, SIGALRM, SIGUSR1 and 2, SIGXCPU, SIGVTALRM,
// SIGPROF, SIGPWR, SIGIO, SIGSTKFLT and the real-time ones, unless they were ignored before); and exit() or quick_exit() by whatever library:
// each first calls gripper.panic(), has `watch` write zero force where that must not, then writes a line on what became of the force to stderr
// and ends the process with exit code 3. SIGXFSZ and SIGPIPE are ignored meanwhile, so that a write that meets them fails and says so. At most
// one at a time. Gripper and watch must outlive it; the watch may be missing.
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

// While it lives, exit() and quick_exit() by whatever library write a line that begins with `place` and end the process with exit
// code 3, as while a PanicGuard lives: for a device's library that is called before, after or without a session. Any number of
// them; `place` must outlive them.
class ExitGuard {
 public:
  explicit ExitGuard(const char* place);
  ~ExitGuard();
  ExitGuard(const ExitGuard&) = delete;
  ExitGuard& operator=(const ExitGuard&) = delete;
};

}  // namespace wholehand
