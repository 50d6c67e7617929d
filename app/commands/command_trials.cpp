// SPDX-License-Identifier: MIT
// wholehand trials: do grips hold in a physics engine?
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/result_scene.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "core/reader/text.h"
#include "evidence/trials/mujoco_engine.h"
#include "evidence/trials/run.h"

namespace wholehand {
namespace {

constexpr IntegerRange TRIED_GRIPS{0, 100'000}, PLACEMENTS{1, 4'096};

struct TrialsArguments {
  std::string scene, folder, grips, best, scatter, vessel, protocol, model, mass, friction, seed, threads;
  std::vector<std::string> fills, tilts;
  bool quick = false, resume = false;
};

// One of two words; `first` if the text is empty.
bool is_second(const std::string& text, const char* option, const char* first, const char* second) {
  if (text.empty() || text == first) return false;
  if (text == second) return true;
  throw usage_error(fmt::format("{} {}; allowed: {} or {}", option, in_quotes(text), first, second));
}

void read_protocol(const std::string& text, TrialOptions& options) {
  if (text.empty() || text == "fill-tilt") return;
  if (text != "six-forces" && text != "both")
    throw usage_error(fmt::format("--protocol {}; allowed: fill-tilt, six-forces or both", in_quotes(text)));
  options.six_forces = true;
  options.fill_tilt = text == "both";
}

std::vector<double> read_ascending(const std::vector<std::string>& texts, const char* option, const Quantity& quantity) {
  std::vector<double> values;
  for (const std::string& text : texts) values.push_back(parse_quantity(text, option, quantity));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

// Pushes are tried in only one state, so a request for others would be ignored.
void check_pushed_states(const TrialOptions& options) {
  if (options.fill_tilt) return;
  if (!options.tilts.empty())
    throw usage_error("--tilt-deg: --protocol six-forces tilts nothing; leave --tilt-deg out, or ask for --protocol both");
  if (options.fills.size() > 1)
    throw usage_error(
        fmt::format("--fill: {} fills are given, and --protocol six-forces pushes at one; give one fill, or ask for "
                    "--protocol both, where it takes the largest",
                    options.fills.size()));
}

// Robust scores need the scene's own masses, and tilts.
void check_scatter(const TrialOptions& options) {
  if (options.scatter == 0) return;
  if (options.six_forces) throw usage_error("--scatter: pushes are not scattered; leave --protocol out");
  if (!std::isnan(options.settings.mass))
    throw usage_error("--scatter: robust scores are those of the scene's own masses; leave --mass-kg out");
}

// All that does not need the scene.
TrialOptions read_options(const TrialsArguments& arguments) {
  TrialOptions options;
  read_protocol(arguments.protocol, options);
  if (arguments.quick) make_quick(options);
  options.folder = arguments.folder;
  options.resume = arguments.resume;
  if (!arguments.grips.empty()) options.grips = static_cast<std::size_t>(parse_integer(arguments.grips, "--grips", TRIED_GRIPS));
  if (!arguments.best.empty()) options.best = static_cast<std::size_t>(parse_integer(arguments.best, "--best", TRIED_GRIPS));
  if (options.grips == 0 && options.best == 0)
    throw usage_error("--grips 0 with --best 0: no grip is left to try; give more of one");
  options.fills = read_ascending(arguments.fills, "--fill", ranges::FRACTION);
  options.tilts = read_ascending(arguments.tilts, "--tilt-deg", ranges::TILT);
  check_pushed_states(options);
  if (is_second(arguments.model, "--model", "hand", "contacts")) options.settings.model = TrialModel::contacts;
  if (!arguments.mass.empty()) options.settings.mass = parse_quantity(arguments.mass, "--mass-kg", ranges::MASS);
  if (!arguments.friction.empty()) options.settings.friction = parse_quantity(arguments.friction, "--friction", ranges::FRICTION);
  if (!arguments.scatter.empty())
    options.scatter = static_cast<std::size_t>(parse_integer(arguments.scatter, "--scatter", PLACEMENTS));
  check_scatter(options);
  if (!arguments.seed.empty()) options.seed = static_cast<std::uint64_t>(parse_integer(arguments.seed, "--seed", ranges::SEED));
  if (!arguments.threads.empty())
    options.threads = static_cast<int>(parse_integer(arguments.threads, "--threads", ranges::THREADS));
  return options;
}

ExitCode trials(const TrialsArguments& arguments) {
  TrialOptions options = read_options(arguments);
  const std::string path = is_result(arguments.scene) ? arguments.scene : find_scene(arguments.scene);
  std::optional<sweeps::SweepResult> result;
  if (is_result(path)) result.emplace(path);
  Scene scene = result ? whole_scene_of_result(*result) : read_scene_file(path);
  if (!arguments.vessel.empty()) options.vessel = find_vessel(scene, arguments.vessel);
  if (!options.fills.empty() && !scene.liquid)
    throw usage_error(
        fmt::format("--fill: {} has no [liquid]; add one with its fills, or leave --fill out", in_quotes(scene.file)));
  if (!result) load_meshes(scene);
  return run_trials(scene, options, make_mujoco_engine, result ? &*result : nullptr);
}

}  // namespace

void add_trials_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<TrialsArguments>();
  CLI::App* command = app.add_subcommand("trials", "Try whether grips hold in a physics engine, and what predicts it");
  const auto add = [command](const char* name, auto& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type)->check(not_empty())->check(not_an_option());
  };
  add("scene", arguments->scene, "SCENE|RESULT.nc", "Scene file, name of a shipped scene, or result of `wholehand sweep`")
      ->required();
  add("-o,--output", arguments->folder, "DIR", "Folder for the tables, the page and the recordings")->required();
  add("--grips", arguments->grips, "N", "Grips of the sample over all scores, of all vessels together (default: 400)");
  add("--best", arguments->best, "N", "Best grips of each vessel (default: 20)");
  add("--scatter", arguments->scatter, "N",
      "Try each grip at N random deviations of the scene's [robust] too, as a person's hand misses it");
  add("--vessel", arguments->vessel, "V", "Try this vessel alone (default: all)");
  add("--fill", arguments->fills, "F",
      "Fills, as fractions of the capacity (default: three of the scene's); six-forces takes the largest");
  add("--tilt-deg", arguments->tilts, "T", "Tilts of fill-tilt (default: four of the scene's)");
  add("--protocol", arguments->protocol, "P", "fill-tilt (the default), six-forces or both")
      ->check(offered("fill-tilt six-forces both"));
  add("--model", arguments->model, "M", "hand (the default), or contacts: each contact alone, as a cross-check")
      ->check(offered("hand contacts"));
  add("--mass-kg", arguments->mass, "M", "Mass of vessel and liquid together in every state (default: that of the state)");
  add("--friction", arguments->friction, "MU", "Coefficient of friction (default: the scene's)");
  add("--seed", arguments->seed, "S", "Seed of the sample and of the intervals (default: 1)");
  add("--threads", arguments->threads, "N", "Number of threads (default: all)");
  command->add_flag("--quick", arguments->quick, "Fewer grips and states; this takes less than a minute");
  command->add_flag("--resume", arguments->resume, "Continue interrupted trials where they ended");
  command->callback([arguments, &action] { action = [arguments] { return trials(*arguments); }; });
}

}  // namespace wholehand
