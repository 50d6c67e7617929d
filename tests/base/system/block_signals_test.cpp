// SPDX-License-Identifier: MIT
// No signal reaches threads that are started while it is there, whatever becomes of the start.
// sanitizers: address
#include "base/system/block_signals.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace wholehand {
namespace {

bool is_blocked(int signal) {
  sigset_t now;
  pthread_sigmask(SIG_SETMASK, nullptr, &now);
  return sigismember(&now, signal) == 1;
}

TEST(BlockSignals, BlocksUntilItGoesAlsoByAnException) {
  ASSERT_FALSE(is_blocked(SIGINT));
  try {
    const BlockSignals inherited;
    EXPECT_TRUE(is_blocked(SIGINT) && is_blocked(SIGTERM));
    throw std::runtime_error("no thread is to be had");
  } catch (const std::runtime_error&) {
  }
  EXPECT_FALSE(is_blocked(SIGINT) || is_blocked(SIGTERM));
}

// What is blocked when a thread fails kills the process before its handler can say anything.
TEST(BlockSignals, LeavesItsOwnFailuresToEachThread) {
  const BlockSignals inherited;
  for (const FailureSignal& failure : FAILURE_SIGNALS) EXPECT_FALSE(is_blocked(failure.number)) << failure.name;
}

TEST(BlockSignals, LeavesBlockedWhatWas) {
  sigset_t one, before;
  sigemptyset(&one);
  sigaddset(&one, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &one, &before);
  { const BlockSignals inherited; }
  EXPECT_TRUE(is_blocked(SIGUSR1));
  EXPECT_FALSE(is_blocked(SIGINT));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace
}  // namespace wholehand
