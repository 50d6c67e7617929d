// SPDX-License-Identifier: MIT
// wholehand study: the paper's experiments with virtual people.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <optional>

#include "app/commands/commands.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "core/reader/text.h"
#include "evidence/studies/run.h"

namespace wholehand {
namespace {

constexpr IntegerRange PEOPLE{1, 100'000'000};
constexpr std::uint64_t MOST_SIMULATED = 100'000;
constexpr const char* STUDY_SCENE = "mixing_board";

struct StudyArguments {
  std::string scene, folder, people, experiment, seed, threads;
  bool quick = false, resume = false;
};

// `asked` people in each named experiment; absent: each one's default.
StudyPeople people_of(const std::string& experiment, const std::optional<std::uint64_t>& asked, bool is_quick) {
  StudyPeople people = is_quick ? QUICK_PEOPLE : StudyPeople{};
  if (asked) people = {*asked, *asked, *asked};
  const std::uint64_t of_advice = asked ? *asked : is_quick ? QUICK_ADVICE_PEOPLE : ADVICE_PEOPLE;
  if (experiment.empty() || experiment == "all") return people;
  if (experiment == "contacts") return {people.contacts, 0, 0};
  if (experiment == "forces") return {0, people.forces, 0};
  if (experiment == "sessions") return {0, 0, people.sessions};
  if (experiment == "advice") return {0, 0, 0, of_advice};
  throw usage_error(fmt::format("--experiment {}; allowed: contacts, forces, sessions, advice or all", in_quotes(experiment)));
}

ExitCode study(const StudyArguments& arguments) {
  StudyOptions options;
  options.folder = arguments.folder;
  options.resumes = arguments.resume;
  if (arguments.quick) options.resamples = QUICK_RESAMPLES;
  std::optional<std::uint64_t> people;
  if (!arguments.people.empty()) people = static_cast<std::uint64_t>(parse_integer(arguments.people, "--people", PEOPLE));
  options.people = people_of(arguments.experiment, people, arguments.quick);
  const std::uint64_t simulated = std::max({options.people.forces, options.people.sessions, options.people.advice});
  if (options.resumes && simulated == 0)
    throw usage_error("--resume: contacts take seconds and are not kept; allowed: with forces, sessions or advice");
  if (simulated > MOST_SIMULATED)
    throw usage_error(fmt::format("--people {}; allowed: 1 to {} with forces, sessions or advice, of which all grasps are kept",
                                  arguments.people, MOST_SIMULATED));
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
  add("--people", arguments->people, "N",
      "Number of people in each experiment (default: 10000 for contacts, 1000 for forces, 500 for sessions, 200 for advice)");
  add("--experiment", arguments->experiment, "E",
      "contacts, forces, sessions, advice (does it help?), or all (the default: all but advice)")
      ->check(offered("contacts forces sessions advice all"));
  add("--seed", arguments->seed, "S", "Seed of the people and of the intervals (default: 1)");
  add("--threads", arguments->threads, "N", "Number of threads (default: all)");
  command->add_flag("--quick", arguments->quick,
                    "500 people for contacts, 20 for forces and sessions, 10 for advice, and fewer samples for the intervals");
  command->add_flag("--resume", arguments->resume, "Go on with an interrupted study in the same folder");
  command->callback([arguments, &action] { action = [arguments] { return study(*arguments); }; });
}

}  // namespace wholehand
