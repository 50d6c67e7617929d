// SPDX-License-Identifier: MIT
// The command line: finds the command, runs it, and turns any error into one line and an exit code.
#pragma once

#include <functional>
#include <string>

#include "app/commands/commands.h"

namespace wholehand {

struct Program {
  std::string name, description, footer;
  std::string version_note;  // after name and version
  std::function<void(CLI::App& app, Action& action)> add_commands;
  bool is_silent = false;  // prints nothing for --help or errors: another process does
  std::function<void(ExitCode code, const std::string& line)> on_failure;  // also receives failures; may be empty
};

// Returns the exit code. A program that links this installs the last line of a failure (app/program/failure_line.h) at its start.
int run_program(int argc, char** argv, const Program& program);

// The code for main to return. Ends the process if a driver still holds threads of it.
int end_process(int code);

}  // namespace wholehand
