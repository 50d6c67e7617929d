// SPDX-License-Identifier: MIT
// The counter of a team of one.
#include "cluster/team.h"

#include <gtest/gtest.h>

namespace wholehand {
namespace {

TEST(Team, WhoHasAskedSeesThatTheCounterWasStopped) {
  int argc = 0;
  char** argv = nullptr;
  Team team(argc, argv);
  team.restart_counter();
  team.ask(5);
  EXPECT_EQ(team.answer(), 0u);
  EXPECT_FALSE(team.is_stopped());
  team.ask(7);
  EXPECT_FALSE(team.is_stopped());
  EXPECT_EQ(team.answer(), 5u);
  team.stop_counter();
  team.ask(7);
  while (!team.is_stopped()) Team::nap();
  EXPECT_GE(team.answer(), Team::NO_MORE);
  EXPECT_TRUE(team.is_stopped());
  team.restart_counter();
  EXPECT_FALSE(team.is_stopped());
  team.ask(1);
  EXPECT_FALSE(team.is_stopped());
  EXPECT_EQ(team.answer(), 0u);
}

}  // namespace
}  // namespace wholehand
