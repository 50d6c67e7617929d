// SPDX-License-Identifier: MIT
// wholehand view: a recorded session or trial, or the best grips of a sweep, in the browser.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/result_scene.h"
#include "app/commands/validators.h"
#include "app/commands/view_grip.h"
#include "app/program/values.h"
#include "app/viewer/grips.h"
#include "app/viewer/recording.h"
#include "app/viewer/serve_view.h"
#include "base/files/files.h"
#include "base/system/output.h"
#include "base/text/readable.h"
#include "core/file_kind.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/recordings/recording.h"
#include "sweeps/grips/methods.h"
#include "sweeps/result/grip_lists.h"

namespace wholehand {
namespace {

constexpr std::size_t MOST_SHOWN = 100;  // grips per vessel: a longer list is unreadable

struct ViewArguments {
  std::string file, port, list;
};

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

// Does not call another kind of file a damaged recording.
void check_is_recording(const std::string& path) {
  constexpr const char* TAKEN =
      "; view takes a recording of `wholehand live --record` or of `wholehand trials`, or a result of `wholehand sweep`; "
      "`wholehand grip --view` shows a grip of a scene";
  std::error_code failed;
  const std::vector<std::string> shipped = shipped_scenes();
  if (!std::filesystem::exists(path, failed) && std::find(shipped.begin(), shipped.end(), path) != shipped.end())
    throw usage_error(path + ": is a shipped scene" + TAKEN);
  const FileKind kind = file_kind_at(path);
  if (kind == FileKind::recording || !std::filesystem::is_regular_file(path, failed)) return;
  std::string what = wrong_kind(kind, "a recording or a result");
  if (what.empty()) what = "is neither a recording nor a result";
  if (!is_wrapping(kind)) what += TAKEN;
  throw usage_error(path + ": " + what);
}

void view_recording(const std::string& path, int port) {
  device::Recording recording = device::read_recording(path);
  if (!recording.note.empty()) print_note(recording.note);
  Scene scene = device::scene_of_recording(recording.info);
  follow_moved_scene(scene, path);
  load_meshes(scene);
  const RecordingView view(scene, std::move(recording));
  serve_view(view.content(file_name(path)), port, false);
}

void view_result(const std::string& path, const std::string& list_file, int port) {
  sweeps::SweepResult result(path);
  const Scene scene = whole_scene_of_result(result);
  const sweeps::Plan plan(scene, sweeps::keeps_vectors(result.variables()));
  result.use(scene, plan);
  if (list_file.empty() && !result.lists_best())
    throw usage_error(fmt::format("{}: this result lists no best grips; sweep with --best 1 or more", path));
  const sweeps::GripLists lists =
      list_file.empty() ? sweeps::lists_of_sweep(result, scene, plan) : sweeps::read_grip_lists(list_file, result, scene, plan);
  std::vector<ViewedGrip> grips;
  std::vector<std::string> notes;
  for (std::size_t k = 0; k < lists.size(); ++k) {
    const std::string name = sweeps::list_name(scene, plan, k);
    const std::size_t vessel = k / plan.hand_scales(), shown = std::min(lists[k].size(), MOST_SHOWN);
    const auto refined =
        list_file.empty() ? result.refined(vessel, k % plan.hand_scales()) : std::vector<std::optional<sweeps::RefinedGrip>>{};
    const auto robust = list_file.empty() ? result.robust(vessel, k % plan.hand_scales()) : std::vector<sweeps::RobustScore>{};
    if (shown < lists[k].size())
      notes.push_back(
          fmt::format("{}: the first {} of {} are shown", name, readable_number(shown), readable_number(lists[k].size())));
    for (std::size_t i = 0; i < shown; ++i) {
      const sweeps::RankedCandidate& ranked = lists[k][i];
      ViewedGrip grip{vessel, plan.grip(vessel, ranked.candidate.index), fmt::format("{}, rank {}", name, ranked.rank)};
      if (!list_file.empty()) grip.score = ranked.candidate.score;
      if (i < refined.size() && refined[i]) grip.refined = RefinedView{refined[i]->grip, refined[i]->score};
      if (i < robust.size() && !std::isnan(robust[i].low)) grip.robust = RobustView{robust[i].mean, robust[i].low};
      grips.push_back(grip);
    }
  }
  const GripsView view(scene, grips, notes);
  for (const std::string& note : notes) print_note("view: " + note);
  serve_view(view.content(file_name(path), sweeps::scene_axes(scene, grips.empty() ? 0 : grips.front().vessel)), port, false);
}

ExitCode view(const ViewArguments& arguments) {
  const int port = parse_view_port(arguments.port, true);
  if (is_result(arguments.file)) {  // recordings are classic NetCDF
    view_result(arguments.file, arguments.list, port);
  } else {
    if (!arguments.list.empty())
      throw usage_error("--list: the option needs a result of a sweep, and " + arguments.file + " is not a result");
    check_is_recording(arguments.file);
    view_recording(arguments.file, port);
  }
  return ExitCode::done;
}

}  // namespace

void view_grip(const Scene& scene, std::size_t vessel, const GripInput& grip, const std::string& label,
               const sweeps::StateAxes& axes, int port, bool has_json) {
  std::vector<std::string> notes;
  const GripsView view(scene, {{vessel, grip, label}}, notes);
  serve_view(view.content(scene.name, axes), port, has_json);
}

void add_view_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand("view", "Show a recorded session or trial, or the best grips of a sweep, in the browser");
  command
      ->add_option("file", arguments->file,
                   "Recording of `wholehand live --record` or of `wholehand trials`, or result of `wholehand sweep`")
      ->type_name("FILE.nc")
      ->required()
      ->check(not_empty());
  command
      ->add_option("--list", arguments->list,
                   "With a result: show the grips of this list of `wholehand rank` (default: the sweep's own list)")
      ->type_name("LIST.csv")
      ->check(not_empty());
  command->add_option("--view-port", arguments->port, "Port on 127.0.0.1 (default: any free port)")
      ->type_name("N")
      ->check(not_empty());
  command->callback([arguments, &action] { action = [arguments] { return view(*arguments); }; });
}

}  // namespace wholehand
