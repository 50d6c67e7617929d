// SPDX-License-Identifier: MIT
// wholehand study: the paper's experiments with virtual people.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "app/commands.h"
#include "app/paths.h"
#include "app/validators.h"
#include "app/values.h"
#include "objects/vessel.h"
#include "scene/reader.h"
#include "scene/text.h"
#include "studies/run.h"

namespace wholehand {
namespace {

constexpr IntegerRange PEOPLE{1, 100'000'000};
constexpr const char* STUDY_SCENE = "mixing_board";

struct StudyArguments {
  std::string scene, folder, people, experiment, seed, threads;
  bool quick = false;
};

// `all` are those that there are.
void check_experiment(const std::string& name) {
  if (name.empty() || name == "contacts" || name == "all") return;
  if (name == "forces" || name == "sessions")
    throw usage_error(fmt::format("--experiment {}: this experiment is not there yet; ask for contacts", name));
  throw usage_error(fmt::format("--experiment {}; allowed: contacts or all", in_quotes(name)));
}

ExitCode study(const StudyArguments& arguments) {
  check_experiment(arguments.experiment);
  StudyOptions options;
  options.folder = arguments.folder;
  if (arguments.quick) {
    options.people = QUICK_PEOPLE;
    options.resamples = QUICK_RESAMPLES;
  }
  if (!arguments.people.empty()) options.people = static_cast<std::uint64_t>(parse_integer(arguments.people, "--people", PEOPLE));
  if (!arguments.seed.empty()) options.seed = static_cast<std::uint64_t>(parse_integer(arguments.seed, "--seed", ranges::SEED));
  if (!arguments.threads.empty())
    options.threads = static_cast<int>(parse_integer(arguments.threads, "--threads", ranges::THREADS));
  Scene scene = read_scene_file(find_scene(arguments.scene.empty() ? STUDY_SCENE : arguments.scene));
  load_meshes(scene);
  return run_study(scene, options);
}

}  // namespace

void add_study_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<StudyArguments>();
  CLI::App* command = app.add_subcommand("study", "Run the paper's experiments with a population of virtual people");
  const auto add = [command](const char* name, auto& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type)->check(not_empty())->check(not_an_option());
  };
  add("scene", arguments->scene, "SCENE", "Scene file or name of a shipped scene, with guidance points (default: mixing_board)");
  add("-o,--output", arguments->folder, "DIR", "Folder for the tables and the page")->required();
  add("--people", arguments->people, "N", "Number of people (default: 10000)");
  add("--experiment", arguments->experiment, "E",
      "contacts, or all that are there (the default); forces and sessions are not there yet");
  add("--seed", arguments->seed, "S", "Seed of the people and of the intervals (default: 1)");
  add("--threads", arguments->threads, "N", "Number of threads (default: all)");
  command->add_flag("--quick", arguments->quick, "500 people, and fewer samples for the intervals");
  command->callback([arguments, &action] { action = [arguments] { return study(*arguments); }; });
}

}  // namespace wholehand
