// SPDX-License-Identifier: MIT
// A second Vulkan driver, SwiftShader of Debian's chromium: subgroups of 4, and no doubles.
// sanitizers: none
#include <gtest/gtest.h>

#include "tests/support/files.h"
#include "tests/support/program.h"

namespace wholehand {
namespace {

TEST(SwiftShader, ComputesWhatTheCoreComputesInFloat) {
  const TemporaryFolder folder;
  write_file(
      folder / "driver.json",
      R"({"file_format_version": "1.0.0", "ICD": {"library_path": "/usr/lib/chromium/libvk_swiftshader.so", "api_version": "1.3.0"}})");
  const std::string driver = "VK_ICD_FILENAMES=" + (folder / "driver.json") + " ";
  const Outcome devices = run(driver + "PROGRAM devices 2>&1");
  EXPECT_EQ(devices.output.find("vulkan:0  SwiftShader Device"), 0u) << devices.output;
  EXPECT_NE(devices.output.find("precision float only"), std::string::npos) << devices.output;
  const Outcome check = run(driver + "PROGRAM check small 2>&1");
  EXPECT_EQ(check.code, 0) << check.output;
  EXPECT_NE(check.output.find("holds: the device computes what the core computes"), std::string::npos) << check.output;
  EXPECT_NE(check.output.find("the device has no double precision: the third comparison is left out"), std::string::npos)
      << check.output;
}

}  // namespace
}  // namespace wholehand
