// SPDX-License-Identifier: MIT
// wholehand sweep: every grip of a scene.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/list_options.h"
#include "app/commands/validators.h"
#include "app/program/remedy.h"
#include "app/program/values.h"
#include "app/program/vulkan_environment.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/rank/rank.h"
#include "sweeps/run/auto_backend.h"
#include "sweeps/run/run.h"

namespace wholehand {
namespace {

constexpr const char* SHARD_LETTERS = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
constexpr std::size_t MOST_SHARD_LETTERS = 100;  // a file's name has 255 at most, and the result's own comes before

struct SweepArguments {
  std::string scene, output, on = sweeps::ON_AUTO, precision, best, glb, threads, time_limit, mark_seconds, shard;
  bool resume = false, explain = false, no_refine = false, shards = false;
  ListArguments list;
};

ExitCode sweep(const SweepArguments& arguments, const SweepRunner& run) {
  sweeps::SweepOptions options;
  options.output = arguments.output;
  options.on = arguments.on;
  if (!arguments.precision.empty()) options.precision = parse_precision(arguments.precision);
  if (!arguments.best.empty()) options.best = static_cast<int>(parse_integer(arguments.best, "--best", ranges::BEST));
  options.list = arguments.list.view();
  sweeps::check_rank_by(arguments.list.by);
  options.rank_by = arguments.list.by;
  if (!arguments.glb.empty()) options.glb = static_cast<int>(parse_integer(arguments.glb, "--glb", ranges::BEST));
  if (!arguments.threads.empty())
    options.threads = static_cast<int>(parse_integer(arguments.threads, "--threads", ranges::THREADS));
  if (!arguments.time_limit.empty()) options.time_limit = parse_duration(arguments.time_limit, "--time-limit");
  if (!arguments.mark_seconds.empty())
    options.tuning.mark_seconds = parse_quantity(arguments.mark_seconds, "--mark-seconds", {0.01, 86'400});
  options.resume = arguments.resume;
  options.explain = arguments.explain;
  options.refine = !arguments.no_refine;
  if (arguments.shards || !arguments.shard.empty()) options.shards = arguments.shard;
  options.hooks.warn = print_float_warnings;
  prepare_vulkan_environment(options.on);
  return run([&arguments] { return read_scene_file(find_scene(arguments.scene)); }, options);
}

CLI::App* add_command(CLI::App& app, Action& action, const std::shared_ptr<SweepArguments>& arguments, const SweepRunner& run) {
  CLI::App* command = app.add_subcommand("sweep", "Score every grip of a scene, show the best, write the results");
  command->add_option("scene", arguments->scene, "Scene file or name of a shipped scene (default: three_beakers)")
      ->type_name("SCENE")
      ->check(not_empty());
  command->add_option("-o,--output", arguments->output, "Result file (default: the scene file's name with .nc)")
      ->type_name("FILE")
      ->check(not_empty());
  command
      ->add_option("--on", arguments->on,
                   "auto (the default): a GPU, or a CPU driver that is expected to be faster, where the core needs more than a "
                   "second; core; vulkan: the best device; or the name of a device")
      ->type_name("DEVICE")
      ->check(offered("auto core vulkan"))
      ->check(not_empty());
  command->add_option("--precision", arguments->precision, "float or double (default: float on a device, double on the core)")
      ->type_name("P")
      ->check(offered("float double"));
  command->add_option("--best", arguments->best, "Number of grips to list for each vessel (default: the scene's)")->type_name("N");
  add_list_options(*command, arguments->list);
  command->add_option("--glb", arguments->glb, "Write the best N grips of each vessel as glTF: NAME.<vessel>.<rank>.glb")
      ->type_name("N");
  command->add_option("--threads", arguments->threads, "Number of threads of the core (default: all)")->type_name("N");
  command
      ->add_option("--time-limit", arguments->time_limit,
                   "End as if interrupted after this time, in seconds, M:SS or H:MM:SS (default: none); --resume goes on")
      ->type_name("TIME")
      ->check(not_empty());
  command
      ->add_option("--mark-seconds", arguments->mark_seconds,
                   "Least time between two progress marks: what a crash may cost (default: 5)")
      ->type_name("S")
      ->check(not_empty());
  command->add_flag("--resume", arguments->resume, "Continue an interrupted sweep where it ended");
  command->add_flag("--explain", arguments->explain,
                    "Print what the sweep left out and saved, and what its parts cost; this times both ways first");
  command->add_flag("--no-refine", arguments->no_refine, "Do not look for better grips near the best ones");
  command->callback([arguments, run, &action] { action = [arguments, run] { return sweep(*arguments, run); }; });
  return command;
}

}  // namespace

void add_sweep_command(CLI::App& app, Action& action) {
  add_command(app, action, std::make_shared<SweepArguments>(),
              [](const std::function<Scene()>& read_scene, const sweeps::SweepOptions& options) {
                return sweeps::run_sweep(read_scene(), options);
              });
}

void add_shared_sweep_command(CLI::App& app, Action& action, const SweepRunner& run) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command = add_command(app, action, arguments, run);
  command->get_option("--on")->description(
      "auto (the default): the same as vulkan here; core; vulkan: the best device; or the name of a device");
  command->add_flag("--shards", arguments->shards,
                    "The nodes share no file system: each node writes a file of its own, and `wholehand merge` makes one of them");
  command->add_option("--shard", arguments->shard, "The same, with another name than the node's for the file of this rank")
      ->type_name("NAME")
      ->check(CLI::Validator(
          [](const std::string& name) {
            const bool is_plain =
                !name.empty() && name.size() <= MOST_SHARD_LETTERS && name.find_first_not_of(SHARD_LETTERS) == std::string::npos;
            return is_plain ? std::string()
                            : fmt::format("\"{}\" is no name for a file: use letters, digits, '-', '_' and '.', {} of them at most",
                                          name, MOST_SHARD_LETTERS);
          },
          ""));
}

}  // namespace wholehand
