// No force on the fingers when the program itself fails.
#pragma once

#include <csignal>

#include "device/gripper.h"

namespace wholehand {

// While it lives, a failed assertion, an uncaught exception, std::terminate or a fatal signal (SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL) on any
// thread first calls gripper.panic(), then writes a line to stderr and ends the process with exit code 3. At most one at a time. The
// gripper must outlive it.
class PanicGuard {
 public:
  explicit PanicGuard(Gripper& gripper);
  ~PanicGuard();
  PanicGuard(const PanicGuard&) = delete;
  PanicGuard& operator=(const PanicGuard&) = delete;

  static constexpr int SIGNALS = 5;

 private:
  struct sigaction before_[SIGNALS] {};
};

}  // namespace wholehand
