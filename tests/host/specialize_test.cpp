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

// What names and decorations are of is there, and a value comes to a phi from every block that goes to it and from no other.
void expect_sound(std::span<const std::uint32_t> words, const std::string& what) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;              // from and to
  std::vector<std::pair<std::uint32_t, std::set<std::uint32_t>>> phis;  // where, and from where
  std::set<std::uint32_t> labels, used, wanted;
  bool has_switch = false;
  std::uint32_t block = 0;
  for_each(words, [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    if (op == OpLabel) labels.insert(block = code[1]);
    has_switch |= op == OpSwitch;
    if (op == OpBranch) edges.emplace(block, code[1]);
    if (op == OpBranchConditional) edges.insert({{block, code[2]}, {block, code[3]}});
    if (op == OpPhi) phis.push_back({block, {}});
    for (std::size_t k = 4; op == OpPhi && k < code.size(); k += 2) phis.back().second.insert(code[k]);
    const bool is_about = op == OpName || op == OpDecorate;
    if (is_about) wanted.insert(code[1]);
    if (!is_about) used.insert(code.begin() + 1, code.end());
  });
  for (const auto& [from, to] : edges) EXPECT_TRUE(labels.contains(to)) << what << ": " << from << " goes to " << to;
  for (const std::uint32_t id : wanted) EXPECT_TRUE(used.contains(id)) << what << ": words on " << id;
  if (has_switch) return;  // its edges are not read here
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

TEST(HostSpecialize, AllBitsOfADoubleAreKept) {
  const auto third = std::bit_cast<std::uint64_t>(1.0 / 3);
  std::size_t found = 0;
  for_each(specialized(test_shader("host_scale", 1), {{1, third}}), [&](std::uint32_t op, std::span<const std::uint32_t> code) {
    found += op == OpConstant && code.size() == 5 && code[3] == std::uint32_t(third) && code[4] == std::uint32_t(third >> 32);
  });
  EXPECT_EQ(found, 1u);
}

// Lattices, poses and planes that a scene does not have are more than a third of the kernel of grips.
TEST(HostSpecialize, WhatIsSwitchedOffIsLeftOut) {
  const auto grip = find_shader("grip", Precision::single, OUTLINE_SPECIALIZED);
  const Words outline = specialized(grip, {{CONST_SDF_KIND, SDF_OUTLINE}, {CONST_OUTLINE_COUNT, 3}});
  EXPECT_LT(outline.size(), grip.size() * 2 / 3);
  SpecializationBits all{{CONST_SDF_KIND, SDF_LATTICE}, {CONST_TABLE, 1}, {CONST_BETWEEN, 2}, {CONST_CONTACTS, 0}};
  for (std::uint32_t f = 0; f < FIELDS; ++f) all[CONST_PLANE + f] = f;
  EXPECT_GT(specialized(grip, all).size(), outline.size());
}

TEST(HostSpecialize, EveryShaderStaysSound) {
  for (const EmbeddedShader& shader : embedded_shaders()) {
    const std::string name = std::string(shader.name) + (shader.precision ? ", double" : ", float");
    SpecializationBits all{{CONST_TABLE, 1}, {CONST_BETWEEN, 2}, {CONST_CONTACTS, 0}, {CONST_EFFORT_TASK, EFFORT_FRICTION}};
    for (std::uint32_t f = 0; f < FIELDS; ++f) all[CONST_PLANE + f] = f;
    for (const SpecializationBits& bits : {SpecializationBits{}, all, SpecializationBits{{CONST_POSE, POSE_RIGGED}}}) {
      const Words module = specialized(shader.words, bits);
      EXPECT_LT(module.size(), shader.words.size()) << name << ": nothing was left out";
      EXPECT_EQ(count_of(module, OpSpecConstant), 0u) << name;
      EXPECT_NO_THROW(read_interface(module, name));
      expect_sound(module, name);
    }
  }
}

}  // namespace
}  // namespace wholehand::host
