// SPDX-License-Identifier: MIT
// Bash: three functions that answer what a command has, and a fixed part that finds out where the cursor is.
#include <fmt/format.h>

#include "app/commands/completion.h"
#include "base/text/text.h"

namespace wholehand {
namespace {

// Words, then "-a WORD" for those that go on with a file, "-e ENDING" for files and "-d" for folders. None of them has a space.
std::string bash_value(const CompletedValue& value) {
  std::vector<std::string> parts = value.words;
  for (const std::string& word : value.before_files) parts.push_back("-a " + word);
  for (const std::string& ending : value.endings) parts.push_back("-e " + ending);
  if (value.has_folders) parts.push_back("-d");
  return joined(parts, " ");
}

struct BashTables {
  std::string commands, options, values, arguments;
};

// `path`: "", "sweep", "stability wall".
void add_bash_command(const CompletedCommand& command, const std::string& path, BashTables& tables) {
  std::vector<std::string> names;
  for (const CompletedCommand& one : command.commands) names.push_back(one.name);
  if (!names.empty()) tables.commands += fmt::format("    '{}') echo '{}' ;;\n", path, joined(names, " "));
  names.clear();
  for (const CompletedOption& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
    if (!option.takes_value) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back(fmt::format("'{} {}'", path, name));
    tables.values += fmt::format("    {}) echo '{} {}' ;;\n", joined(patterns, " | "), option.takes_many ? "many" : "one",
                                 bash_value(option.value));
  }
  tables.options += fmt::format("    '{}') echo '{}' ;;\n", path, joined(names, " "));
  for (std::size_t k = 0; k < command.arguments.size(); ++k) {
    const CompletedOption& argument = command.arguments[k];
    tables.arguments +=
        fmt::format("    '{} '{}) echo '{}' ;;\n", path, argument.takes_many ? "*" : std::to_string(k), bash_value(argument.value));
  }
  for (const CompletedCommand& one : command.commands)
    add_bash_command(one, path.empty() ? one.name : path + " " + one.name, tables);
}

constexpr const char* BASH_FUNCTION = R"bash(
# Adds to COMPREPLY what may stand for $1, which is what is typed of it: words, files (-e ENDING) and folders (-d), but
# files only after a word if one is named (-a WORD).
_wholehand_offer() {
  local typed=$1 words= endings= is_folder= IFS=$'\n' extended
  shift
  while [ $# -gt 0 ]; do
    case "$1" in
      -e) endings="$endings${endings:+|}$2"; shift ;;
      -d) is_folder=yes ;;
      -a) break ;;
      *) words="$words $1" ;;
    esac
    shift
  done
  COMPREPLY+=($(IFS=' '; compgen -W "$words" -- "$typed"))
  case "${COMPREPLY[*]}" in *:) compopt -o nospace 2>/dev/null ;; esac
  [ -n "$endings$is_folder" ] || return
  compopt -o filenames 2>/dev/null
  case "$endings" in
    '*') COMPREPLY+=($(compgen -f -- "$typed")); return ;;
    ?*)
      extended=$(shopt -p extglob)
      shopt -s extglob
      COMPREPLY+=($(compgen -f -X "!*.@($endings)" -- "$typed"))
      eval "$extended"
      ;;
  esac
  COMPREPLY+=($(compgen -d -- "$typed"))
}

_wholehand() {
  local typed=${COMP_WORDS[COMP_CWORD]} path= option= last= takes= argument=0 k word
  COMPREPLY=()
  # Which command is it, how many arguments are there, and does an option wait for its value? Bash takes "=" and ":" for words of their own.
  for ((k = 1; k < COMP_CWORD; ++k)); do
    word=${COMP_WORDS[k]}
    if [[ $word == [=:] || ${COMP_WORDS[k - 1]} == : ]]; then
      continue
    elif [[ $word == -* ]]; then
      takes=$(_wholehand_value "$path $word")
      option=${takes:+$word} last=$word
    elif [ -n "$option" ]; then
      [ "${takes%% *}" = many ] || option=
    elif [[ " $(_wholehand_commands "$path") " == *" $word "* ]]; then
      path=${path:+$path }$word
    else
      argument=$((argument + 1))
    fi
  done
  word=${COMP_WORDS[COMP_CWORD - 1]}
  k=$((COMP_CWORD - 2))
  [[ $typed != [=:] ]] || { [ "$typed" = = ] || { k=$((k + 1)) word=:; }; typed=; }
  set -f
  if [[ $word == : ]]; then  # --device replay:FILE
    takes=$(_wholehand_value "$path $last")
    [[ ${COMP_WORDS[k - 1]} == : || $takes != *" -a ${COMP_WORDS[k]}: "* ]] || _wholehand_offer "$typed" -e "${takes##* -e }"
  elif [[ $typed == -* ]]; then
    COMPREPLY=($(compgen -W "$(_wholehand_options "$path")" -- "$typed"))
  elif [ -n "$option" ]; then
    _wholehand_offer "$typed" ${takes#* }
  else
    _wholehand_offer "$typed" $(_wholehand_commands "$path") $(_wholehand_argument "$path $argument")
  fi
  set +f
}
complete -F _wholehand wholehand
)bash";

}  // namespace

std::string bash_completion(const CompletedCommand& program) {
  BashTables tables;
  add_bash_command(program, "", tables);
  const auto table = [](const char* name, const std::string& rows) {
    return fmt::format("{}() {{\n  case \"$1\" in\n{}  esac\n}}\n", name, rows);
  };
  return "# bash completion for wholehand, written by `wholehand completion bash`\n" +
         table("_wholehand_commands", tables.commands) + table("_wholehand_options", tables.options) +
         table("_wholehand_value", tables.values) + table("_wholehand_argument", tables.arguments) + BASH_FUNCTION;
}

}  // namespace wholehand
