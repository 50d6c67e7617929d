// SPDX-License-Identifier: MIT
// wholehand rank: the best grips of a result by other weights and under conditions.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/list_options.h"
#include "app/commands/result_scene.h"
#include "app/commands/validators.h"
#include "app/program/values.h"
#include "base/files/files.h"
#include "base/system/output.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/tolerances.h"
#include "sweeps/plan/rules.h"
#include "sweeps/rank/rank.h"
#include "sweeps/result/best_glb.h"
#include "sweeps/result/companions.h"
#include "sweeps/result/output_names.h"
#include "sweeps/run/closing.h"

namespace wholehand {
namespace {

struct RankArguments {
  std::string weights, best, apart, glb, output;
  std::vector<std::string> results, where;
  bool least_bad = false;
  ListArguments list;
};

// A result with what its ranking needs; stays where it is.
struct RankedResult {
  explicit RankedResult(const std::string& path)
      : result(path), scene(read_scene(result, mesh_error)), plan(scene, sweeps::keeps_vectors(result.variables())) {
    result.use(scene, plan);
  }
  RankedResult(const RankedResult&) = delete;
  RankedResult& operator=(const RankedResult&) = delete;

  static Scene read_scene(const sweeps::SweepResult& result, std::string& mesh_error) {
    Scene scene = scene_of_result(result, mesh_error);
    sweeps::set_heights(result, scene);
    return scene;
  }

  sweeps::SweepResult result;
  std::string mesh_error;  // with its meshes
  Scene scene;
  sweeps::Plan plan;
  sweeps::Ranking ranking{};
  std::vector<std::string> unheld{};  // a line for each list without a holding grip
};
using RankedResults = std::vector<std::unique_ptr<RankedResult>>;

// Grips of the lists with the same name, ranked together.
struct JointList {
  std::string name;
  std::vector<std::pair<std::size_t, std::size_t>> parts{};  // results, and which of their lists
  std::vector<sweeps::MergedGrip> grips{};
};

// Refuses what it can before any work.
void check_list_file(const RankArguments& arguments, const std::string& of_result, const Scene& scene) {
  const std::string& path = arguments.output;
  if (path.empty()) return;
  check_output_path(path);
  sweeps::check_not_the_scene(path, scene);
  if (is_same_file(path, of_result))
    throw usage_error(fmt::format("-o {}: this is the result file itself; name another file for the list", path));
  if (is_same_file(path, sweeps::output_names(of_result).best))
    throw usage_error(fmt::format("-o {}: this is the sweep's own list; name another file", path));
  constexpr std::string_view LIST_END = ".best.csv";
  const std::string result = path.ends_with(LIST_END) ? path.substr(0, path.size() - LIST_END.size()) + ".nc" : "";
  if (begins_with(result, NETCDF4_START))
    throw usage_error(fmt::format("-o {}: this is the sweep's own list of {}; name another file", path, result));
  check_overwrites_kind(path, sweeps::BEST_CSV_START, "list of grips", "-o");
}

// Scores of several results are comparable only if one rule made them.
void check_one_rule(const RankedResult& first, const RankedResult& other, const std::string& weights) {
  const auto rules = sweeps::scene_rules(other.scene), wanted = sweeps::scene_rules(first.scene);
  auto is_shared = sweeps::shared_rules(first.scene, other.scene);
  is_shared[sweeps::RULE_WEIGHTS] = sweeps::read_weights(weights, first.scene) == sweeps::read_weights(weights, other.scene);
  for (std::size_t k = 0; k < sweeps::RULE_COUNT; ++k) {
    if (is_shared[k]) continue;
    throw usage_error(fmt::format("{}: {} '{}', but {} in {}; allowed: results of one {}{}", other.result.path(), rules[k].name,
                                  rules[k].text, rules[k].text == wanted[k].text ? "other details" : "'" + wanted[k].text + "'",
                                  first.result.path(), sweeps::rule_names(),
                                  k == sweeps::RULE_WEIGHTS ? "; --weights sets those that it names" : ""));
  }
}

// The common rule by which several results are ranked together; empty for one result.
std::string rule_line(const RankedResults& results, const RankArguments& arguments, sweeps::RankBy by) {
  if (results.size() < 2) return "";
  const auto rules = sweeps::scene_rules(results.front()->scene);
  std::string key = arguments.list.by.empty() ? (by == sweeps::RankBy::robust ? "robust" : "score") : arguments.list.by;
  if (!arguments.weights.empty()) key += fmt::format(" with weights {}", one_line(arguments.weights));
  std::vector<std::string> shared;
  for (const sweeps::RulePlace place : {sweeps::RULE_HAND, sweeps::RULE_STRENGTH, sweeps::RULE_ROBUST})
    shared.push_back(fmt::format("{} '{}'", rules[place].name, rules[place].text));
  return fmt::format("{} results ranked by {}; all have {}\n\n", results.size(), key, joined(shared, ", "));
}

// LIST.<vessel>.<rank>.glb beside LIST.csv.
sweeps::OutputNames glb_names(const std::string& list) {
  sweeps::OutputNames names;
  names.stem = list.ends_with(".csv") ? list.substr(0, list.size() - 4) : list;
  return names;
}

// As unheld_lines gives them. All are empty if the scene's meshes or the result's efforts are missing.
std::vector<std::string> unheld_lines_of(const RankedResult& one) {
  const std::size_t lists = one.ranking.lists.size();
  bool is_any = false;
  for (std::size_t list = 0; list < lists; ++list) is_any = is_any || sweeps::none_holds(one.ranking, list);
  if (!is_any || !one.mesh_error.empty() || !one.result.find("worst_effort") || !one.result.find("score"))
    return std::vector<std::string>(lists);
  const std::shared_ptr<const Evaluator> core = make_core_evaluator(one.scene);
  const sweeps::Ranking least_bad =
      sweeps::rank_grips(one.result, one.scene, one.plan, {"", {}, 1, 0, 0, true}, [&] { return core; });
  return sweeps::unheld_lines(*core, one.scene, one.plan, least_bad);
}

std::vector<JointList> joint_lists(const RankedResults& results, const sweeps::RankRequest& request) {
  std::vector<JointList> lists;
  for (std::size_t r = 0; r < results.size(); ++r) {
    const RankedResult& one = *results[r];
    for (std::size_t list = 0; list < one.ranking.lists.size(); ++list) {
      const std::string name = sweeps::list_name(one.scene, one.plan, list);
      auto found = std::find_if(lists.begin(), lists.end(), [&](const JointList& joint) { return joint.name == name; });
      if (found == lists.end()) found = lists.insert(lists.end(), {name});
      found->parts.emplace_back(r, list);
      for (const sweeps::BestGrip& grip : one.ranking.lists[list]) found->grips.push_back({r, list, grip});
    }
  }
  if (results.size() > 1)
    for (JointList& list : lists) list.grips = sweeps::merged(std::move(list.grips), request.by, request.best);
  return lists;
}

// The note for a list without a holding grip.
std::string unheld_text(const RankedResults& results, const JointList& list) {
  const auto& [r, place] = list.parts.front();
  const std::string& line = results[r]->unheld[place];
  return list.parts.size() > 1 || line.empty() ? "no grip holds; --least-bad lists those that are nearest to it"
                                               : line + "; --least-bad lists such grips";
}

// Number of grips of a list, by whether they match and hold.
std::string counts_text(const sweeps::Ranking& ranking, std::size_t list, bool has_conditions) {
  const std::uint64_t plausible = ranking.plausible[list], not_held = ranking.not_held[list], held = plausible - not_held;
  const std::string of_these = not_held > 0 ? fmt::format(", {} not held", readable_number(not_held)) : "";
  if (!has_conditions) {
    return fmt::format("{} feasible and plausible{}", counted(plausible, "grip is", "grips are"),
                       of_these.empty() ? "" : "; of these" + of_these.substr(1));
  }
  return fmt::format("{} of {}{} {}{}", readable_number(ranking.matching[list]),
                     counted(held, "feasible, plausible grip", "feasible, plausible grips"), not_held > 0 ? " that hold" : "",
                     held == 1 ? "matches" : "match", of_these);
}

std::string ranking_text(const RankedResults& results, const std::vector<JointList>& lists, const RankArguments& arguments,
                         sweeps::ListView view) {
  std::string text;
  for (const JointList& list : lists) {
    std::uint64_t held = 0, not_held = 0;
    std::string counts;
    for (const auto& [r, place] : list.parts) {
      const sweeps::Ranking& ranking = results[r]->ranking;
      held += ranking.plausible[place] - ranking.not_held[place];
      not_held += ranking.not_held[place];
      const RankedResult& one = *results[r];
      const std::string of_result = results.size() > 1 ? one_line(one.result.path()) + ": " : "";
      counts += fmt::format("  {}{}\n", of_result, counts_text(ranking, place, !arguments.where.empty()));
      const std::size_t vessel = place / one.plan.hand_scales();
      const double gate = gate_tolerance(one.scene, one.result.empty_masses()[vessel]);
      const std::string at_gate = sweeps::gate_text(ranking.at_gate[place], gate);
      if (!at_gate.empty()) counts += fmt::format("  {}{}\n", of_result, at_gate);
      view.score_tolerance = score_tolerance(sweeps::read_weights(arguments.weights, one.scene), gate);
    }
    std::vector<sweeps::BestGrip> grips;
    view.results.clear();
    for (const sweeps::MergedGrip& grip : list.grips) {
      grips.push_back(grip.grip);
      if (results.size() > 1) view.results.push_back(one_line(results[grip.ranking]->result.path()));
    }
    const RankedResult& first = *results[list.parts.front().first];
    const std::string verdict = held == 0 && not_held > 0 && !arguments.least_bad ? unheld_text(results, list)
                                : held > 0 && grips.empty()                       ? "no grip matches"
                                                                                  : sweeps::verdict_text(first.scene, grips);
    text += fmt::format("{}{}: {}\n{}", text.empty() ? "" : "\n", list.name, verdict, counts);
    text += sweeps::list_lines(first.scene, first.plan, list.parts.front().second / first.plan.hand_scales(), grips,
                               arguments.output, view);
  }
  return text;
}

std::string joint_csv(const RankedResults& results, const std::vector<JointList>& lists) {
  std::string csv = sweeps::best_csv_head(results.front()->scene);
  for (const JointList& list : lists)
    for (const sweeps::MergedGrip& grip : list.grips) {
      const RankedResult& one = *results[grip.ranking];
      csv += sweeps::best_csv_row(one.scene, one.scene.vessels[grip.list / one.plan.hand_scales()].name, grip.grip,
                                  sweeps::list_origin(one.result.path(), one.result.origin()));
    }
  return csv;
}

ExitCode rank(const RankArguments& arguments) {
  sweeps::check_rank_by(arguments.list.by);
  sweeps::ListView view = arguments.list.view();
  const int glb = arguments.glb.empty() ? 0 : static_cast<int>(parse_integer(arguments.glb, "--glb", ranges::BEST));
  if (glb > 0 && arguments.output.empty())
    throw usage_error("--glb: the name of the list is missing, which also names the glTF files; give -o LIST.csv");
  if (glb > 0 && arguments.results.size() > 1) throw usage_error("--glb: draws grips of one result; name one result alone");
  RankedResults results;
  for (const std::string& path : arguments.results) {
    for (const auto& other : results)
      if (is_same_file(path, other->result.path()))
        throw usage_error(fmt::format("rank: {} and {} are the same file; name each result once", other->result.path(), path));
    const RankedResult& one = *results.emplace_back(std::make_unique<RankedResult>(path));
    check_list_file(arguments, path, one.scene);
    check_one_rule(*results.front(), one, arguments.weights);
  }
  const RankedResult& first = *results.front();
  sweeps::RankRequest request{
      arguments.weights, arguments.where, 0, 0, 0, arguments.least_bad, sweeps::read_rank_by(arguments.list.by, first.scene)};
  view.by = request.by;
  for (const auto& one : results) request.best = std::max(request.best, sweeps::usual_length(one->result, one->scene, one->plan));
  if (!arguments.best.empty())
    request.best = static_cast<std::size_t>(parse_integer(arguments.best, "--best", {1, ranges::BEST.high}));
  if (glb > static_cast<int>(request.best))
    throw usage_error(fmt::format("--glb {0}: each list keeps only its best {1} grips; give --best {0} too", glb, request.best));
  const sweeps::OutputNames names = glb_names(arguments.output);
  sweeps::check_best_glb(first.scene, first.plan, names, glb);
  std::shared_ptr<const Evaluator> core;  // for drawings
  for (const auto& one : results) {
    request.apart =
        arguments.apart.empty() ? one->scene.output.apart : parse_quantity(arguments.apart, "--apart-mm", ranges::APART);
    const auto open_core = [&]() -> std::shared_ptr<const Evaluator> {
      if (!one->mesh_error.empty() && (request.apart > 0 || request.by == sweeps::RankBy::robust) && glb == 0)
        throw usage_error(fmt::format("{}: {}; {}--apart-mm 0 lists grips without it, however near they are to each other",
                                      one->result.path(), one->mesh_error,
                                      request.by == sweeps::RankBy::robust ? "--rank-by score with " : ""));
      if (!one->mesh_error.empty()) throw usage_error(one->result.path() + ": " + one->mesh_error);
      return make_core_evaluator(one->scene);
    };
    if (glb > 0) core = open_core();
    one->ranking = sweeps::rank_grips(one->result, one->scene, one->plan, request, open_core);
    if (!one->ranking.note.empty()) print_note(one->ranking.note);
    if (!arguments.least_bad) one->unheld = unheld_lines_of(*one);
  }
  const std::vector<JointList> lists = joint_lists(results, request);
  print(rule_line(results, arguments, request.by) + ranking_text(results, lists, arguments, view));
  if (arguments.output.empty()) return ExitCode::done;
  std::vector<std::string> files{arguments.output};
  write_whole_file(arguments.output, joint_csv(results, lists), false);
  if (core) {
    const sweeps::BestGlb written = sweeps::write_best_glb(first.scene, first.plan, core, first.ranking.lists, glb, names);
    files.insert(files.end(), written.files.begin(), written.files.end());
    for (const std::string& line : written.notes) print_note(line);
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
  add("result", arguments->results, "FILE.nc",
      "Result of `wholehand sweep`; several are ranked together, if one rule made their scores")
      ->required();
  add("--weights", arguments->weights, "TERM=W,..",
      "Weights of fingers, contacts, depth, posture, force, hold (default: the scene's)");
  add("--where", arguments->where, "CONDITION",
      "List only grips that meet this condition: \"fingers_used >= 4 and palm_depth_mm < 2\"; given again: that one too")
      ->allow_extra_args(false);
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
