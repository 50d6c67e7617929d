// SPDX-License-Identifier: MIT
// sanitizers: address
#include "host/specialize.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>
#include <string>

#include "core/backend.h"
#include "host/shaders.h"
#include "host/spirv.h"
#include "host/spirv_codes.h"
#include "shaders/layout.h"
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

// What names and decorations are of is there, a value comes to a phi from every block that goes to it and from no other, and a loop goes back
// to its head.
void expect_sound(std::span<const std::uint32_t> words, const std::string& what) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;              // from and to
  std::vector<std::pair<std::uint32_t, std::set<std::uint32_t>>> phis;  // where, and from where
  std::set<std::uint32_t> labels, used, wanted, heads, repeated;
  std::uint32_t block = 0;
  const auto go = [&](std::uint32_t to) {
    edges.emplace(block, to);
    if (heads.contains(to)) repeated.insert(to);
  };
  for_each(words, [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    if (op == OpLabel) labels.insert(block = code[1]);
    if (op == OpLoopMerge) heads.insert(block);
    if (op == OpBranch) go(code[1]);
    for (const std::size_t k : {2, 3})
      if (op == OpBranchConditional) go(code[k]);
    for (std::size_t k = 2; op == OpSwitch && k < code.size(); k += 2) go(code[k]);
    if (op == OpPhi) phis.push_back({block, {}});
    for (std::size_t k = 4; op == OpPhi && k < code.size(); k += 2) phis.back().second.insert(code[k]);
    const bool is_about = op == OpName || op == OpDecorate;
    if (is_about) wanted.insert(code[1]);
    if (!is_about) used.insert(code.begin() + 1, code.end());
  });
  for (const auto& [from, to] : edges) EXPECT_TRUE(labels.contains(to)) << what << ": " << from << " goes to " << to;
  for (const std::uint32_t id : wanted) EXPECT_TRUE(used.contains(id)) << what << ": words on " << id;
  EXPECT_EQ(repeated, heads) << what << ": loops";
  for (const auto& [at, sources] : phis) {
    std::set<std::uint32_t> expected;
    for (const auto& [from, to] : edges)
      if (to == at) expected.insert(from);
    EXPECT_EQ(sources, expected) << what << ": block " << at;
  }
}

TEST(HostSpecialize, ConstantsAreNumbersThen) {
  const auto shader = test_shader("host_scale");
  const Words module = specialized(shader, {{0, 32}, {1, std::bit_cast<std::uint32_t>(2.5f)}, {3, 1}, {99, 7}});
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
  expect_sound(module, "host_scale");
}

// AMDVLK before 2023-10 took the ids of LocalSizeId for the size itself.
TEST(HostSpecialize, TheGroupsSizeBecomesNumbers) {
  const auto shader = test_shader("host_scale");
  ASSERT_EQ(count_of(shader, OpExecutionModeId), 1u);
  const Words module = specialized(shader, {{0, 32}});
  EXPECT_EQ(count_of(module, OpExecutionModeId), 0u);
  std::vector<Words> modes;
  for_each(module, [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    if (op == OpExecutionMode) modes.emplace_back(code.begin() + 2, code.end());
  });
  EXPECT_EQ(modes, (std::vector<Words>{{MODE_LOCAL_SIZE, 32, 1, 1}}));
}

TEST(HostSpecialize, KeptWidthsAreDeclaredOnceEach) {
  const std::vector<std::uint32_t> widths{32, 64};
  const Words module = specialized(test_shader("host_scale", 1), {{0, 32}}, widths);
  std::size_t capabilities = 0;
  std::vector<std::uint32_t> declared;
  for_each(module, [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    capabilities += op == OpCapability && code[1] == CAPABILITY_KEEPS_SPECIALS;
    if (op == OpExecutionMode && code[2] == MODE_KEEPS_SPECIALS) declared.push_back(code[3]);
  });
  EXPECT_EQ(capabilities, 1u);
  EXPECT_EQ(declared, widths);
  expect_sound(module, "host_scale");
}

TEST(HostSpecialize, AllBitsOfADoubleAreKept) {
  const auto third = std::bit_cast<std::uint64_t>(1.0 / 3);
  std::size_t found = 0;
  for_each(specialized(test_shader("host_scale", 1), {{1, third}}), [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    found += op == OpConstant && code.size() == 5 && code[3] == std::uint32_t(third) && code[4] == std::uint32_t(third >> 32);
  });
  EXPECT_EQ(found, 1u);
}

// Lattices, poses and planes that a scene does not have are more than a third of the kernel of contacts.
TEST(HostSpecialize, WhatIsSwitchedOffIsLeftOut) {
  const auto contact = find_shader("contact", Precision::single, BUILD_WIDE, OUTLINE_COPIED);
  const Words outline = specialized(contact, {{CONST_SDF_KIND, SDF_OUTLINE}, {CONST_OUTLINE_COUNT, 3}});
  EXPECT_LT(outline.size(), contact.size() * 2 / 3);
  SpecializationBits all{{CONST_SDF_KIND, SDF_LATTICE}, {CONST_TABLE, 1}, {CONST_BETWEEN, 2}, {CONST_ARM, 24}, {CONST_CONTACTS, 0}};
  for (std::uint32_t f = 0; f < FIELDS; ++f) all[CONST_PLANE + f] = f;
  EXPECT_GT(specialized(contact, all).size(), outline.size());
}

// A kernel with these blocks that computes nothing. Its ids: 2 a specialization constant (number 0), 3 a type of integers, 4 a constant of it.
Words kernel_of(std::initializer_list<Words> blocks) {
  constexpr std::uint32_t MEMORY_MODEL = 14, TYPE_VOID = 19, TYPE_FUNCTION = 33, COMPUTE = 5, LOCAL_SIZE = 17, MAIN = 0x6E69616D;
  Words words{SPIRV_MAGIC, 0x10300, 0, 100, 0};
  const auto put = [&words](const Words& code) {
    words.push_back(static_cast<std::uint32_t>(code.size()) << 16 | code[0]);
    words.insert(words.end(), code.begin() + 1, code.end());
  };
  for (const Words& code : std::initializer_list<Words>{{OpCapability, 1},
                                                        {MEMORY_MODEL, 0, 1},
                                                        {OpEntryPoint, COMPUTE, 7, MAIN, 0},
                                                        {OpExecutionMode, 7, LOCAL_SIZE, 1, 1, 1},
                                                        {OpDecorate, 2, DECORATION_SPEC_ID, 0},
                                                        {OpTypeBool, 1},
                                                        {OpSpecConstantFalse, 1, 2},
                                                        {OpTypeInt, 3, 32, 0},
                                                        {OpConstant, 3, 4, 0},
                                                        {TYPE_VOID, 5},
                                                        {TYPE_FUNCTION, 6, 5},
                                                        {OpFunction, 5, 7, 0, 6}})
    put(code);
  for (const Words& code : blocks) put(code);
  put({OpFunctionEnd});
  return words;
}

// Block 14 takes a number from block 12, which nothing reaches. A literal of the switch is 14, too.
TEST(HostSpecialize, ALiteralOfASwitchIsNoLabel) {
  const Words kernel = kernel_of({{OpLabel, 10},
                                  {OpSelectionMerge, 11, 0},
                                  {OpBranchConditional, 2, 12, 13},
                                  {OpLabel, 12},
                                  {OpIAdd, 3, 20, 4, 4},
                                  {OpBranch, 14},
                                  {OpLabel, 14},
                                  {OpIAdd, 3, 21, 20, 4},
                                  {OpBranch, 11},
                                  {OpLabel, 13},
                                  {OpSelectionMerge, 15, 0},
                                  {OpSwitch, 4, 15, 14, 16},
                                  {OpLabel, 16},
                                  {OpBranch, 15},
                                  {OpLabel, 15},
                                  {OpBranch, 11},
                                  {OpLabel, 11},
                                  {OpReturn}});
  const Words module = specialized(kernel, {{0, 0}});
  EXPECT_EQ(count_of(module, OpIAdd), 0u);
  EXPECT_EQ(count_of(module, OpLabel), 5u);
  expect_sound(module, "a switch");
}

// do ... while (constant)
TEST(HostSpecialize, ALoopGoesBackToItsHead) {
  const Words kernel = kernel_of({{OpLabel, 10},
                                  {OpBranch, 11},
                                  {OpLabel, 11},
                                  {OpLoopMerge, 12, 13, 0},
                                  {OpBranch, 13},
                                  {OpLabel, 13},
                                  {OpBranchConditional, 2, 11, 12},
                                  {OpLabel, 12},
                                  {OpReturn}});
  expect_sound(kernel, "the loop itself");
  for (const std::uint64_t again : {0, 1}) expect_sound(specialized(kernel, {{0, again}}), again ? "again" : "once");
  EXPECT_EQ(specialized(kernel, {{0, 0}}), kernel) << "left to the driver";
}

TEST(HostSpecialize, EveryShaderStaysSound) {
  for (const EmbeddedShader& shader : embedded_shaders()) {
    const std::string name = std::string(shader.name) + (shader.precision ? ", double" : ", float");
    SpecializationBits all{
        {CONST_TABLE, 1},   {CONST_BETWEEN, 2}, {CONST_ARM, 24}, {CONST_CONTACTS, 0}, {CONST_EFFORT_TASK, EFFORT_FRICTION},
        {CONST_TOGETHER, 4}};
    for (std::uint32_t f = 0; f < FIELDS; ++f) all[CONST_PLANE + f] = f;
    for (const SpecializationBits& bits : {SpecializationBits{}, all, SpecializationBits{{CONST_POSE, POSE_RIGGED}}}) {
      const Words module = specialized(shader.words, bits);
      EXPECT_LT(module.size(), shader.words.size()) << name << ": nothing was left out";
      EXPECT_EQ(count_of(module, OpSpecConstant), 0u) << name;
      EXPECT_EQ(count_of(module, OpExecutionModeId), 0u) << name;
      EXPECT_NO_THROW(read_interface(module, name));
      expect_sound(module, name);
    }
  }
}

}  // namespace
}  // namespace wholehand::host
