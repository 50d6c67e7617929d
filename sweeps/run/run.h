// SPDX-License-Identifier: MIT
// A sweep from a scene to its files: what `wholehand sweep` does.
#pragma once

#include "base/text/error.h"
#include "sweeps/run/sweep_options.h"

namespace wholehand::sweeps {

// Sweeps every grip of the scene. Writes NAME.nc, NAME.best.csv, NAME.<vessel>.svg and NAME.<vessel>.<rank>.glb; prints the device, the best grips
// and counts of every vessel, and the times to stdout, notes and progress to stderr. Returns `done`, or `interrupted` after SIGINT or SIGTERM
// with NAME.nc.partial left for --resume. Throws Error.
ExitCode run_sweep(const Scene& scene, const SweepOptions& options);
// The same with other parts, where the choice says, or else the options. Meshes are read, or SweepParts::prepare reads them.
ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const BackendChoice& choice, const SweepParts& parts);
ExitCode run_sweep(const Scene& scene, const SweepOptions& options, const SweepParts& parts);

}  // namespace wholehand::sweeps
