// SPDX-License-Identifier: MIT
// sanitizers: address
#include "host/spirv.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/text/error.h"
#include "host/grip_backend.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand::host {
namespace {

TEST(HostSpirv, InterfaceIsReadFromTheShader) {
  const ShaderInterface shader = read_interface(test_shader("host_scale", 1), "host_scale");
  ASSERT_EQ(shader.bindings.size(), 2u);  // and not the unused one
  EXPECT_EQ(shader.bindings[0].binding, 0u);
  EXPECT_EQ(shader.bindings[1].binding, 1u);
  EXPECT_EQ(shader.constants.at(0), ConstantKind::uint32);
  EXPECT_EQ(shader.constants.at(1), ConstantKind::float64);
  EXPECT_EQ(shader.constants.at(2), ConstantKind::int32);
  EXPECT_EQ(shader.constants.at(3), ConstantKind::boolean);
  EXPECT_EQ(shader.group_size_id[0], 0u);
  EXPECT_TRUE(shader.float64);

  const ShaderInterface other = read_interface(test_shader("host_neighbors"), "host_neighbors");
  ASSERT_EQ(other.bindings.size(), 3u);
  EXPECT_EQ(other.bindings[2].kind, BindingKind::uniform);
  EXPECT_EQ(other.group_size, (std::array<std::uint32_t, 3>{64, 1, 1}));
  EXPECT_EQ(other.group_size_id[0], ShaderInterface::NO_ID);
  EXPECT_FALSE(other.float64);

  const ShaderInterface contact = read_interface(find_shader("contact", Precision::single, BUILD_WIDE, OUTLINE_COPIED), "contact");
  const auto lattice = std::ranges::find(contact.bindings, std::uint32_t{BINDING_LATTICE}, &ShaderBinding::binding);
  ASSERT_NE(lattice, contact.bindings.end());
  EXPECT_EQ(lattice->kind, BindingKind::texels);
}

TEST(HostSpirv, DamagedShaderIsAnError) {
  const auto words = test_shader("host_scale");
  std::vector<std::uint32_t> cut(words.begin(), words.end() - 1), half(words.begin(), words.begin() + words.size() / 2),
      zero(words.begin(), words.end()), none;
  zero[5] = 0;
  for (const auto& damaged : {cut, half, zero, none}) {
    EXPECT_THROW(read_interface(damaged, "damaged"), Error);
  }
}

}  // namespace
}  // namespace wholehand::host
