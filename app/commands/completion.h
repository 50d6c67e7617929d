// SPDX-License-Identifier: MIT
// Completion of the command line in shells. Commands are described independently of the parser, and each shell's script is generated from that.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

// The possible values of an option or argument.
struct CompletedValue {
  std::vector<std::string> words;
  std::vector<std::string> before_files;  // words that end in ':' and continue with a file: "replay:"
  std::vector<std::string> endings;       // files with these endings, without the dot; "*": any. Only after before_files, if any
  bool has_folders = false;               // folders as values themselves
};

struct CompletedOption {
  std::vector<std::string> names;  // "--output", "-o"; none for an argument
  std::string label, help;         // label: "FILE"
  CompletedValue value;
  bool takes_value = false, takes_many = false;
};

struct CompletedCommand {
  std::string name, help;
  std::vector<CompletedOption> options, arguments;  // arguments in their order
  std::vector<CompletedCommand> commands;
};

std::string bash_completion(const CompletedCommand& program);
std::string zsh_completion(const CompletedCommand& program);
std::string fish_completion(const CompletedCommand& program);

}  // namespace wholehand
