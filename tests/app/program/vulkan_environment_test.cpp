// SPDX-License-Identifier: MIT
// What the program sets for Mesa's drivers, and when.
#include "app/program/vulkan_environment.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>

#include "host/device.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"

namespace wholehand {
namespace {

// Containers often run under a user whose home is not there.
TEST(VulkanEnvironmentDeathTest, UnwritableCacheIsSilent) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("XDG_CACHE_HOME", "/proc/nonexistent", 1);
        unsetenv("MESA_SHADER_CACHE_DIR");
        prepare_vulkan_environment();
        { host::Device device; }
        std::_Exit(7);
      },
      testing::ExitedWithCode(7), "^$");
}

TEST(VulkanEnvironment, TheUsersOwnSettingsStay) {
  const ScopedVariable width("LP_NATIVE_VECTOR_WIDTH", "128");
  prepare_vulkan_environment();
  EXPECT_STREQ(getenv("LP_NATIVE_VECTOR_WIDTH"), "128");
}

TEST(VulkanEnvironment, TheCoreNeedsNothing) {
  const TemporaryFolder folder;
  const ScopedVariable width("LP_NATIVE_VECTOR_WIDTH", nullptr), cache("XDG_CACHE_HOME", folder.path().c_str()),
      own("MESA_SHADER_CACHE_DIR", nullptr);
  prepare_vulkan_environment("core");
  EXPECT_EQ(getenv("LP_NATIVE_VECTOR_WIDTH"), nullptr);
  EXPECT_FALSE(std::filesystem::exists(folder / "mesa_shader_cache"));
  prepare_vulkan_environment();
  EXPECT_TRUE(std::filesystem::exists(folder / "mesa_shader_cache"));
#if defined(__x86_64__)
  EXPECT_EQ(getenv("LP_NATIVE_VECTOR_WIDTH") != nullptr, __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                                                             __builtin_cpu_supports("avx512dq") &&
                                                             __builtin_cpu_supports("avx512vl"));
#endif
}

// A command that can be asked to compute on a device prepares for it.
TEST(VulkanEnvironment, EveryCommandWithADevicePrepares) {
  int commands = 0;
  for (const auto& entry : std::filesystem::directory_iterator(WHOLEHAND_SOURCE_DIR "/app/commands")) {
    const std::string text = file_text(entry.path());
    if (text.find("(\"--on\"") == text.npos && text.find("print_devices();") == text.npos) continue;
    if (entry.path().filename().string().rfind("command_", 0) != 0) continue;
    ++commands;
    EXPECT_NE(text.find("prepare_vulkan_environment("), text.npos) << entry.path();
  }
  EXPECT_EQ(commands, 6);
}

}  // namespace
}  // namespace wholehand
