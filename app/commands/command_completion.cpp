// SPDX-License-Identifier: MIT
// wholehand completion: what a shell needs to complete the words of all commands. Packages install it, so --help omits it.
#include <CLI/CLI.hpp>

#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/completion.h"
#include "app/commands/validators.h"
#include "base/system/output.h"
#include "core/reader/shipped.h"
#include "core/reader/text.h"

namespace wholehand {
namespace {

constexpr const char* SHELLS = "bash zsh fish";

std::vector<std::string> split_words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

// The words that offered() names.
std::vector<std::string> offered_words(CLI::Option& option) {
  try {
    for (int k = 0;; ++k) {
      const std::string& name = option.get_validator(k)->get_name();
      if (name.starts_with(OFFERED)) return split_words(name.substr(OFFERED.size()));
    }
  } catch (const CLI::OptionNotFound&) {  // which ends the validators
    return {};
  }
}

// From the type that --help shows (SCENE, DIR, FILE, FILE.nc ...) and the option's values.
CompletedValue value_of(CLI::Option& option, const CLI::App& program) {
  CompletedValue value;
  value.words = offered_words(option);
  const std::string type = option.get_type_name();
  if (type == "COMMAND") {
    for (const CLI::App* command : program.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); }))
      value.words.push_back(command->get_name());
  } else if (type.starts_with("SCENE")) {
    value.words = shipped_scenes();
    value.endings = {"toml"};
    if (type.ends_with(".nc")) value.endings.push_back("nc");
  } else if (type == "DIR") {
    value.has_folders = true;
  } else if (type == "FILE" || type == "PATH") {
    value.endings = {"*"};
  } else if (const std::size_t dot = type.find('.');
             dot != std::string::npos && type[0] != 'T') {  // FILE.nc, LIST.csv; not TERM=W,..
    value.endings = {type.substr(dot + 1)};
  }
  for (std::string& word : value.words) {
    const std::size_t colon = word.find(":.");  // replay:.nc
    if (colon == std::string::npos) continue;
    value.endings = {word.substr(colon + 2)};
    word.resize(colon + 1);
    value.before_files.push_back(word);
  }
  return value;
}

CompletedOption described(CLI::Option& option, const CLI::App& program) {
  CompletedOption one;
  for (const std::string& name : option.get_lnames()) one.names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) one.names.push_back("-" + name);
  one.label = option.get_type_name();
  one.help = option.get_description();
  one.takes_value = option.get_items_expected_max() > 0;
  one.takes_many = option.get_items_expected_max() > 1;
  if (one.takes_value) one.value = value_of(option, program);
  return one;
}

CompletedCommand described(CLI::App& command, const CLI::App& program) {
  CompletedCommand one{command.get_name(), command.get_description(), {}, {}, {}};
  for (CLI::Option* option : command.get_options([](const CLI::Option*) { return true; }))
    (option->get_positional() ? one.arguments : one.options).push_back(described(*option, program));
  for (CLI::App* inner : command.get_subcommands([](const CLI::App* any) { return !any->get_group().empty(); }))
    one.commands.push_back(described(*inner, program));
  return one;
}

ExitCode show_completion(CLI::App& app, const std::string& shell) {
  const CompletedCommand program = described(app, app);
  if (shell == "bash") {
    print(bash_completion(program));
  } else if (shell == "zsh") {
    print(zsh_completion(program));
  } else if (shell == "fish") {
    print(fish_completion(program));
  } else {
    throw usage_error("completion " + in_quotes(shell) + "; allowed: bash, zsh or fish");
  }
  return ExitCode::done;
}

}  // namespace

void add_completion_command(CLI::App& app, Action& action) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Print what a shell needs to complete commands: bash, zsh or fish");
  command->group("");  // not in --help
  command->add_option("shell", *shell, "Name of the shell")->type_name("SHELL")->required()->check(offered(SHELLS));
  command->callback([&app, shell, &action] { action = [&app, shell] { return show_completion(app, *shell); }; });
}

}  // namespace wholehand
