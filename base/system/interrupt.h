// SPDX-License-Identifier: MIT
// Ctrl-C, a terminal that closes and termination as a flag that work checks between chunks.
#pragma once

#include <csignal>

#include <atomic>

namespace wholehand {

// While it lives, the first SIGINT, SIGTERM or SIGHUP sets `flag()`; another one that
// comes a quarter of a second later or more ends the process as usual, unless somebody takes it. At most one at a time.
class InterruptGuard {
 public:
  // `further`: one more signal that does the same; 0: none.
  explicit InterruptGuard(int further = 0);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  // What work under way stops at: set by a signal, or by the program to end a stretch of work early.
  std::atomic<bool>& flag();
  // Takes the flag back, unless a signal has come meanwhile.
  void clear();
  // From now on another signal is `act`'s, in the signal's handler. Null: it ends the process as usual.
  void on_second_signal(void (*act)(int signal));
  static bool signalled();
  // The number of the signal that came first to the latest guard; 0: none came.
  static int signal_number();

 private:
  int further_;
  struct sigaction interrupt_before_ {
  }, terminate_before_{}, hangup_before_{}, further_before_{};
};

}  // namespace wholehand
