// SPDX-License-Identifier: MIT
// sanitizers: address
#include "host/buffer.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/vulkan_listener.h"

namespace wholehand::host {
namespace {

class HostBuffer : public testing::TestWithParam<bool> {  // unified memory, or staged as for a discrete GPU
 protected:
  Device device{"vulkan", {.unified_memory = GetParam()}};
};

TEST_P(HostBuffer, ReadsBackWhatWasWritten) {
  for (const std::size_t count : {1, 5, 1000, 100003}) {
    std::vector<double> values(count);
    std::iota(values.begin(), values.end(), 0.25);
    const Buffer buffer = Buffer::of(device, values);
    EXPECT_EQ(buffer.size(), count * sizeof(double));
    EXPECT_EQ(buffer.read_as<double>(count), values);
  }
}

TEST_P(HostBuffer, WritesPartOfIt) {
  Buffer buffer = Buffer::of(device, std::vector<int>{1, 2, 3, 4});
  buffer.write(std::vector<int>{7, 8});
  EXPECT_EQ(buffer.read_as<int>(4), (std::vector<int>{7, 8, 3, 4}));
  EXPECT_EQ(buffer.read_as<int>(3), (std::vector<int>{7, 8, 3}));
}

// Small buffers of one device share its memory.
TEST_P(HostBuffer, SmallOnesKeepTheirContentsWhileOthersComeAndGo) {
  const auto values_of = [](std::size_t i) { return std::vector<std::size_t>(1 + i * 37 % 900, i); };
  std::vector<Buffer> buffers(1000);
  for (std::size_t i = 0; i < buffers.size(); ++i) buffers[i] = Buffer::of(device, values_of(i));
  for (std::size_t i = 0; i < buffers.size(); i += 3) buffers[i] = Buffer();
  for (std::size_t i = 0; i < buffers.size(); i += 3) buffers[i] = Buffer::of(device, values_of(i));
  for (std::size_t i = 0; i < buffers.size(); ++i)
    ASSERT_EQ(buffers[i].read_as<std::size_t>(values_of(i).size()), values_of(i)) << i;
}

TEST_P(HostBuffer, MayBeEmpty) {
  const Buffer buffer = Buffer::of(device, std::vector<float>());
  EXPECT_EQ(buffer.size(), 0u);
  EXPECT_TRUE(buffer.read_as<float>(0).empty());
  EXPECT_EQ(Buffer().size(), 0u);
}

TEST_P(HostBuffer, DeviceMemoryIsMappedOnlyWhereItIsUnified) {
  EXPECT_EQ(Buffer(device, 64).mapped().size(), GetParam() && device.info().unified_memory ? 64u : 0u);
  EXPECT_EQ(Buffer(device, 64, Memory::upload).mapped().size(), 64u);
  EXPECT_EQ(Buffer(device, 64, Memory::readback).mapped().size(), 64u);
}

TEST_P(HostBuffer, MoreThanTheDeviceAllocatesIsOutOfMemory) {
  EXPECT_THROW(Buffer(device, device.info().max_allocation + 1), OutOfMemory);
}

TEST_P(HostBuffer, MoreThanItHoldsIsAnError) {
  Buffer buffer(device, 8);
  std::vector<std::byte> bytes(9);
  EXPECT_THROW(buffer.write(bytes), Error);
  EXPECT_THROW(buffer.read(bytes), Error);
}

INSTANTIATE_TEST_SUITE_P(, HostBuffer, testing::Bool(), [](const auto& which) { return which.param ? "Unified" : "Staged"; });

}  // namespace
}  // namespace wholehand::host
