// SPDX-License-Identifier: MIT
// One sweep by all ranks of an MPI job, into one file.
#pragma once

#include <functional>

#include "base/system/interrupt.h"
#include "base/text/error.h"
#include "core/scene.h"
#include "sweeps/cluster/team.h"
#include "sweeps/run/sweep_options.h"
#include "sweeps/run/sweep_parts.h"

namespace wholehand {

// What run_sweep does, shared among the ranks: the same file, byte for byte but for times and names of devices, the same lists and words, however
// many there are. Every rank calls it. Rank 0 prints; an error of any rank is thrown by all, with its line on rank 0 alone (the others' is
// empty). The scene is read by every rank for itself, and refused where it is not the same. `interrupt` is there before, as devices may take
// long to open.
ExitCode run_cluster_sweep(Team& team, const std::function<Scene()>& read_scene, const SweepOptions& options,
                           InterruptGuard& interrupt);

// The same with other parts, for a scene that is read.
ExitCode run_cluster_sweep(Team& team, const Scene& scene, const SweepOptions& options, const SweepParts& parts,
                           InterruptGuard& interrupt);

// For a rank that ends before it gets there, in its place: the others wait for it, and end with this error.
void leave_cluster_sweep(Team& team, const Error& error);

}  // namespace wholehand
