// SPDX-License-Identifier: MIT
// Trials from a scene to their files: what `wholehand trials` does.
#pragma once

#include "base/text/error.h"
#include "core/scene.h"
#include "evidence/trials/options.h"
#include "evidence/trials/tried.h"
#include "sweeps/result/sweep_result.h"

namespace wholehand {

// Tries grips of the scene, whose meshes are read, and writes all files into the options' folder. `result`: chooses the grips by its lists and
// scores; opened and not yet in use; null: the core's. Returns `done`, or `interrupted` after SIGINT or SIGTERM with a journal left for --resume.
// Throws Error.
ExitCode run_trials(const Scene& scene, const TrialOptions& options, const OpenTrialEngine& open,
                    sweeps::SweepResult* result = nullptr);

}  // namespace wholehand
