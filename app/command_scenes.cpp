// SPDX-License-Identifier: MIT
// wholehand scenes: the scenes that are shipped, which every command takes by name.
#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "scene/list.h"
#include "scene/shipped.h"
#include "system/output.h"

namespace wholehand {
namespace {

ExitCode show_scenes() {
  const std::vector<std::string> names = shipped_scenes();
  if (names.empty())
    throw failure_error("the shipped scenes are missing where the program was built or installed; give a scene file");
  std::vector<std::string> files;
  for (const std::string& name : names) files.push_back(find_scene(scenes_dir() + "/" + name + ".toml"));
  print(list_scenes(files));
  return ExitCode::done;
}

}  // namespace

void add_scenes_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("scenes", "List the shipped scenes: name, vessels, purpose");
  command->callback([&action] { action = [] { return show_scenes(); }; });
}

}  // namespace wholehand
