// SPDX-License-Identifier: MIT
// wholehand-sweep: only the command `sweep`. ./wholehand sweep builds just this program, so that the first grips come soon.
#include "app/commands/command_line.h"
#include "app/commands/commands.h"

int main(int argc, char** argv) {
  wholehand::Program program;
  program.name = "wholehand";  // as users type it
  program.description =
      "The sweeps of `wholehand`, without its other commands. In a checkout, ./wholehand sweep builds and starts this program.";
  program.footer = "Exit codes: 0 done, 2 wrong usage or input, 3 device or system failure, 130 interrupted.";
  program.add_commands = wholehand::add_sweep_command;
  return wholehand::end_process(wholehand::run_program(argc, argv, program));
}
