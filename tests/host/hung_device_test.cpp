// SPDX-License-Identifier: MIT
// A device that is not done in time. Memory that it may still use is never freed: the leak sanitizer would report that.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <thread>

#include "host/run_once.h"
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

}  // namespace
}  // namespace wholehand::host
