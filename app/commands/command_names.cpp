// SPDX-License-Identifier: MIT
#include "app/commands/command_names.h"

#include <CLI/CLI.hpp>

#include "core/reader/text.h"

namespace wholehand {
namespace {

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); }))
    names.push_back(command->get_name());
  return names;
}

}  // namespace

std::string command_list(const CLI::App& app, const char* last) {
  const std::vector<std::string> names = names_of_commands(app);
  std::string list;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) list += k + 1 < names.size() ? ", " : std::string(" ") + last + " ";
    list += names[k];
  }
  return list;
}

std::string unknown_command(const CLI::App& app, const std::string& name) {
  const std::string known = command_list(app, "and");
  if (known.empty()) return full_name(app) + " has no commands of its own; found " + in_quotes(name);
  return "unknown command " + in_quotes(name) + did_you_mean(name, names_of_commands(app)) + "; the commands are " + known;
}

const CLI::App& named_command(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : named_command(*commands.front());
}

std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent ? full_name(*parent) + " " + command.get_name() : command.get_name();
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

}  // namespace wholehand
