// SPDX-License-Identifier: MIT
// A team of one: its counter, and what becomes of an exception.
#include "cluster/team.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <system_error>

#include "cluster/cluster_sweep.h"

namespace wholehand {
namespace {

// MPI begins once in a process.
Team& team_of_one() {
  static int argc = 0;
  static char** argv = nullptr;
  static Team team(argc, argv);
  return team;
}

TEST(Team, WhoHasAskedSeesThatTheCounterWasStopped) {
  Team& team = team_of_one();
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

// Where only Errors were, MPI ended the job.
TEST(Team, EveryExceptionOfARankIsAnErrorOfAll) {
  const std::string folder = std::filesystem::temp_directory_path() / ("team." + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  Scene scene;
  scene.name = "empty";
  scene.file = "empty.toml";
  scene.vessels.resize(1);
  scene.vessels[0].name = "cup";
  SweepOptions options;
  options.output = folder + "/a.nc";
  options.on = "core";
  SweepParts parts;
  parts.prepare = [] { throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again)); };
  InterruptGuard interrupt(SIGUSR1);
  try {
    run_cluster_sweep(team_of_one(), scene, options, parts, interrupt);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_EQ(std::string(error.what()), "unexpected failure: Resource temporarily unavailable");
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace wholehand
