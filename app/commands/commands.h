// SPDX-License-Identifier: MIT
// The commands: each adds itself to the command line and, once parsing selects it, stores its work in `action`.
#pragma once

#include <functional>

#include "base/text/error.h"
#include "core/scene.h"
#include "sweeps/run/sweep_options.h"

namespace CLI {
class App;
}

namespace wholehand {

using Action = std::function<ExitCode()>;

// Sweeps the scene that `read_scene` returns.
using SweepRunner = std::function<ExitCode(const std::function<Scene()>& read_scene, const sweeps::SweepOptions& options)>;

void add_sweep_command(CLI::App& app, Action& action);                                 // by this process alone
void add_shared_sweep_command(CLI::App& app, Action& action, const SweepRunner& run);  // by many
void add_merge_command(CLI::App& app, Action& action);
void add_rank_command(CLI::App& app, Action& action);
void add_compare_command(CLI::App& app, Action& action);
void add_report_command(CLI::App& app, Action& action);
void add_grip_command(CLI::App& app, Action& action);
void add_trials_command(CLI::App& app, Action& action);
void add_study_command(CLI::App& app, Action& action);
void add_check_command(CLI::App& app, Action& action);
void add_error_time_command(CLI::App& app, Action& action);
void add_stability_command(CLI::App& app, Action& action);
void add_live_command(CLI::App& app, Action& action);
void add_session_command(CLI::App& app, Action& action);
void add_view_command(CLI::App& app, Action& action);
void add_devices_command(CLI::App& app, Action& action);
void add_new_command(CLI::App& app, Action& action);
void add_mesh_command(CLI::App& app, Action& action);
void add_scenes_command(CLI::App& app, Action& action);
void add_help_command(CLI::App& app, Action& action);
void add_completion_command(CLI::App& app, Action& action);

}  // namespace wholehand
