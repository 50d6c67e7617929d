// SPDX-License-Identifier: MIT
// Starts threads that receive no signals, which the existing threads handle. A thread's own failure signals stay unblocked: if they were blocked, the
// system would end the process without calling a handler.
#pragma once

#include <pthread.h>

#include <csignal>

#include "base/system/failure_signals.h"

namespace wholehand {

// Blocks all signals but FAILURE_SIGNALS in the calling thread, and so in the threads it starts, until destroyed, even if starting a thread throws.
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
