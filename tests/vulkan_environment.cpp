// SPDX-License-Identifier: MIT
// Linked into all tests: devices are opened in the environment that the program gives them.
#include "app/program/vulkan_environment.h"

#include <gtest/gtest.h>

namespace wholehand {
namespace {

class VulkanEnvironment : public testing::Environment {
  void SetUp() override { prepare_vulkan_environment(); }
};

[[maybe_unused]] testing::Environment* const prepared = testing::AddGlobalTestEnvironment(new VulkanEnvironment);  // owned by gtest

}  // namespace
}  // namespace wholehand
