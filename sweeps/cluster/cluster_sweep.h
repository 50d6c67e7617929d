// SPDX-License-Identifier: MIT
// One sweep by all ranks of an MPI job, into one file.
#pragma once

#include <functional>

#include "base/system/interrupt.h"
#include "base/text/error.h"
#include "core/scene.h"
#include "sweeps/cluster/team.h"
#include "sweeps/run/sweep_options.h"

namespace wholehand::sweeps {

// Does what run_sweep does, shared among any number of ranks. The file is the same byte for byte, except times and names of devices, and so are lists
// and text. Every rank calls it. Rank 0 prints. If a rank fails, all ranks throw its error, with the line on rank 0 alone (the others' is empty).
// Every rank reads the scene itself; if the scenes differ, the sweep is refused. `interrupt` exists before, because devices may take long to open.
ExitCode run_cluster_sweep(Team& team, const std::function<Scene()>& read_scene, const SweepOptions& options,
                           InterruptGuard& interrupt);

// The same with other parts, for a scene that has been read.
ExitCode run_cluster_sweep(Team& team, const Scene& scene, const SweepOptions& options, const SweepParts& parts,
                           InterruptGuard& interrupt);

// For a rank that ends early, instead: the others, which wait for it, end with this error.
void leave_cluster_sweep(Team& team, const Error& error);

}  // namespace wholehand::sweeps
