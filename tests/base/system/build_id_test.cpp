// SPDX-License-Identifier: MIT
// The build's own hash, against what binutils reads from the file.
#include "base/system/build_id.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

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

}  // namespace
}  // namespace wholehand
