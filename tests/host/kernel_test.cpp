// SPDX-License-Identifier: MIT
// sanitizers: address
#include "host/kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "host/run_once.h"
#include "tests/shaders/probe_shaders.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand::host {
namespace {

using Constants = std::vector<Constant>;

class HostKernel : public testing::Test {
 protected:
  Device device;

  template <class Real>
  std::vector<Real> scale(const Constants& constants, const std::vector<Real>& values) {
    const Kernel kernel(device, test_shader("host_scale", sizeof(Real) == 8), constants, "host_scale");
    const Buffer in = Buffer::of(device, values), out(device, 2 * values.size() * sizeof(Real));
    const auto count = static_cast<std::uint32_t>(values.size());
    Commands commands;
    commands.bind(0, in);
    commands.bind(1, out);
    commands.dispatch(kernel, groups_for(device, kernel, count), ScalePush{count, count, 0});
    EXPECT_GT(run_once(device, commands), 0);
    return out.template read_as<Real>(values.size());
  }
};

TEST_F(HostKernel, CountsThatAreNoMultipleOfTheGroup) {
  for (const std::size_t count : {1, 63, 64, 65, 1000}) {
    std::vector<float> values(count), expected(count);
    std::iota(values.begin(), values.end(), 0.0f);
    std::ranges::transform(values, expected.begin(), [](float x) { return 3 * x - 7; });
    EXPECT_EQ(scale(Constants{{0, 64u}, {1, 3.0f}, {2, -7}}, values), expected);
  }
}

TEST_F(HostKernel, DoubleConstantKeepsAllItsBits) {
  const double third = 1.0 / 3;
  EXPECT_EQ(scale(Constants{{0, 64u}, {1, third}}, std::vector<double>{1})[0], third);
  EXPECT_EQ(scale(Constants{{0, 64u}, {1, third}}, std::vector<float>{1})[0], static_cast<float>(third));
  EXPECT_EQ(scale(Constants{{0, 64u}, {1, 0.1f}}, std::vector<double>{1})[0], static_cast<double>(0.1f));
}

TEST_F(HostKernel, ConstantsHaveTheirDefaultsAndUnknownOnesAreIgnored) {
  EXPECT_EQ(scale(Constants{{0, 32u}}, std::vector<float>{5})[0], 5);
  EXPECT_EQ(scale(Constants{{0, 32u}, {3, 1}}, std::vector<float>{5})[0], -5);
  EXPECT_EQ(scale(Constants{{0, 32}, {99, 1.0}}, std::vector<float>{5})[0], 5);
}

TEST_F(HostKernel, ConstantOfTheWrongKindIsAnError) {
  EXPECT_THROW(scale(Constants{{0, 64u}, {1, 3}}, std::vector<float>{5}), Error);
  EXPECT_THROW(scale(Constants{{0, 64.0f}}, std::vector<float>{5}), Error);
}

TEST_F(HostKernel, GroupLargerThanTheDeviceTakesIsAnError) {
  EXPECT_THROW(scale(Constants{{0, device.info().max_group_invocations + 1}}, std::vector<float>{5}), Error);
  EXPECT_THROW(scale(Constants{{0, 0u}}, std::vector<float>{5}), Error);
}

TEST_F(HostKernel, MoreGroupsThanFitOneAxisGoAlongTheSecond) {
  const Kernel kernel(device, test_shader("host_scale"), Constants{{0, 1u}}, "host_scale");
  const std::uint32_t width = device.info().max_group_count[0];
  EXPECT_EQ(groups_for(device, kernel, 0), (std::array<std::uint32_t, 3>{1, 0, 1}));
  EXPECT_EQ(groups_for(device, kernel, width), (std::array<std::uint32_t, 3>{width, 1, 1}));
  if (width == 65535) {  // lavapipe's; many GPUs take 2^31
    std::vector<float> values(width + 3);
    std::iota(values.begin(), values.end(), 0.0f);
    EXPECT_EQ(groups_for(device, kernel, values.size()), (std::array<std::uint32_t, 3>{width, 2, 1}));
    EXPECT_EQ(scale(Constants{{0, 1u}}, values), values);
  }
}

TEST_F(HostKernel, StepsSeeWhatThoseBeforeWrote) {
  constexpr std::uint32_t COUNT = 5000;
  const Kernel first(device, test_shader("host_scale"), Constants{{0, 64u}, {1, 2.0f}}, "host_scale");
  const Kernel second(device, test_shader("host_neighbors"), {}, "host_neighbors");
  std::vector<float> values(COUNT);
  std::iota(values.begin(), values.end(), 1.0f);
  const Buffer in = Buffer::of(device, values), scratch(device, 2 * COUNT * sizeof(float)), out(device, COUNT * sizeof(float));
  const Buffer weights = Buffer::of(device, std::vector<float>{1, 10, 0, 0});
  Commands commands;
  commands.bind(3, weights);
  commands.bind(0, in);
  commands.bind(1, scratch);
  commands.dispatch(first, groups_for(device, first, COUNT), ScalePush{COUNT, COUNT, 0});
  commands.bind(0, scratch);
  commands.bind(1, out);
  commands.dispatch(second, groups_for(device, second, COUNT), COUNT);
  for (int repeat = 0; repeat < 3; repeat++) {
    run_once(device, commands);
    const std::vector<float> results = out.read_as<float>(COUNT);
    for (std::uint32_t i = 0; i < COUNT; i++) {
      ASSERT_EQ(results[i], 2 * values[(i + COUNT - 1) % COUNT] + 20 * values[(i + 1) % COUNT]) << i;
    }
  }
}

TEST_F(HostKernel, ClearZeroesBetweenSteps) {
  const Kernel kernel(device, test_shader("host_count"), {}, "host_count");
  const Buffer counter = Buffer::of(device, std::vector<std::uint32_t>{12345});
  Commands commands;
  commands.bind(2, counter);
  commands.dispatch(kernel, {7, 1, 1});
  commands.clear(2);
  commands.dispatch(kernel, {2, 3, 1});
  run_once(device, commands);
  EXPECT_EQ(counter.read_as<std::uint32_t>(1)[0], 6u * 64);
}

TEST_F(HostKernel, AStepByItselfIsWhatItWasAmongTheOthers) {
  const Kernel kernel(device, test_shader("host_count"), {}, "host_count");
  const Buffer counter = Buffer::of(device, std::vector<std::uint32_t>{5});
  Commands commands;
  commands.bind(2, counter);
  commands.dispatch(kernel, {7, 1, 1});
  commands.clear(2);
  commands.dispatch(kernel, {2, 3, 1});
  const auto count_after = [&](std::size_t step) {
    run_once(device, commands.only(step));
    return counter.read_as<std::uint32_t>(1)[0];
  };
  EXPECT_EQ(count_after(0), 5u + 7 * 64);
  EXPECT_EQ(count_after(2), 5u + 13 * 64);
  EXPECT_EQ(count_after(1), 0u);
  EXPECT_EQ(commands.steps().size(), 3u);
}

TEST_F(HostKernel, NothingToDoIsDone) { EXPECT_GE(run_once(device, Commands()), 0); }

TEST_F(HostKernel, MissingBindingIsAnError) {
  const Kernel kernel(device, test_shader("host_scale"), {}, "host_scale");
  EXPECT_TRUE(kernel.uses(0));
  EXPECT_FALSE(kernel.uses(5));
  const Buffer in(device, 64);
  Commands commands;
  commands.bind(0, in);
  try {
    commands.dispatch(kernel, {1, 1, 1}, ScalePush{});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("nothing is bound at 1"), std::string::npos) << error.what();
  }
}

TEST_F(HostKernel, BufferBeyondTheDevicesRangeIsAnError) {
  const Kernel kernel(device, test_shader("host_neighbors"), {}, "host_neighbors");
  const Buffer small(device, 64), large(device, device.info().max_uniform_range + 16);
  Commands commands;
  commands.bind(0, small);
  commands.bind(1, small);
  commands.bind(3, large);
  EXPECT_THROW(commands.dispatch(kernel, {1, 1, 1}), Error);
}

// The probe of the same name rounds nothing between a product and its sum.
TEST_F(HostKernel, TellsADriverThatContractsFromOneThatRounds) {
  EXPECT_TRUE(contracted_precisions(device).empty());
  EXPECT_EQ(contracted_precisions(device, probe_shaders()), (std::vector{Precision::single, Precision::full}));
}

// The validation layer is active and heard: this buffer was not created for binding.
TEST_F(HostKernel, MisuseIsToldByTheValidationLayer) {
  const Kernel kernel(device, test_shader("host_count"), {}, "host_count");
  const Buffer staging(device, 64, Memory::upload);
  Commands commands;
  commands.bind(2, staging);
  commands.dispatch(kernel, {1, 1, 1});
  run_once(device, commands);
  const std::vector<std::string> messages = take_validation_messages();
  ASSERT_FALSE(messages.empty());
  EXPECT_NE(messages[0].find("VUID-VkWriteDescriptorSet-descriptorType-00331"), std::string::npos) << messages[0];
}

}  // namespace
}  // namespace wholehand::host
