// SPDX-License-Identifier: MIT
// The files of a sweep: who may write where, and what is refused before any work.
// sanitizers: thread
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/files.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_trial.h"

namespace wholehand::sweeps {
namespace {

// Two starts at the same moment: one of them does the sweep, or both one after the other; the file is whole whatever they do.
TEST_F(RunTest, TwoAtOnceAreOneAfterTheOtherOrOneIsRefused) {
  const std::string expected = reference(quick_scene());
  for (int round = 0; round < 15; ++round) {
    int start[2];
    ASSERT_EQ(pipe(start), 0);
    pid_t children[2];
    for (pid_t& child : children) {
      child = fork();
      if (child != 0) continue;
      close(start[1]);
      char byte = 0;
      if (read(start[0], &byte, 1) != 0) _exit(98);
      SweepTrial trial(folder / "a.nc");
      trial.scene = quick_scene();
      _exit(exit_of(trial.start()));
    }
    close(start[0]);
    close(start[1]);  // both start now
    int done = 0;
    for (const pid_t child : children) {
      const int code = exit_of(child);
      EXPECT_TRUE(code == 0 || code == 2) << code;
      done += code == 0;
    }
    EXPECT_GE(done, 1);
    expect_same_values(expected, folder / "a.nc");
    for (const char* left : {".partial", ".partial.mark", ".partial.lock"})
      EXPECT_FALSE(file_exists(folder / "a.nc" + left)) << left;
    std::filesystem::remove(folder / "a.nc");
  }
}

TEST_F(RunTest, WhoWritesAResultIsNamedAndUndisturbed) {
  const std::string expected = reference(), path = folder / "a.nc";
  SweepTrial first(path);
  SweepOutcome second, resumed;
  int chunks = 0;
  first.before_chunk = [&] {
    if (++chunks != 4) return;
    for (const bool resume : {false, true}) {
      SweepTrial other(path);
      other.options.resume = resume;
      try {
        other.run_bare();
        ADD_FAILURE() << "two at once";
      } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::usage);
        EXPECT_TRUE(has(error.what(), "process " + std::to_string(getpid()) + " (")) << error.what();
      }
      EXPECT_EQ(other.opened, 0);
    }
  };
  EXPECT_EQ(first.run().code, ExitCode::done);
  EXPECT_GE(chunks, 4);
  expect_same_as(expected, path);
}

// As on two machines whose file system has no locks: the lock of the first is not seen.
TEST_F(RunTest, WhoFindsAnothersFileEndsAndLeavesItAlone) {
  const std::string expected = reference(), path = folder / "a.nc";
  SweepTrial first(path);
  first.options.tuning.mark_seconds = 0;
  std::string mark, partial;
  int chunks = 0;
  first.before_chunk = [&] {
    if (++chunks != 6) return;
    std::filesystem::remove(path + ".partial.lock");
    SweepTrial second(path);
    int its_chunks = 0;
    second.before_chunk = [&] {
      if (++its_chunks == 3) raise(SIGINT);
    };
    EXPECT_EQ(exit_of(second.start()), 130);
    mark = file_text(path + ".partial.mark");
    partial = file_text(path + ".partial");
  };
  const SweepOutcome outcome = first.run();
  EXPECT_EQ(outcome.code, ExitCode::failure);
  EXPECT_TRUE(has(outcome.error, path + ".partial: another job replaced this file meanwhile; ")) << outcome.error;
  EXPECT_FALSE(file_exists(path));
  EXPECT_EQ(file_text(path + ".partial.mark"), mark);
  EXPECT_EQ(file_text(path + ".partial"), partial);
  SweepTrial rest(path);
  rest.options.resume = true;
  EXPECT_EQ(rest.run().code, ExitCode::done);
  expect_same_as(expected, path);
}

TEST_F(RunTest, ALinkIsFollowedToItsFile) {
  std::filesystem::create_directory(folder / "data");
  std::filesystem::create_symlink("data/target.nc", folder / "a.nc");
  for (int round = 0; round < 2; ++round) {  // the file new, then there
    SweepTrial trial(folder / "a.nc");
    bool is_beside_target = false;
    trial.before_chunk = [&] { is_beside_target = file_exists(folder / "data/target.nc.partial"); };
    ASSERT_EQ(trial.run().code, ExitCode::done);
    EXPECT_TRUE(is_beside_target);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.nc"));
    expect_same_values(reference(), folder / "data/target.nc");
    EXPECT_TRUE(file_exists(folder / "a.best.csv"));
  }
}

TEST_F(RunTest, CompanionsOfOthersAreRefusedBeforeAnyWork) {
  for (const char* name : {"a.best.csv", "a.second.svg"}) {
    std::ofstream(folder / name) << "mine";
    SweepTrial trial(folder / "a.nc");
    const SweepOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::usage);
    EXPECT_TRUE(has(outcome.error, name)) << outcome.error;
    EXPECT_EQ(trial.opened, 0);
    EXPECT_EQ(file_text(folder / name), "mine");
    std::filesystem::remove(folder / name);
  }
  // what a sweep without best grips would remove
  std::ofstream(folder / "a.best.csv") << "mine";
  SweepTrial none(folder / "a.nc");
  none.options.best = 0;
  EXPECT_EQ(none.run().code, ExitCode::done);
  EXPECT_EQ(file_text(folder / "a.best.csv"), "mine");
  std::filesystem::remove(folder / "a.best.csv");
  for (const int best : {3, 0}) {
    SweepTrial own(folder / "a.nc");
    own.options.best = best;
    const SweepOutcome outcome = own.run();
    EXPECT_EQ(outcome.code, ExitCode::done) << outcome.error;
    EXPECT_EQ(file_exists(folder / "a.best.csv"), best > 0) << "its own it replaces and removes";
  }
}

TEST_F(RunTest, WhatIsCompleteNeedsNoRoom) {
  const std::string whole = reference();
  SweepTrial trial(whole);
  trial.options.resume = true;
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_FSIZE, &none);
    _exit(exit_of(trial.start()));
  }
  EXPECT_EQ(exit_of(child), 0);
}

TEST_F(RunTest, WhatCannotBeWrittenIsRefusedBeforeAnyWork) {
  for (const std::string& path : {folder.path(), folder / "missing/a.nc", std::string("/dev/full")}) {
    SweepTrial trial(path);
    const SweepOutcome outcome = trial.run();
    EXPECT_EQ(outcome.code, ExitCode::usage) << path;
    EXPECT_EQ(trial.opened, 0) << path;
    EXPECT_EQ(outcome.notes, "") << path;
  }
  SweepTrial trial("/proc/a.nc");
  const SweepOutcome outcome = trial.run();
  EXPECT_EQ(outcome.code, ExitCode::failure);
  EXPECT_EQ(outcome.notes, "");
}

TEST_F(RunTest, FileSizeLimitAndFullDisk) {
  const auto size = std::filesystem::file_size(reference());
  // too small for the values, for the structure besides, and for the last byte
  for (const rlim_t limit : {size / 4, size * 9 / 10, size - 1}) {
    SweepTrial trial(folder / "a.nc");
    const pid_t child = fork();
    if (child == 0) {
      const rlimit file_size{limit, limit};
      setrlimit(RLIMIT_FSIZE, &file_size);
      _exit(exit_of(trial.start()));
    }
    EXPECT_EQ(exit_of(child), 3) << limit;
    for (const char* name : {"a.nc", "a.nc.partial", "a.best.csv"}) EXPECT_FALSE(file_exists(folder / name)) << limit << name;
  }
}

}  // namespace
}  // namespace wholehand::sweeps
