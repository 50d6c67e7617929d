// SPDX-License-Identifier: MIT
// The shaders that the binaries carry: every variant there, in order, and each valid by spirv-val's judgement.
// sanitizers: none
#include "host/shaders.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "host/specialize.h"
#include "shaders/layout.h"
#include "tests/shaders/probe_shaders.h"

namespace wholehand {
namespace {

using Variant = std::tuple<int, int, int>;  // precision, build, outline source

std::string label(const EmbeddedShader& shader) {
  return std::string(shader.name) + " precision " + std::to_string(shader.precision) + " build " + std::to_string(shader.build) +
         " outline " + std::to_string(shader.outline_source);
}

// Every shader in float and in double, in the builds that it has, with no outline or with all sources of it; sorted.
void expect_every_variant(std::span<const EmbeddedShader> shaders, bool is_wide_alone) {
  std::map<std::string, std::set<Variant>> variants;
  const auto key = [](const EmbeddedShader& s) { return Variant(s.precision, s.build, s.outline_source); };
  for (const EmbeddedShader& shader : shaders) variants[std::string(shader.name)].insert(key(shader));
  const auto is_right = [&](std::set<Variant> found, std::set<Variant> wanted) {
    if (is_wide_alone) std::erase_if(wanted, [](const Variant& variant) { return std::get<1>(variant) == BUILD_SMALL; });
    return found == wanted;
  };
  const std::set<Variant> plain = {{0, -1, -1}, {1, -1, -1}};
  const std::set<Variant> built = {{0, 0, -1}, {0, 1, -1}, {1, 0, -1}, {1, 1, -1}};
  const std::set<Variant> outlined = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {1, 0, 1}, {1, 1, 0}};
  std::size_t count = 0;
  for (const auto& [name, found] : variants) {
    EXPECT_TRUE(is_right(found, plain) || is_right(found, built) || is_right(found, outlined))
        << name << " has " << found.size() << " variants";
    count += found.size();
  }
  EXPECT_EQ(count, shaders.size());
  for (std::size_t i = 1; i < shaders.size(); ++i)
    EXPECT_LT(std::tuple(shaders[i - 1].name, key(shaders[i - 1])), std::tuple(shaders[i].name, key(shaders[i])))
        << label(shaders[i]);
}

// What spirv-val says of the words; empty: nothing.
std::string complaints(std::span<const std::uint32_t> words) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / ("wholehand-" + std::to_string(getpid()) + ".spv");
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return "cannot write " + path.string();
  const std::size_t written = std::fwrite(words.data(), sizeof(words[0]), words.size(), file);
  std::fclose(file);
  if (written != words.size()) return "cannot write " + path.string();
  std::string output;
  std::FILE* pipe = popen(("spirv-val --target-env vulkan1.3 '" + path.string() + "' 2>&1").c_str(), "r");
  std::array<char, 512> buffer;
  while (pipe && std::fgets(buffer.data(), buffer.size(), pipe)) output += buffer.data();
  const int status = pipe ? pclose(pipe) : -1;
  std::filesystem::remove(path);
  if (status != 0) return "spirv-val ended with " + std::to_string(status) + ": " + output;
  return output;
}

void expect_valid(std::span<const EmbeddedShader> shaders) {
  EXPECT_FALSE(shaders.empty());
  for (const EmbeddedShader& shader : shaders) EXPECT_EQ(complaints(shader.words), "") << label(shader);
}

TEST(Shaders, EveryVariantIsEmbedded) {
  expect_every_variant(embedded_shaders(), false);
  expect_every_variant(probe_shaders(), true);
}

TEST(Shaders, ProductIsValidSpirv) { expect_valid(embedded_shaders()); }

TEST(Shaders, ProbesAreValidSpirv) { expect_valid(probe_shaders()); }

TEST(Shaders, DamagedWordsAreNotValid) {
  ASSERT_FALSE(embedded_shaders().empty());
  const std::span<const std::uint32_t> words = embedded_shaders()[0].words;
  EXPECT_NE(complaints(words.first(words.size() / 2)), "");
}

// As kernels give them to a driver: with the constants of a scene.
TEST(Shaders, SpecializedOnesAreValid) {
  host::SpecializationBits all{{CONST_GROUP_SIZE, 64}, {CONST_TABLE, 1},    {CONST_BETWEEN, 2},
                               {CONST_ARM, 24},        {CONST_CONTACTS, 0}, {CONST_EFFORT_TASK, EFFORT_WORST}};
  for (std::uint32_t f = 0; f < FIELDS; ++f) all[CONST_PLANE + f] = f;
  const host::SpecializationBits few{{CONST_OUTLINE_COUNT, 3}, {CONST_SDF_KIND, SDF_OUTLINE}, {CONST_PLANE + FIELD_SCORE, 0}};
  for (const EmbeddedShader& shader : embedded_shaders()) {
    const std::vector<std::uint32_t> widths = shader.precision == 0 ? std::vector{32u} : std::vector{32u, 64u};
    for (const host::SpecializationBits& bits : {all, few})
      EXPECT_EQ(complaints(host::specialized(shader.words, bits, {64, 1, 1}, widths)), "") << label(shader);
  }
}

}  // namespace
}  // namespace wholehand
