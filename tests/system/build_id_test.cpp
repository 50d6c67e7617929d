// SPDX-License-Identifier: MIT
// The build's own hash, against what binutils reads from the file.
#include "system/build_id.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/files.h"

namespace wholehand {
namespace {

TEST(BuildId, IsWhatTheLinkerLeftInTheProgram) {
  FILE* pipe = popen(("readelf -n /proc/" + std::to_string(getpid()) + "/exe").c_str(), "r");
  ASSERT_TRUE(pipe);
  std::string notes;
  std::array<char, 512> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe)) notes += buffer.data();
  pclose(pipe);
  EXPECT_EQ(build_id().size(), 40u);
  EXPECT_NE(notes.find("Build ID: " + build_id() + "\n"), std::string::npos) << notes;
}

TEST(BuildId, TheProgramIsNamedBeforeIt) {
  EXPECT_EQ(build_name(), std::filesystem::canonical("/proc/self/exe").filename().string() + " " + build_id());
}

// As a build does while a sweep runs.
TEST(BuildId, AProgramWhoseFileIsGoneKeepsItsName) {
  constexpr const char* NAME = "a copy of the tests";
  if (const char* self = std::getenv("BUILD_ID_TEST_COPY")) {  // in the copy
    ASSERT_EQ(unlink(self), 0);
    EXPECT_EQ(build_name(), NAME + (" " + build_id()));
    return;
  }
  const TemporaryFolder folder;
  const std::string copy = folder / NAME;
  std::filesystem::copy_file("/proc/self/exe", copy);
  const std::string command =
      "BUILD_ID_TEST_COPY='" + copy + "' '" + copy + "' --gtest_filter=BuildId.AProgramWhoseFileIsGoneKeepsItsName >/dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_FALSE(file_exists(copy)) << "the copy has run";
}

}  // namespace
}  // namespace wholehand
