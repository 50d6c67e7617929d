// SPDX-License-Identifier: MIT
// Fish: a line for each option and each argument, with the command to which it belongs as its condition.
#include <fmt/format.h>

#include <algorithm>

#include "app/commands/completion.h"
#include "base/text/text.h"

namespace wholehand {
namespace {

std::string fish_word(const std::string& text) {
  std::string inside;
  for (const char c : text) inside += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return "'" + inside + "'";
}

// Arguments of `complete` for a value: -a with what is offered. Files are those of a list, since -F would add all of them.
std::string fish_value(const CompletedValue& value) {
  std::vector<std::string> parts;
  const std::vector<std::string>& before = value.before_files;
  for (const std::string& word : value.words) {
    const bool has_file = std::find(before.begin(), before.end(), word) != before.end();
    parts.push_back(has_file ? fmt::format("(__wholehand_after {} .{})", word, value.endings.front()) : word);
  }
  if (value.has_folders) parts.push_back("(__fish_complete_directories)");
  if (before.empty())
    for (const std::string& ending : value.endings)
      parts.push_back(ending == "*" ? "(__fish_complete_path)" : fmt::format("(__fish_complete_suffix .{})", ending));
  return parts.empty() ? "" : " -a " + fish_word(joined(parts, " "));
}

void add_fish_option(const CompletedOption& option, const std::string& condition, std::string& text) {
  text += "complete -c wholehand -f" + condition;
  for (const std::string& name : option.names) text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (option.takes_value) text += " -r" + fish_value(option.value);
  text += " -d " + fish_word(option.help) + "\n";
}

// `path`: "", "sweep", "stability wall".
void add_fish_command(const CompletedCommand& command, const std::string& path, std::string& text) {
  const std::string condition = fmt::format(" -n {}", fish_word(fmt::format("__wholehand_at {}", path)));
  for (const CompletedOption& option : command.options) add_fish_option(option, condition, text);
  for (const CompletedOption& argument : command.arguments) {
    const std::string value = fish_value(argument.value);
    if (!value.empty()) text += "complete -c wholehand -f" + condition + value + "\n";
  }
  for (const CompletedCommand& one : command.commands)
    text += "complete -c wholehand -f" + condition + " -a " + one.name + " -d " + fish_word(one.help) + "\n";
  for (const CompletedCommand& one : command.commands) add_fish_command(one, path.empty() ? one.name : path + " " + one.name, text);
}

// Words that follow one another, as a condition: a path that goes on in a known command is not this one.
constexpr const char* FISH_HEAD = R"fish(# fish completion for wholehand, written by `wholehand completion fish`

# whether the words before the cursor name this command and none of its own commands
function __wholehand_at
    set -l path
    for word in (commandline -opc)[2..]
        contains -- "$path $word" $__wholehand_commands; and set path "$path $word"
    end
    set -l wanted (string join '' ' '$argv)
    test "$path" = "$wanted"
end

# a word with ':' and a file with an ending
function __wholehand_after
    echo $argv[1]
    string match -q -- "$argv[1]*" (commandline -ct); or return
    for file in (__fish_complete_suffix (string replace -r -- "^$argv[1]" '' (commandline -ct)) $argv[2])
        echo $argv[1]$file
    end
end

)fish";

void add_fish_paths(const CompletedCommand& command, const std::string& path, std::string& text) {
  for (const CompletedCommand& one : command.commands) {
    text += " " + fish_word(path + " " + one.name);
    add_fish_paths(one, path + " " + one.name, text);
  }
}

}  // namespace

std::string fish_completion(const CompletedCommand& program) {
  std::string text = FISH_HEAD;
  text += "set -g __wholehand_commands";
  add_fish_paths(program, "", text);
  text += "\n\ncomplete -c wholehand -f\n";
  add_fish_command(program, "", text);
  return text;
}

}  // namespace wholehand
