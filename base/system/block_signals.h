// SPDX-License-Identifier: MIT
// Threads that are started while no signal reaches them: signals are the business of the threads that were there before. Only a thread's own failure
// stays with it: while that is blocked, the system ends the process without calling a handler.
#pragma once

#include <pthread.h>

#include <csignal>

#include "base/system/failure_signals.h"

namespace wholehand {

// Blocks all signals but FAILURE_SIGNALS in the calling thread, and so in those that it starts, until it goes; also where starting one throws.
class BlockSignals {
 public:
  BlockSignals() noexcept {
    sigset_t all;
    sigfillset(&all);
    for (const FailureSignal& failure : FAILURE_SIGNALS) sigdelset(&all, failure.number);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockSignals(const BlockSignals&) = delete;
  BlockSignals& operator=(const BlockSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace wholehand
