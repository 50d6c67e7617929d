// SPDX-License-Identifier: MIT
// wholehand rank: the best grips of a result by other weights and under conditions.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/commands.h"
#include "app/list_options.h"
#include "app/result_scene.h"
#include "app/validators.h"
#include "core/printable.h"
#include "core/text.h"
#include "program/values.h"
#include "sweeps/best_glb.h"
#include "sweeps/closing.h"
#include "sweeps/companions.h"
#include "sweeps/rank.h"
#include "system/files.h"
#include "system/output.h"
#include "system/readable.h"

namespace wholehand {
namespace {

struct RankArguments {
  std::string result, weights, by, best, apart, glb, output;
  std::vector<std::string> where;
  bool least_bad = false;
  ListArguments list;
};

// What can be refused before any work.
void check_list_file(const RankArguments& arguments, const Scene& scene) {
  const std::string& path = arguments.output;
  if (path.empty()) return;
  check_output_path(path);
  check_not_the_scene(path, scene);
  if (is_same_file(path, arguments.result))
    throw usage_error(fmt::format("-o {}: this is the result file itself; name another file for the list", path));
  if (is_same_file(path, output_names(arguments.result).best))
    throw usage_error(fmt::format("-o {}: this is the sweep's own list; name another file", path));
  constexpr std::string_view LIST_END = ".best.csv";
  const std::string result = path.ends_with(LIST_END) ? path.substr(0, path.size() - LIST_END.size()) + ".nc" : "";
  if (begins_with(result, NETCDF4_START))
    throw usage_error(fmt::format("-o {}: this is the sweep's own list of {}; name another file", path, result));
  check_overwrites_kind(path, BEST_CSV_START, "list of grips", "-o");
}

// LIST.<vessel>.<rank>.glb beside LIST.csv.
OutputNames glb_names(const std::string& list) {
  OutputNames names;
  names.stem = list.ends_with(".csv") ? list.substr(0, list.size() - 4) : list;
  return names;
}

// As many as the sweep listed, or what its scene asks for, or 20 where that is none.
std::size_t usual_length(const SweepResult& result, const Scene& scene, const Plan& plan) {
  std::size_t most = 0;
  if (result.lists_best() && !result.lists_all_hands_together())
    for (const auto& list : lists_of_sweep(result, scene, plan)) most = std::max(most, list.size());
  if (most > 0) return most;
  return scene.output.best > 0 ? static_cast<std::size_t>(scene.output.best) : static_cast<std::size_t>(OutputData().best);
}

std::string ranking_text(const Scene& scene, const Plan& plan, const RankArguments& arguments, const Ranking& ranking,
                         const ListView& view) {
  std::string text;
  for (std::size_t list = 0; list < ranking.lists.size(); ++list) {
    const std::uint64_t plausible = ranking.plausible[list], not_held = ranking.not_held[list], held = plausible - not_held;
    const std::string verdict = held == 0 && not_held > 0 && !arguments.least_bad
                                    ? "no grip holds; --least-bad lists those that are nearest to it"
                                : held > 0 && ranking.lists[list].empty() ? "no grip matches"
                                                                          : verdict_text(scene, ranking.lists[list]);
    text += fmt::format("{}{}: {}\n  ", list == 0 ? "" : "\n", list_name(scene, plan, list), verdict);
    const std::string of_these = not_held > 0 ? fmt::format(", {} not held", readable_number(not_held)) : "";
    if (arguments.where.empty()) {
      text += fmt::format("{} feasible and plausible{}\n", counted(plausible, "grip is", "grips are"),
                          of_these.empty() ? "" : "; of these" + of_these.substr(1));
    } else {
      text += fmt::format("{} of {}{} {}{}\n", readable_number(ranking.matching[list]),
                          counted(held, "feasible, plausible grip", "feasible, plausible grips"), not_held > 0 ? " that hold" : "",
                          held == 1 ? "matches" : "match", of_these);
    }
    text += list_lines(scene, plan, list / plan.hand_scales(), ranking.lists[list], arguments.output, view);
  }
  return text;
}

ExitCode rank(const RankArguments& arguments) {
  check_rank_by(arguments.by);
  ListView view = arguments.list.view();
  const int glb = arguments.glb.empty() ? 0 : static_cast<int>(parse_integer(arguments.glb, "--glb", ranges::BEST));
  if (glb > 0 && arguments.output.empty())
    throw usage_error("--glb: the name of the list is missing, which also names the glTF files; give -o LIST.csv");
  SweepResult result(arguments.result);
  std::string trouble;
  Scene scene = scene_of_result(result, trouble);
  check_list_file(arguments, scene);
  set_heights(result, scene);
  const Plan plan(scene, keeps_vectors(result.variables()));
  result.use(scene, plan);
  RankRequest request{arguments.weights, arguments.where, 0, 0, 0, arguments.least_bad, read_rank_by(arguments.by, scene)};
  view.by = request.by;
  request.best = arguments.best.empty() ? usual_length(result, scene, plan)
                                        : static_cast<std::size_t>(parse_integer(arguments.best, "--best", {1, ranges::BEST.high}));
  if (glb > static_cast<int>(request.best))
    throw usage_error(fmt::format("--glb {0}: each list keeps only its best {1} grips; give --best {0} too", glb, request.best));
  request.apart = arguments.apart.empty() ? scene.output.apart : parse_quantity(arguments.apart, "--apart-mm", ranges::APART);
  const auto open_core = [&]() -> std::shared_ptr<const Evaluator> {
    if (!trouble.empty() && (request.apart > 0 || request.by == RankBy::robust) && glb == 0)
      throw usage_error(fmt::format("{}: {}; {}--apart-mm 0 lists grips without it, however near they are to each other",
                                    result.path(), trouble, request.by == RankBy::robust ? "--rank-by score with " : ""));
    if (!trouble.empty()) throw usage_error(result.path() + ": " + trouble);
    return make_core_evaluator(scene);
  };
  const OutputNames names = glb_names(arguments.output);
  check_best_glb(scene, plan, names, glb);
  const std::shared_ptr<const Evaluator> core = glb > 0 ? open_core() : nullptr;
  const Ranking ranking = rank_grips(result, scene, plan, request, open_core);
  if (!ranking.note.empty()) say_note(ranking.note);
  print(ranking_text(scene, plan, arguments, ranking, view));
  if (arguments.output.empty()) return ExitCode::done;
  std::vector<std::string> files{arguments.output};
  write_whole_file(arguments.output, best_csv(scene, plan, ranking.lists, list_origin(arguments.result, result.origin())), false);
  if (core) {
    const BestGlb written = write_best_glb(scene, plan, core, ranking.lists, glb, names);
    files.insert(files.end(), written.files.begin(), written.files.end());
    for (const std::string& line : written.notes) say_note(line);
  }
  print(fmt::format("\nwrote {}\n", one_line(joined(files, ", "))));
  return ExitCode::done;
}

}  // namespace

void add_rank_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<RankArguments>();
  CLI::App* command = app.add_subcommand("rank", "List the best grips of a sweep by other weights and under conditions");
  const auto add = [command](const char* name, auto& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type)->check(not_empty());
  };
  add("result", arguments->result, "FILE.nc", "Result of `wholehand sweep`")->required();
  add("--weights", arguments->weights, "TERM=W,..",
      "Weights of fingers, contacts, depth, posture, force, hold (default: the scene's)");
  add("--where", arguments->where, "CONDITION",
      "List only grips that meet this condition: \"fingers_used >= 4 and palm_depth_mm < 2\"; given again: that one too")
      ->allow_extra_args(false);
  add("--rank-by", arguments->by, "KEY",
      "score, robust (10th percentile over the deviations of [robust]; the default where the scene has it), worst_effort or push")
      ->check(offered("score robust worst_effort push"));
  add("--best", arguments->best, "N", "Number of grips to list for each vessel (default: as many as the sweep listed)");
  add_list_options(*command, arguments->list);
  add("--apart-mm", arguments->apart, "A",
      "List only grips that have some joint of the hand more than A from every grip before (default: the scene's; 0: any)");
  command->add_flag("--least-bad", arguments->least_bad, "Where no grip of a list holds, list those of the least worst effort");
  add("--glb", arguments->glb, "N", "Write the best N grips of each vessel as glTF: LIST.<vessel>.<rank>.glb");
  add("-o,--output", arguments->output, "LIST.csv", "Write the list; grip, view and report read it with --list");
  command->callback([arguments, &action] { action = [arguments] { return rank(*arguments); }; });
}

}  // namespace wholehand
