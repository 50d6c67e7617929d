// SPDX-License-Identifier: MIT
// wholehand-mpi: a sweep by many ranks, under mpirun or srun.
#include <csignal>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure_line.h"
#include "cluster/cluster_sweep.h"
#include "cluster/team.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
[[gnu::section(".preinit_array"), gnu::used]] static void (*const before_all)() = wholehand::prepare_failure_line;
#endif

int main(int argc, char** argv) {
  using namespace wholehand;
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows past its limit is an error of the write, here of MPI's own files too
  Team team(argc, argv);
  Program program;
  program.name = "wholehand-mpi";
  program.description =
      "A sweep of `wholehand` by many machines: mpirun -n N wholehand-mpi sweep SCENE, or srun wholehand-mpi sweep SCENE.";
  program.footer =
      "All other commands are those of `wholehand`.\n"
      "Exit codes: 0 done, 2 wrong usage or input, 3 device or system failure, 130 interrupted or out of time.";
  program.is_silent = !team.is_leader();
  program.add_commands = [&team](CLI::App& app, Action& action) {
    add_shared_sweep_command(app, action, [&team](const std::function<Scene()>& read_scene, const SweepOptions& options) {
      return run_cluster_sweep(team, read_scene, options);
    });
  };
  return run_program(argc, argv, program);
}
