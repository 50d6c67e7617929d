// SPDX-License-Identifier: MIT
// wholehand help: how a command is used, as its --help says it.
#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "app/commands/command_names.h"
#include "app/commands/commands.h"
#include "base/system/output.h"

namespace wholehand {
namespace {

ExitCode help(const CLI::App& app, const std::vector<std::string>& path) {
  const CLI::App* command = &app;
  for (const std::string& name : path) {
    const auto found = command->get_subcommands([&name](const CLI::App* one) { return one->get_name() == name; });
    if (found.empty()) throw usage_error(unknown_command(*command, name));
    command = found.front();
  }
  // not command->help(), which would show the help of this very command
  print(command->get_formatter()->make_help(command, full_name(*command), CLI::AppFormatMode::Normal));
  return ExitCode::done;
}

}  // namespace

void add_help_command(CLI::App& app, Action& action) {
  const auto path = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("help", "Show what a command does and which options it has");
  command->add_option("command", *path, "Name of a command (default: show all commands)")->type_name("COMMAND");
  command->callback([&app, path, &action] { action = [&app, path] { return help(app, *path); }; });
}

}  // namespace wholehand
