// SPDX-License-Identifier: MIT
#include "base/system/interrupt.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace wholehand {
namespace {

TEST(Interrupt, SignalSetsTheFlagAndStays) {
  for (const int signal : {SIGINT, SIGTERM}) {
    InterruptGuard guard;
    EXPECT_FALSE(guard.flag());
    EXPECT_EQ(InterruptGuard::signal_number(), 0);
    raise(signal);
    EXPECT_EQ(InterruptGuard::signal_number(), signal);
    EXPECT_TRUE(guard.flag());
    EXPECT_TRUE(InterruptGuard::signalled());
    guard.clear();
    EXPECT_TRUE(guard.flag()) << "a signal is not taken back";
  }
}

TEST(Interrupt, FlagSetByHandIsTakenBack) {
  InterruptGuard guard;
  guard.flag() = true;
  EXPECT_FALSE(InterruptGuard::signalled());
  guard.clear();
  EXPECT_FALSE(guard.flag());
}

TEST(Interrupt, SecondSignalEndsTheProcess) {
  const pid_t child = fork();
  if (child == 0) {
    InterruptGuard guard;
    raise(SIGINT);
    usleep(300000);
    raise(SIGINT);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
}

TEST(Interrupt, SecondSignalIsItsWhoTakesIt) {
  static volatile sig_atomic_t taken;
  taken = 0;
  InterruptGuard guard;
  guard.on_second_signal([](int signal) { taken = signal; });
  raise(SIGINT);
  raise(SIGTERM);
  EXPECT_EQ(taken, 0) << "one request";
  usleep(300000);
  raise(SIGTERM);
  EXPECT_EQ(taken, SIGTERM);
}

// As `timeout` sends it: to the process and to its group.
TEST(Interrupt, SignalThatComesTwiceIsOneRequest) {
  const pid_t child = fork();
  if (child == 0) {
    InterruptGuard guard;
    raise(SIGINT);
    raise(SIGINT);
    _exit(guard.flag() ? 7 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7);
}

TEST(Interrupt, HandlersAreThoseOfBeforeAfterwards) {
  struct sigaction before {
  }, after{};
  sigaction(SIGINT, nullptr, &before);
  { InterruptGuard guard; }
  sigaction(SIGINT, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

}  // namespace
}  // namespace wholehand
