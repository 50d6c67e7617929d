// SPDX-License-Identifier: MIT
// wholehand study: runs the paper's experiments with a population of virtual people, and writes the results.
#pragma once

#include "base/text/error.h"
#include "core/scene.h"
#include "evidence/studies/options.h"

namespace wholehand {

// The meshes of the scene have been read. Throws Error: (usage) the scene has no guidance points, or the folder cannot be written over; (failure) a
// file cannot be written.
ExitCode run_study(const Scene& scene, const StudyOptions& options);

}  // namespace wholehand
