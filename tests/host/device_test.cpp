// SPDX-License-Identifier: MIT
// sanitizers: address
#include "host/device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <utility>

#include "tests/support/vulkan_listener.h"

namespace wholehand::host {
namespace {

DeviceInfo made_up(std::size_t index, std::string name, DeviceKind kind) {
  DeviceInfo info;
  info.index = index;
  info.name = std::move(name);
  info.kind = kind;
  return info;
}

std::vector<DeviceInfo> made_up_devices() {
  return {made_up(0, "llvmpipe (LLVM 15.0.6)", DeviceKind::cpu), made_up(1, "Arc Graphics", DeviceKind::integrated),
          made_up(2, "GeForce A", DeviceKind::discrete), made_up(3, "GeForce B", DeviceKind::discrete)};
}

std::string error_of(const std::function<void()>& call, ExitCode code) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(static_cast<int>(error.code), static_cast<int>(code));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

TEST(HostDevice, ListSaysWhatEachCanDo) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty());
  for (std::size_t i = 0; i < devices.size(); i++) {
    EXPECT_EQ(devices[i].index, i);
    EXPECT_FALSE(devices[i].name.empty());
    EXPECT_FALSE(devices[i].driver.empty());
    if (devices[i].unusable.empty()) {
      // the least that Vulkan 1.3 promises
      EXPECT_EQ(devices[i].uuid.size(), 32u);
      EXPECT_GE(devices[i].max_storage_range, 1u << 27);
      EXPECT_GE(devices[i].max_allocation, 1u << 30);
      EXPECT_GE(devices[i].max_uniform_range, 1u << 14);
      EXPECT_GE(devices[i].max_group_invocations, 128u);
      EXPECT_GE(devices[i].max_storage_buffers, 4u);
      for (const std::uint32_t size : devices[i].max_group_size) EXPECT_GE(size, 64u);
      EXPECT_EQ(std::ranges::count(devices[i].conformance, '.'), 3) << devices[i].conformance;
      EXPECT_GE(devices[i].max_group_count[0], 65535u);
      EXPECT_GE(devices[i].subgroup_size, 1u);
      EXPECT_GT(devices[i].memory, 0u);
    }
  }
}

TEST(HostDevice, ChoosesDiscreteBeforeIntegratedBeforeCpu) {
  std::vector<DeviceInfo> devices = made_up_devices();
  EXPECT_EQ(choose_device(devices, "vulkan").index, 2u);
  EXPECT_EQ(choose_device(devices, "").index, 2u);
  devices[2].unusable = devices[3].unusable = "too old";
  EXPECT_EQ(choose_device(devices, "vulkan").index, 1u);
  devices.resize(1);
  EXPECT_EQ(choose_device(devices, "vulkan").index, 0u);
}

TEST(HostDevice, ChoosesByPartOfTheNameOrByIndex) {
  const std::vector<DeviceInfo> devices = made_up_devices();
  EXPECT_EQ(choose_device(devices, "LLVMPIPE").index, 0u);
  EXPECT_EQ(choose_device(devices, "geforce b").index, 3u);
  EXPECT_EQ(choose_device(devices, "geforce").index, 2u);
  EXPECT_EQ(choose_device(devices, "vulkan:1").index, 1u);
}

TEST(HostDevice, UnknownNameIsAUsageErrorThatListsThoseThere) {
  const std::vector<DeviceInfo> devices = made_up_devices();
  for (const char* selector : {"radeon", "vulkan:4", "vulkan:", "vulkan:x", "vulkan:-1", "vulkan:1x", "vulkan1"}) {
    const std::string line = error_of([&] { choose_device(devices, selector); }, ExitCode::usage);
    EXPECT_NE(line.find(selector), std::string::npos);
    EXPECT_NE(line.find("vulkan:3 GeForce B"), std::string::npos) << line;
  }
  EXPECT_NE(error_of([&] { choose_device({}, "vulkan"); }, ExitCode::usage).find("no device"), std::string::npos);
  error_of([&] { Device device("no such device"); }, ExitCode::usage);
}

TEST(HostDevice, DeviceThatIsTooOldIsNotTaken) {
  std::vector<DeviceInfo> devices = made_up_devices();
  devices[2].unusable = "its driver has Vulkan 1.1.0, and 1.3 is needed";
  const std::string line = error_of([&] { choose_device(devices, "vulkan:2"); }, ExitCode::usage);
  EXPECT_NE(line.find("1.3 is needed"), std::string::npos);
  EXPECT_EQ(choose_device(devices, "geforce").index, 3u);
}

TEST(HostDevice, OpensTheOneAskedFor) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty());
  const DeviceInfo& last = devices.back();
  Device device("vulkan:" + std::to_string(last.index));
  EXPECT_EQ(device.info().name, last.name);
  EXPECT_EQ(device.info().uuid, last.uuid);
  device.wait_idle();
  Device second(last.name);  // beside the first
  EXPECT_EQ(second.info().name, last.name);
  device = std::move(second);
  device.wait_idle();
}

TEST(HostDevice, MissingLoaderIsOneLineWithRemedy) {
  DeviceOptions options;
  options.loader = "/nonexistent/libvulkan.so.1";
  for (const auto& call :
       {std::function([&] { list_devices(options); }), std::function([&] { Device device("vulkan", options); })}) {
    const std::string line = error_of(call, ExitCode::failure);
    EXPECT_NE(line.find("no Vulkan loader"), std::string::npos) << line;
    EXPECT_NE(line.find("install mesa-vulkan-drivers and libvulkan1"), std::string::npos) << line;
  }
}

// Another process: the loader reads its environment and drivers once.
TEST(HostDeviceDeathTest, MissingDriverIsOneLineWithRemedy) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const auto& [variable, is_nvidia] : {std::pair{"VK_DRIVER_FILES", true}, {"VK_ICD_FILENAMES", false}}) {
    EXPECT_EXIT(
        {
          setenv(variable, "/nonexistent", 1);
          if (is_nvidia) setenv("NVIDIA_VISIBLE_DEVICES", "all", 1);
          try {
            list_devices();
          } catch (const Error& error) {
            std::fprintf(stderr, "%s\n", error.what());
            std::_Exit(static_cast<int>(error.code));
          }
          std::_Exit(0);
        },
        testing::ExitedWithCode(3),
        std::string("^no Vulkan driver in .") + variable + ": install mesa-vulkan-drivers and libvulkan1" +
            (is_nvidia ? "; for NVIDIA's, start the container with NVIDIA_DRIVER_CAPABILITIES=all\n" : "\n"));
  }
}

TEST(HostDeviceDeathTest, MissingValidationLayerIsAnError) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("VK_LAYER_PATH", "/nonexistent", 1);
        DeviceOptions options;
        options.validation = true;
        try {
          list_devices(options);
        } catch (const Error& error) {
          std::fprintf(stderr, "%s\n", error.what());
          std::_Exit(static_cast<int>(error.code));
        }
        std::_Exit(0);
      },
      testing::ExitedWithCode(3), "^the validation layer .* install vulkan-validationlayers");
}

}  // namespace
}  // namespace wholehand::host
