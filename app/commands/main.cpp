// SPDX-License-Identifier: MIT
// wholehand: all commands, on one machine.
#include "app/commands/command_line.h"
#include "app/commands/commands.h"

namespace {

void add_all(CLI::App& app, wholehand::Action& action) {
  wholehand::add_sweep_command(app, action);
  wholehand::add_merge_command(app, action);
  wholehand::add_rank_command(app, action);
#ifdef HAS_EVIDENCE
  wholehand::add_compare_command(app, action);
  wholehand::add_report_command(app, action);
#endif
  wholehand::add_grip_command(app, action);
#ifdef HAS_TRIALS
  wholehand::add_trials_command(app, action);
#endif
#ifdef HAS_EVIDENCE
  wholehand::add_study_command(app, action);
  wholehand::add_check_command(app, action);
  wholehand::add_error_time_command(app, action);
  wholehand::add_stability_command(app, action);
#endif
  wholehand::add_live_command(app, action);
  wholehand::add_session_command(app, action);
#ifdef HAS_VIEWER
  wholehand::add_view_command(app, action);
#endif
  wholehand::add_devices_command(app, action);
  wholehand::add_new_command(app, action);
  wholehand::add_mesh_command(app, action);
  wholehand::add_scenes_command(app, action);
  wholehand::add_help_command(app, action);
  wholehand::add_completion_command(app, action);
}

}  // namespace

int main(int argc, char** argv) {
  wholehand::Program program;
  program.name = "wholehand";
  program.description =
      "Whole-hand grasping with a two-finger gripper: score the grips of a scene, look at one, check the devices.";
  program.version_note = "\n`wholehand devices` lists the devices that compute, and the grippers";
  program.footer =
      "In a checkout of the sources, ./wholehand also tests (test), measures (bench) and packages (package) the program.\n"
      "Exit codes: 0 done, 1 the answer is no (check; grip: not feasible), 2 wrong usage or input, 3 device or system failure, 130 "
      "interrupted.";
  program.add_commands = add_all;
  return wholehand::end_process(wholehand::run_program(argc, argv, program));
}
