// SPDX-License-Identifier: MIT
// One writer of a result at a time, whatever became of the one before.
#include "base/files/output_lock.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <vector>

#include "base/text/error.h"
#include "tests/support/files.h"

namespace wholehand {
namespace {

std::string lock_refusal(const std::string& path) {
  try {
    const OutputLock lock(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage) << error.what();
    return error.what();
  }
  return "";
}

// A process that takes the lock, says so, and keeps it until it is ended.
class Holder {
 public:
  explicit Holder(const std::string& path) {
    int ready[2];
    EXPECT_EQ(pipe(ready), 0);
    process = fork();
    if (process == 0) {
      const OutputLock lock(path);
      if (write(ready[1], "x", 1) != 1) _exit(1);
      for (;;) pause();
    }
    char byte = 0;
    EXPECT_EQ(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~Holder() { end(); }
  void end() {
    if (process > 0) kill(process, SIGKILL), waitpid(process, nullptr, 0);
    process = 0;
  }
  pid_t process = 0;
};

TEST(OutputLock, TheSecondIsRefusedWithWhoHoldsIt) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lock";
  Holder holder(path);
  const std::string line = lock_refusal(path);
  EXPECT_EQ(line.rfind(path + ": process " + std::to_string(holder.process) + " (", 0), 0u) << line;
  EXPECT_NE(line.find(") writes this result; wait for it, or name another file with -o"), std::string::npos) << line;
  EXPECT_TRUE(file_exists(path)) << "the refused one leaves it";
  holder.end();
  EXPECT_TRUE(file_exists(path)) << "nobody removed it";
  EXPECT_EQ(lock_refusal(path), "") << "and it is no obstacle";
  EXPECT_FALSE(file_exists(path));
}

// The message names a process by number and machine: on this machine the number may be another process's.
TEST(OutputLock, WhoHoldsItOnAnotherMachineIsNamedWithIt) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lock";
  const OutputLock lock(path);
  std::string host(256, '\0');
  ASSERT_EQ(gethostname(host.data(), host.size()), 0);
  const std::string name = host.c_str();
  EXPECT_EQ(file_text(path), "wholehand process " + std::to_string(getpid()) + " on " + name + "\n");
  std::ofstream(path) << "wholehand process " << getpid() << " on " << name << "7\n";
  const std::string line = lock_refusal(path);
  EXPECT_NE(line.find(": process " + std::to_string(getpid()) + " on " + name + "7 writes this result; "), std::string::npos)
      << line;
}

TEST(OutputLock, OfTwoInOneProcessOneIsRefusedToo) {
  const TemporaryFolder folder;
  const OutputLock lock(folder / "a.lock");
  EXPECT_NE(lock_refusal(folder / "a.lock"), "");
}

// As another user's is: for root nothing is read-only.
TEST(OutputLock, OneThatCannotBeWrittenToLocksAllTheSame) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lock";
  std::ofstream(path) << "wholehand process 999999999\n";
  chmod(path.c_str(), 0444);
  {
    const OutputLock lock(path);
    EXPECT_NE(lock_refusal(path), "");
  }
  EXPECT_EQ(lock_refusal(path), "");
}

TEST(OutputLock, WhatIsNoLockStays) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lock";
  std::ofstream(path) << "something else";
  EXPECT_NE(lock_refusal(path).find("is no lock of wholehand's"), std::string::npos);
  EXPECT_EQ(file_text(path), "something else");
  std::filesystem::create_symlink(folder / "elsewhere", folder / "b.lock");
  std::filesystem::create_directory(folder / "c.lock");
  for (const char* name : {"b.lock", "c.lock"})
    EXPECT_NE(lock_refusal(folder / name).find("is no lock of wholehand's; move it"), std::string::npos) << name;
  EXPECT_FALSE(file_exists(folder / "elsewhere"));
  EXPECT_THROW(OutputLock(folder / "missing/a.lock"), Error);
}

// A waiting process may lock the file that its holder has just removed, while a third makes a new one: there are never two holders.
TEST(OutputLock, NeverTwoAtOnceHoweverTheyComeAndGo) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lock", witness = folder / "held";
  std::vector<pid_t> processes;
  for (int k = 0; k < 4; ++k) {
    const pid_t child = fork();
    if (child == 0) {
      int held = 0;
      for (int round = 0; round < 60; ++round) {
        try {
          const OutputLock lock(path);
          if (mkdir(witness.c_str(), 0700) != 0) _exit(9);  // another one is in here
          if (rmdir(witness.c_str()) != 0) _exit(8);
          ++held;
        } catch (const Error&) {
        }
      }
      _exit(held > 0 ? 0 : 7);
    }
    processes.push_back(child);
  }
  for (const pid_t process : processes) {
    int status = 0;
    waitpid(process, &status, 0);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 0);
  }
  EXPECT_FALSE(file_exists(path));
}

}  // namespace
}  // namespace wholehand
