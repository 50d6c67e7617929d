// SPDX-License-Identifier: MIT
// A device that is not done in time. Memory that it may still use is never freed: the leak sanitizer would report that.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <thread>

#include "host/compile.h"
#include "host/run_once.h"
#include "host/shaders.h"
#include "shaders/layout.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand::host {
namespace {

// The program waits for a hung device no longer than asked, and frees nothing that the device may still use: neither waits for it.
TEST(HungDevice, IsLeftBehind) {
  constexpr std::size_t INVOCATIONS = 1 << 20, DISPATCHES = 100;
  const volatile std::uint32_t* counter = nullptr;
  DeviceOptions options;
  options.wait_seconds = 0.001;
  try {
    const Device device("vulkan", options);
    const Kernel count(device, test_shader("host_count"), {}, "host_count");
    const Buffer buffer(device, sizeof(std::uint32_t));
    if (!buffer.mapped().empty()) {
      // new memory holds anything, and the device may not have cleared it yet when the wait ends
      std::fill(buffer.mapped().begin(), buffer.mapped().end(), std::byte{0});
      counter = reinterpret_cast<const std::uint32_t*>(buffer.mapped().data());
    }
    Commands commands;
    commands.bind(2, buffer);
    commands.clear(2);
    for (std::size_t i = 0; i < DISPATCHES; i++) commands.dispatch(count, groups_for(device, count, INVOCATIONS));
    run_once(device, commands);
    ADD_FAILURE() << "it finished in time";
  } catch (const DeviceLost& error) {
    EXPECT_TRUE(error.hung);
  }
  if (!counter) return;  // only a CPU's memory can be read here
  EXPECT_LT(*counter, INVOCATIONS * DISPATCHES) << "its end was waited for";
  for (int i = 0; i < 6000 && *counter < INVOCATIONS * DISPATCHES; i++) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(*counter, INVOCATIONS * DISPATCHES) << "it went on after its buffer was freed";
}

// A driver that completes no kernel in time keeps its device and its threads; another device works meanwhile.
TEST(HungDevice, ThatCompilesForTooLongIsLeftBehind) {
  // the longest there is: seconds of work, and what is left at the end is done before the last line
  const KernelRequest request{"effort", find_shader("effort", Precision::single), {{CONST_GROUP_SIZE, std::uint32_t(GROUP_SIZE)}}};
  DeviceOptions options;
  options.wait_seconds = 0;
  try {
    Device device("vulkan", options);
    compile(device, options, std::vector<KernelRequest>(16, request));
    ADD_FAILURE() << "it finished in time";
  } catch (const DeviceLost& error) {
    EXPECT_TRUE(error.hung);
    EXPECT_NE(std::string(error.what()).find("of 16 kernels, and no further one within 0 s"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(has_abandoned_devices());
  Device another;
  EXPECT_EQ(compile(another, {}, {request}).size(), 1u);
}

}  // namespace
}  // namespace wholehand::host
