// Threads that are started while no signal reaches them: signals are the business of the threads that were there before.
#pragma once

#include <pthread.h>

#include <csignal>

namespace wholehand {

// Blocks all signals in the calling thread, and so in those that it starts, until it goes; also where starting one throws.
class BlockSignals {
 public:
  BlockSignals() noexcept {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockSignals(const BlockSignals&) = delete;
  BlockSignals& operator=(const BlockSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace wholehand
