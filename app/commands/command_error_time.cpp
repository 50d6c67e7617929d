// SPDX-License-Identifier: MIT
// wholehand error-time: what every shortcut costs in error and gains in time.
#include <CLI/CLI.hpp>

#include <memory>

#include "app/commands/commands.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "app/program/vulkan_environment.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/error_time.h"

namespace wholehand {
namespace {

struct ErrorTimeArguments {
  std::string scene, output, on = "vulkan", seed, threads;
  bool quick = false;
};

ExitCode error_time(const ErrorTimeArguments& arguments) {
  ErrorTimeOptions options;
  options.output = arguments.output;
  options.on = arguments.on;
  options.quick = arguments.quick;
  if (!arguments.seed.empty()) options.seed = static_cast<std::uint64_t>(parse_integer(arguments.seed, "--seed", ranges::SEED));
  if (!arguments.threads.empty())
    options.threads = static_cast<int>(parse_integer(arguments.threads, "--threads", ranges::THREADS));
  prepare_vulkan_environment(options.on);
  return run_error_time(read_scene_file(find_scene(arguments.scene)), options);
}

}  // namespace

void add_error_time_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<ErrorTimeArguments>();
  CLI::App* command = app.add_subcommand("error-time", "Measure the error and the time of every shortcut");
  command->add_option("scene", arguments->scene, "Scene file or name of a shipped scene (default: three_beakers)")
      ->type_name("SCENE")
      ->check(not_empty());
  command->add_option("-o,--output", arguments->output, "Folder for error-time.csv, its report and pictures")
      ->type_name("DIR")
      ->check(not_empty())
      ->required();
  command->add_option("--on", arguments->on, "vulkan (the best device; the default), the name of a device, or core (no device)")
      ->type_name("DEVICE")
      ->check(offered("vulkan core"))
      ->check(not_empty());
  command->add_flag("--quick", arguments->quick, "Use fewer grips, variants and runs; this takes about a minute");
  command->add_option("--seed", arguments->seed, "Seed of the random grips (default: 1)")->type_name("N");
  command->add_option("--threads", arguments->threads, "Number of threads of the core (default: all)")->type_name("N");
  command->callback([arguments, &action] { action = [arguments] { return error_time(*arguments); }; });
}

}  // namespace wholehand
