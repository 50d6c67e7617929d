// SPDX-License-Identifier: MIT
// Zsh: a function for each command, which gives `_arguments` what the command has.
#include <fmt/format.h>

#include "app/commands/completion.h"
#include "base/text/text.h"

namespace wholehand {
namespace {

// In single quotes of the shell.
std::string zsh_word(const std::string& text) {
  std::string inside;
  for (const char c : text) inside += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + inside + "'";
}

// For `_arguments`, where brackets and colons have a meaning.
std::string zsh_plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

// Names of files. Brackets around one ending would be a qualifier.
std::string zsh_pattern(const std::vector<std::string>& endings) {
  return endings.size() == 1 ? "*." + endings.front() : fmt::format("*.({})", joined(endings, "|"));
}

// What completes the value: the third part of an argument of `_arguments`.
std::string zsh_action(const CompletedValue& value) {
  if (value.has_folders) return "_files -/";
  const bool is_any = !value.endings.empty() && value.endings.front() == "*";
  if (value.words.empty() && value.endings.empty()) return " ";
  if (value.words.empty()) return is_any ? "_files" : fmt::format("_files -g \"{}\"", zsh_pattern(value.endings));
  const std::string words = zsh_plain(joined(value.words, " "));
  if (value.endings.empty()) return "(" + words + ")";
  // a space before it: called without further arguments
  return fmt::format(" _wholehand_words_or_files \"{}\" \"{}\" \"{}\"", words, zsh_pattern(value.endings),
                     zsh_plain(joined(value.before_files, " ")));
}

void add_zsh_option(const CompletedOption& option, std::string& text) {
  const std::string value = option.takes_value ? fmt::format(":{}:{}", zsh_plain(option.label), zsh_action(option.value)) : "";
  const std::string help = "[" + zsh_plain(option.help) + "]";
  for (const std::string& name : option.names) {
    // a name excludes the others, unless it may be given again
    std::string before = option.takes_many ? "*" : fmt::format("({})", joined(option.names, " "));
    text += " \\\n    " + zsh_word(before + name + (option.takes_value && name.starts_with("--") ? "=" : "") + help + value);
  }
}

// `name`: "_wholehand_stability_wall".
void add_zsh_function(const CompletedCommand& command, const std::string& name, std::string& text) {
  std::string function = fmt::format("{}() {{\n  local curcontext=$curcontext state line\n  _arguments -C -s", name);
  for (const CompletedOption& option : command.options) add_zsh_option(option, function);
  for (const CompletedOption& argument : command.arguments)
    function +=
        " \\\n    " + zsh_word((argument.takes_many ? "*:" : ":") + zsh_plain(argument.label) + ":" + zsh_action(argument.value));
  if (!command.commands.empty()) {
    function +=
        " \\\n    ':command:->command' '*::argument:->argument'\n  case $state in\n    command)\n      local -a commands=(\n";
    for (const CompletedCommand& one : command.commands)
      function += "        " + zsh_word(one.name + ":" + zsh_plain(one.help)) + "\n";
    function += "      )\n      _describe command commands\n      ;;\n    argument)\n      case $words[1] in\n";
    for (const CompletedCommand& one : command.commands) function += fmt::format("        {0}) {1}_{0} ;;\n", one.name, name);
    function += "      esac\n      ;;\n  esac";
  }
  text += function + "\n}\n\n";
  for (const CompletedCommand& one : command.commands) add_zsh_function(one, name + "_" + one.name, text);
}

constexpr const char* ZSH_HEAD = R"zsh(#compdef wholehand
# zsh completion for wholehand, written by `wholehand completion zsh`

# $1: words; $2: names of files; $3: those of the words that go on with a file. Without such a word files stand for themselves.
_wholehand_words_or_files() {
  local -a before=(${=3}) open=(${(M)${=1}:#*:}) whole=(${${=1}:#*:})
  local -i nothing=1
  if (( $#before )) && compset -P "(${(j:|:)before})"; then
    _path_files -g "$2" && nothing=0
    _path_files -/ && nothing=0
    return nothing
  fi
  compadd -- $whole && nothing=0
  (( $#open )) && compadd -S '' -- $open && nothing=0
  (( $#before )) && return nothing
  _path_files -g "$2" && nothing=0
  _path_files -/ && nothing=0
  return nothing
}

)zsh";

}  // namespace

std::string zsh_completion(const CompletedCommand& program) {
  std::string text = ZSH_HEAD;
  add_zsh_function(program, "_wholehand", text);
  return text + "_wholehand \"$@\"\n";
}

}  // namespace wholehand
