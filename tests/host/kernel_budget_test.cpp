// SPDX-License-Identifier: MIT
// Size limits of every kernel. Drivers of GPUs compile the small build. Mesa's driver for AMD makes its pipelines here for chips that are absent
// ("null hardware": nothing runs), and reports what they take.
// sanitizers: none
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <map>
#include <regex>

#include "core/evaluator.h"
#include "core/gather.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "host/grip_program.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"

namespace wholehand {
namespace {

using Words = std::vector<std::uint32_t>;

// Modules as a driver gets them for a sweep of the shipped scenes with all variables, each once, with a label.
std::map<Words, std::string> modules_of(KernelBuild build, const std::vector<std::string>& scenes) {
  std::map<Words, std::string> modules;
  host::GripBackendOptions options;
  options.build = build;
  for (const std::string& name : scenes) {
    const Scene scene = read_scene_file(scenes_dir() + "/" + name + ".toml");
    const auto core = make_core_evaluator(scene);
    const host::GripProgram program(scene, host::make_scene_arrays(scene, *core, {}), all_fields(scene), "vulkan", options);
    for (const host::Kernel* kernel : program.kernels()) modules.emplace(kernel->words(), name + " " + kernel->name());
  }
  return modules;
}

// Words of a module after what any driver does first.
std::uintmax_t reduced_size(const Words& words) {
  const TemporaryFolder folder;
  const std::string from = folder / "module.spv", to = folder / "reduced.spv";
  write_file(from, std::string(reinterpret_cast<const char*>(words.data()), words.size() * sizeof words[0]));
  const std::string command =
      "spirv-opt --fold-spec-const-op-composite --loop-unroll --ccp --eliminate-dead-branches --merge-blocks "
      "--eliminate-dead-code-aggressive '" +
      from + "' -o '" + to + "'";
  EXPECT_EQ(system(command.c_str()), 0) << command;
  return std::filesystem::exists(to) ? std::filesystem::file_size(to) / sizeof words[0] : 0;
}

TEST(KernelBudget, NoModuleIsLong) {
  int number = 0;
  for (const auto& [words, label] : modules_of(BUILD_SMALL, shipped_scenes())) {
    const std::uintmax_t size = reduced_size(words);
    EXPECT_LE(size, 16000u) << label;
    RecordProperty(label + " " + std::to_string(++number), std::to_string(size) + " words");
  }
  for (const auto& [words, label] : modules_of(BUILD_WIDE, {"three_beakers"})) {
    // all loops of a solve are unrolled (docs/drivers.md)
    const bool solves = label.ends_with("effort") || label.ends_with("reserve");
    const std::uintmax_t size = reduced_size(words);
    EXPECT_LE(size, solves ? 46000u : 32000u) << label;
    RecordProperty("wide " + label + " " + std::to_string(++number), std::to_string(size) + " words");
  }
}

// A number of the driver's statistics.
int statistic(const std::string& text, const std::string& what) {
  std::smatch found;
  if (!std::regex_search(text, found, std::regex("(?:^|\n)" + what + ": ([0-9]+)")))
    ADD_FAILURE() << "no " << what << " in:\n" << text;
  return found.empty() ? 0 : std::stoi(found[1]);
}

TEST(KernelBudget, FitsTheRegistersOfGpus) {
  const std::map<Words, std::string> modules = modules_of(BUILD_SMALL, shipped_scenes());
  ASSERT_GT(modules.size(), 20u);
  for (const auto& [chip, registers] : std::map<std::string, int>{{"VEGA10", 128}, {"NAVI21", 128}, {"GFX1100", 132}}) {
    const ScopedVariable driver("VK_ICD_FILENAMES", "/usr/share/vulkan/icd.d/radeon_icd.x86_64.json"),
        family("RADV_FORCE_FAMILY", chip.c_str()), report("RADV_DEBUG", "nocache,shaderstats");
    const host::Device on;
    int number = 0;
    ASSERT_NE(on.info().name.find(chip), std::string::npos) << on.info().name;
    for (const auto& [words, label] : modules) {
      testing::internal::CaptureStderr();
      const host::Kernel kernel(on, words, {}, label);
      const std::string report_text = testing::internal::GetCapturedStderr();
      const int used = statistic(report_text, "VGPRs"), spilled = statistic(report_text, "Spilled VGPRs");
      const int scalars = statistic(report_text, "Spilled SGPRs"), scratch = statistic(report_text, "Scratch size");
      EXPECT_LE(used, registers) << label << " on " << chip;
      EXPECT_EQ(spilled, 0) << label << " on " << chip;
      EXPECT_LE(scalars, 32) << label << " on " << chip;
      EXPECT_LE(scratch, 1024) << label << " on " << chip;
      RecordProperty(chip + " " + label + " " + std::to_string(++number),
                     fmt::format("{} VGPRs, {} SGPRs spilled, {} B of scratch, {} waves, {} cycles of latency", used, scalars,
                                 scratch, statistic(report_text, "Subgroups per SIMD"), statistic(report_text, "Latency")));
    }
  }
}

}  // namespace
}  // namespace wholehand
