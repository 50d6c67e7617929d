// SPDX-License-Identifier: MIT
// wholehand-mpi: a sweep by many ranks, under mpirun or srun.
#include <csignal>

#include "app/commands/command_line.h"
#include "app/commands/commands.h"
#include "base/system/interrupt.h"
#include "base/text/error.h"
#include "sweeps/cluster/cluster_sweep.h"
#include "sweeps/cluster/team.h"

int main(int argc, char** argv) {
  using namespace wholehand;
  std::signal(SIGXFSZ, SIG_IGN);      // a file that grows past its limit makes the write fail, here also for MPI's own files
  InterruptGuard interrupt(SIGUSR1);  // from here on; a cluster's warning may come while ranks still find each other
  sweeps::Team team(argc, argv);
  Program program;
  program.name = "wholehand-mpi";
  program.description =
      "A sweep of `wholehand` by many machines: mpirun -n N wholehand-mpi sweep SCENE, or srun wholehand-mpi sweep SCENE.";
  program.footer =
      "All other commands are those of `wholehand`.\n"
      "Exit codes: 0 done, 2 wrong usage or input, 3 device or system failure, 130 interrupted or out of time.";
  program.is_silent = !team.is_leader();
  bool has_begun = false;
  Error own = usage_error("no sweep is asked for here; start the same on every node");
  program.on_failure = [&own](ExitCode code, const std::string& line) { own = Error(code, line); };
  program.add_commands = [&](CLI::App& app, Action& action) {
    add_shared_sweep_command(app, action, [&](const std::function<Scene()>& read_scene, const sweeps::SweepOptions& options) {
      has_begun = true;
      return sweeps::run_cluster_sweep(team, read_scene, options, interrupt);
    });
  };
  const int code = run_program(argc, argv, program);
  if (!has_begun) sweeps::leave_cluster_sweep(team, own);
  return code;
}
