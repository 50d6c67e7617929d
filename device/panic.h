// No force on the fingers when the program itself fails.
#pragma once

#include <csignal>
#include <vector>

#include "device/gripper.h"

namespace wholehand {

// A stack of its own for the handlers of the thread that makes it, for when that thread's own is what has failed.
class HandlerStack {
 public:
  HandlerStack();
  ~HandlerStack();
  HandlerStack(const HandlerStack&) = delete;
  HandlerStack& operator=(const HandlerStack&) = delete;

 private:
  std::vector<char> bytes_;
};

// While it lives, a failed assertion, an uncaught exception, std::terminate, a failure that comes as a signal (SIGABRT, SIGSEGV, SIGBUS, SIGFPE,
// SIGILL), or another signal that would end the process at once (SIGQUIT, SIGALRM, SIGUSR1 and 2, SIGXCPU, SIGVTALRM, SIGPROF), on any thread,
// first calls gripper.panic(), then writes a line to stderr and ends the process with exit code 3. At most one at a time. The
// gripper must outlive it.
class PanicGuard {
 public:
  explicit PanicGuard(Gripper& gripper);
  ~PanicGuard();
  PanicGuard(const PanicGuard&) = delete;
  PanicGuard& operator=(const PanicGuard&) = delete;

  static constexpr int SIGNALS = 12;

 private:
  HandlerStack stack_;
  struct sigaction before_[SIGNALS] {};
};

}  // namespace wholehand
