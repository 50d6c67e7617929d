// SPDX-License-Identifier: MIT
// Names of commands and their options for messages, taken from the command line so that no list is kept twice.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace wholehand {

// "a, b or c" of the commands of `app`, in the order of --help; `last`: the word before the last one.
std::string command_list(const CLI::App& app, const char* last);

// The error message for a command that `app` does not have.
std::string unknown_command(const CLI::App& app, const std::string& name);

// The innermost command named by the arguments; `app` itself before one is known.
const CLI::App& named_command(const CLI::App& app);

// "wholehand stability wall".
std::string full_name(const CLI::App& command);

// "--output", "-o" ..
std::vector<std::string> option_names(const CLI::App& command);

}  // namespace wholehand
