// SPDX-License-Identifier: MIT
#include "tests/support/vulkan_listener.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "host/device.h"

namespace wholehand {
namespace {

void fail_for_messages() {
  for (const std::string& message : host::take_validation_messages()) {
    ADD_FAILURE() << "validation layer: " << message;
  }
}

class Listener : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo&) override { fail_for_messages(); }
};

// What is destroyed after the last test.
class Environment : public testing::Environment {
  void TearDown() override { fail_for_messages(); }
};

}  // namespace

bool install_vulkan_listener() {
  setenv("WHOLEHAND_VALIDATION", "1", 0);
  testing::UnitTest::GetInstance()->listeners().Append(new Listener);  // both are owned by gtest
  testing::AddGlobalTestEnvironment(new Environment);
  return true;
}

}  // namespace wholehand
