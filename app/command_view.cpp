// wholehand view: a recorded session, or the best grips of a sweep, in the browser.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "app/commands.h"
#include "app/scene_reader.h"
#include "app/serve_view.h"
#include "app/validators.h"
#include "app/values.h"
#include "app/view_grips.h"
#include "app/view_recording.h"
#include "sweeps/best_reader.h"
#include "sweeps/grip_methods.h"
#include "sweeps/mesh_vessel.h"

namespace wholehand {
namespace {

constexpr std::size_t MOST_SHOWN = 100;  // grips a vessel: a longer list is not for eyes

struct ViewArguments {
  std::string file, port;
};

// Recordings are classic NetCDF, results NetCDF-4.
bool is_result(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(8, ' ');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return start == "\x89HDF\r\n\x1a\n";
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

void view_recording(const std::string& path, int port) {
  Recording recording = read_recording(path);
  if (!recording.note.empty()) std::fprintf(stderr, "wholehand: %s\n", recording.note.c_str());
  Scene scene = parse_scene(recording.info.scene_text, recording.info.scene_file);
  load_meshes(scene, "core");
  const RecordingView view(scene, std::move(recording));
  serve_view(view.content(file_name(path)), port, false);
}

void view_result(const std::string& path, int port) {
  const RecordedBest best = read_best(path);
  Scene scene = parse_scene(best.scene_text, best.scene_file.empty() ? path : best.scene_file);
  if (best.vessels.size() != scene.vessels.size())
    throw usage_error(fmt::format("{}: its scene has other vessels than it says", path));
  load_meshes(scene, "core");
  std::vector<ViewedGrip> grips;
  std::vector<std::string> notes;
  for (std::size_t v = 0; v < best.vessels.size(); ++v) {
    const std::size_t shown = std::min(best.vessels[v].size(), MOST_SHOWN);
    if (shown < best.vessels[v].size())
      notes.push_back(fmt::format("{}: the first {} of {} are shown", scene.vessels[v].name, shown, best.vessels[v].size()));
    for (std::size_t k = 0; k < shown; ++k)
      grips.push_back({v, best.vessels[v][k].grip, fmt::format("{}, rank {}", scene.vessels[v].name, k + 1)});
  }
  const GripsView view(scene, grips, notes);
  for (const std::string& note : notes) std::fprintf(stderr, "wholehand: view: %s\n", note.c_str());
  serve_view(view.content(file_name(path), scene_axes(scene)), port, false);
}

ExitCode view(const ViewArguments& arguments) {
  const int port = parse_view_port(arguments.port, true);
  if (is_result(arguments.file)) {
    view_result(arguments.file, port);
  } else {
    view_recording(arguments.file, port);
  }
  return ExitCode::done;
}

}  // namespace

void add_view_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand("view", "A recorded session, or the best grips of a sweep, in the browser");
  command->add_option("file", arguments->file, "A recording of `wholehand live --record`, or a result of `wholehand sweep`")
      ->type_name("FILE.nc")
      ->required()
      ->check(not_empty());
  command->add_option("--view-port", arguments->port, "Port on 127.0.0.1 (any that is free)")->type_name("N")->check(not_empty());
  command->callback([arguments, &action] { action = [arguments] { return view(*arguments); }; });
}

}  // namespace wholehand
