// SPDX-License-Identifier: MIT
// sanitizers: address
#include "host/specialize.h"

#include <gtest/gtest.h>

#include <bit>
#include <string>

#include "host/spirv.h"
#include "host/spirv_codes.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand::host {
namespace {

using Words = std::vector<std::uint32_t>;

template <class Do>
void for_each(std::span<const std::uint32_t> words, Do&& take) {
  for (std::size_t at = SPIRV_HEADER; at < words.size(); at += words[at] >> 16)
    take(words[at] & 0xFFFF, words.subspan(at, words[at] >> 16));
}

std::size_t count_of(std::span<const std::uint32_t> words, std::uint32_t wanted) {
  std::size_t count = 0;
  for_each(words, [&](std::uint32_t op, std::span<const std::uint32_t>) { count += op == wanted; });
  return count;
}

TEST(HostSpecialize, ConstantsAreNumbersThen) {
  const auto shader = test_shader("host_scale");
  const Words module = specialized(shader, {{0, 32}, {1, std::bit_cast<std::uint32_t>(2.5f)}, {3, 1}, {99, 7}}, {32, 1, 1});
  EXPECT_EQ(count_of(shader, OpSpecConstant), 4u) << "the group's size twice, FACTOR and OFFSET";
  for (const std::uint32_t op : {OpSpecConstant, OpSpecConstantTrue, OpSpecConstantFalse, OpSpecConstantComposite})
    EXPECT_EQ(count_of(module, op), 0u);
  const ShaderInterface result = read_interface(module, "host_scale");
  EXPECT_TRUE(result.constants.empty());
  EXPECT_EQ(result.group_size[0], 32u);
  EXPECT_EQ(result.bindings.size(), 2u);
  bool has_factor = false;
  for_each(module, [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    has_factor |= op == OpConstant && code[3] == std::bit_cast<std::uint32_t>(2.5f);
  });
  EXPECT_TRUE(has_factor);
}

// AMDVLK before 2023-10 took the ids of LocalSizeId for the size itself.
TEST(HostSpecialize, TheGroupsSizeBecomesNumbers) {
  const auto shader = test_shader("host_scale");
  ASSERT_EQ(count_of(shader, OpExecutionModeId), 1u);
  const Words module = specialized(shader, {}, {32, 1, 1});
  EXPECT_EQ(count_of(module, OpExecutionModeId), 0u);
  std::vector<Words> modes;
  for_each(module, [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    if (op == OpExecutionMode) modes.emplace_back(code.begin() + 2, code.end());
  });
  EXPECT_EQ(modes, (std::vector<Words>{{MODE_LOCAL_SIZE, 32, 1, 1}}));
}

TEST(HostSpecialize, KeptWidthsAreDeclaredOnceEach) {
  const std::vector<std::uint32_t> widths{32, 64};
  const Words module = specialized(test_shader("host_scale", 1), {}, {32, 1, 1}, widths);
  std::size_t capabilities = 0;
  std::vector<std::uint32_t> declared;
  for_each(module, [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    capabilities += op == OpCapability && code[1] == CAPABILITY_KEEPS_SPECIALS;
    if (op == OpExecutionMode && code[2] == MODE_KEEPS_SPECIALS) declared.push_back(code[3]);
  });
  EXPECT_EQ(capabilities, 1u);
  EXPECT_EQ(declared, widths);
}

TEST(HostSpecialize, AllBitsOfADoubleAreKept) {
  const auto third = std::bit_cast<std::uint64_t>(1.0 / 3);
  std::size_t found = 0;
  for_each(specialized(test_shader("host_scale", 1), {{1, third}}, {32, 1, 1}), [&](std::uint32_t op,
                                                                                    std::span<const std::uint32_t> code) {
    found += op == OpConstant && code.size() == 5 && code[3] == std::uint32_t(third) && code[4] == std::uint32_t(third >> 32);
  });
  EXPECT_EQ(found, 1u);
}

}  // namespace
}  // namespace wholehand::host
