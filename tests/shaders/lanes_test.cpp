// SPDX-License-Identifier: MIT
// What a benchmark counts of a kernel's lanes, and that the program's own kernels count nothing.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>

#include "host/shaders.h"
#include "host/spirv.h"
#include "shaders/layout.h"
#include "tests/support/lane_probe.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand {
namespace {

bool counts(std::span<const std::uint32_t> words) {
  const host::ShaderInterface shader = host::read_interface(words, "a shader");
  return std::ranges::any_of(shader.bindings, [](const auto& binding) { return binding.binding == BINDING_LANES; });
}

TEST(Lanes, ThoseOfALoopThatTheyLeaveOneByOne) {
  const host::Device on;
  const LaneCounts counted = counted_lanes(on), expected = expected_lanes(on);
  EXPECT_EQ(counted.useful, expected.useful);
  EXPECT_EQ(counted.all, expected.all);
}

TEST(Lanes, TheProgramsOwnKernelsCountNone) {
  EXPECT_TRUE(counts(test_shader("probe_lanes")));
  ASSERT_FALSE(embedded_shaders().empty());
  for (const EmbeddedShader& shader : embedded_shaders()) EXPECT_FALSE(counts(shader.words)) << shader.name;
}

}  // namespace
}  // namespace wholehand
