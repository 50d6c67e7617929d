// SPDX-License-Identifier: MIT
// Turns Ctrl-C, a closing terminal and termination into a flag that work checks between chunks.
#pragma once

#include <csignal>

#include <atomic>

namespace wholehand {

// While it lives, the first SIGINT, SIGTERM or SIGHUP sets `flag()`. Another one at least a quarter of a second later ends the process as usual,
// unless an action is set. Only one may exist at a time.
class InterruptGuard {
 public:
  // `further`: one more signal with the same effect; 0: none.
  explicit InterruptGuard(int further = 0);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  // The flag at which running work stops. A signal sets it, or the program, to end a stretch of work early.
  std::atomic<bool>& flag();
  // Clears the flag, unless a signal has come meanwhile.
  void clear();
  // From now on another signal calls `act` in the signal handler. Null: it ends the process as usual.
  void on_second_signal(void (*act)(int signal));
  static bool signalled();
  // The first signal's number since the latest guard began; 0: none came.
  static int signal_number();

 private:
  int further_;
  struct sigaction interrupt_before_ {
  }, terminate_before_{}, hangup_before_{}, further_before_{};
};

}  // namespace wholehand
