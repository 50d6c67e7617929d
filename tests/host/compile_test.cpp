// SPDX-License-Identifier: MIT
// sanitizers: thread
#include "host/compile.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/run_once.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand::host {
namespace {

KernelRequest scale_by(float factor) {
  return {"scale by " + std::to_string(factor), test_shader("host_scale"), {{0, 64u}, {1, factor}}};
}

TEST(Compile, KernelsComeInTheOrderOfTheRequestsReadyToRun) {
  Device device;
  std::vector<KernelRequest> requests;
  for (int k = 0; k < 8; ++k) requests.push_back(scale_by(static_cast<float>(k)));
  const std::vector<Kernel> kernels = compile(device, {}, requests);
  ASSERT_EQ(kernels.size(), requests.size());
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    EXPECT_EQ(kernels[k].name(), requests[k].name);
    const Buffer in = Buffer::of(device, std::vector<float>{3}), out(device, 2 * sizeof(float));
    Commands commands;
    commands.bind(0, in);
    commands.bind(1, out);
    commands.dispatch(kernels[k], {1, 1, 1}, ScalePush{1, 1, 0});
    run_once(device, commands);
    EXPECT_EQ(out.read_as<float>(1)[0], 3 * static_cast<float>(k));
  }
}

TEST(Compile, TheWatchSeesKernelsGetDoneUpToTheLast) {
  Device device;
  std::vector<std::size_t> seen;
  const auto watch = [&](const DeviceInfo& on, std::size_t done, std::size_t count) {
    EXPECT_EQ(on.name, device.info().name);
    EXPECT_EQ(count, 3u);
    seen.push_back(done);
  };
  compile(device, {}, {scale_by(1), scale_by(2), scale_by(3)}, watch);
  EXPECT_TRUE(std::ranges::is_sorted(seen));
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back(), 3u);
}

TEST(Compile, OneRequestThatIsRefusedEndsAll) {
  Device device;
  KernelRequest wrong = scale_by(2);
  wrong.constants.back().value = 2;  // an integer for a real
  try {
    compile(device, {}, {scale_by(1), wrong, scale_by(3)});
    ADD_FAILURE() << "it was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("specialization constant 1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace wholehand::host
