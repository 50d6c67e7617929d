// SPDX-License-Identifier: MIT
// wholehand scenes: the scenes that are shipped, which every command takes by name, and a copy of one to edit.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>

#include "app/commands/commands.h"
#include "app/commands/validators.h"
#include "base/files/files.h"
#include "base/system/output.h"
#include "base/text/text.h"
#include "core/reader/list.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "core/reader/text.h"

namespace wholehand {
namespace {

std::vector<std::string> known_scenes() {
  std::vector<std::string> names = shipped_scenes();
  if (names.empty())
    throw failure_error("the shipped scenes are missing where the program was built or installed; give a scene file");
  return names;
}

ExitCode show_scenes() {
  const std::vector<std::string> names = known_scenes();
  std::vector<std::string> files;
  for (const std::string& name : names) files.push_back(find_scene(scenes_dir() + "/" + name + ".toml"));
  print(list_scenes(files));
  return ExitCode::done;
}

// Into the current folder.
ExitCode copy_scene(const std::string& name) {
  const std::vector<std::string> names = known_scenes();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw usage_error(fmt::format("--copy {}: no such scene; shipped scenes: {}", in_quotes(name), joined(names, ", ")));
  const std::string file = name + ".toml";
  check_output_path(file, "--copy");
  check_overwrites_nothing(file, "--copy");
  write_whole_file(file, read_scene_file(find_scene(scenes_dir() + "/" + file)).text, false);
  print(fmt::format("Wrote {0}. Next: wholehand sweep {0}\n", file));
  return ExitCode::done;
}

}  // namespace

void add_scenes_command(CLI::App& app, Action& action) {
  const auto copied = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("scenes", "List the shipped scenes: name, vessels, purpose");
  command->add_option("--copy", *copied, "Write this one to NAME.toml in the current folder, to edit it")
      ->type_name("NAME")
      ->check(not_empty());
  command->callback([copied, &action] { action = [copied] { return copied->empty() ? show_scenes() : copy_scene(*copied); }; });
}

}  // namespace wholehand
