// SPDX-License-Identifier: MIT
// Libraries say what failed; the program adds how the user asks for what would help.
#include "app/program/remedy.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "tests/support/scenes.h"

namespace wholehand {
namespace {

TEST(Remedies, FollowTheLine) {
  EXPECT_EQ(error_line(usage_error("no such vessel")), "no such vessel");
  EXPECT_EQ(error_line(failure_error("the driver answered ErrorUnknown", Remedy::core)),
            "the driver answered ErrorUnknown; use --on core");
  EXPECT_EQ(error_line(failure_error("it was lost; try again", Remedy::or_core)), "it was lost; try again, or use --on core");
  EXPECT_EQ(error_line(usage_error("no double precision", Remedy::float_precision)), "no double precision; use --precision float");
  EXPECT_EQ(
      error_line(failure_error("no SDK; name its path", Remedy::name_library)),
      "no SDK; name its path (--dhd-library, [device] library of the scene, or the environment variable WHOLEHAND_DHD_LIBRARY)");
}

TEST(Remedies, ASceneBeyondFloatHasItsOwn) {
  Scene scene = scene_of({beaker1()});
  scene.grips.hand_scale.values = {1, 0.09};
  testing::internal::CaptureStderr();
  const auto lines = print_float_warnings(scene, Precision::single);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].ends_with(" from double; use --precision double")) << lines[0];
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "wholehand: " + lines[0] + "\n");
}

// What the libraries of the lower floors print or throw names no option of the command line.
TEST(Remedies, LibrariesNameNoOptions) {
  const std::regex option("\"[^\"]*--[a-z]");
  for (const char* folder : {"base/files", "base/system", "core", "device", "host"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(WHOLEHAND_SOURCE_DIR "/") + folder)) {
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        // what root types, and the one refusal that an option of `live` lifts (device/loop/gains.cpp)
        const bool is_known =
            line.find("udevadm control --reload") != std::string::npos || line.find("--unsafe-gains") != std::string::npos;
        EXPECT_TRUE(is_known || !std::regex_search(line, option)) << entry.path() << ": " << line;
      }
    }
  }
}

}  // namespace
}  // namespace wholehand
