// SPDX-License-Identifier: MIT
// The command line: finds the command, runs it, and turns whatever goes wrong into one line and an exit code.
#pragma once

#include <functional>
#include <string>

#include "app/commands/commands.h"

namespace wholehand {

struct Program {
  std::string name, description, footer;
  std::string version_note;  // after name and version
  std::function<void(CLI::App& app, Action& action)> add_commands;
  bool is_silent = false;  // says nothing of --help and of what goes wrong: another process does
  std::function<void(ExitCode code, const std::string& line)> on_failure;  // also receives failures; may be empty
};

// Answers the exit code. Whoever links it has the last line of a failure (app/program/failure_line.h) from the start of the process.
int run_program(int argc, char** argv, const Program& program);

// The code for main to return. Ends the process where a driver keeps threads of it.
int end_process(int code);

}  // namespace wholehand
