// SPDX-License-Identifier: MIT
// What a simulated rank computes and writes with: time passes, and nothing else happens.
#pragma once

#include "core/scene.h"
#include "sweeps/run/sweep_options.h"

namespace wholehand::scale {

// A scene with `grips` grips that keeps nothing in its file. Its lists are as long as the reports of the machine.
Scene simulated_scene(std::uint64_t grips, int entries);

// The parts of a sweep for the rank that calls it. The scene must outlive them.
sweeps::SweepParts simulated_parts(const Scene& scene);

}  // namespace wholehand::scale
