// SPDX-License-Identifier: MIT
// The end of a sweep whose grips are all computed: the final choice of the best, and the files.
#pragma once

#include "base/system/interrupt.h"
#include "sweeps/lists/best.h"
#include "sweeps/result/result_checksums.h"
#include "sweeps/result/result_file.h"
#include "sweeps/run/sweep.h"
#include "sweeps/run/sweep_state.h"

namespace wholehand::sweeps {

// The candidates of each list, with only their places known.
BestLists find_best(const Sweep& sweep, const SweepState& state);

// Chooses the best of them, with refined grips and robust scores. It may take as long as the sweep. False: interrupted.
bool choose_best(const Sweep& sweep, BestLists& best, InterruptGuard& interrupt);

// Writes the files and prints the lists and the times, once everything is known. `checksums`: of the result, as far as ranks have found some.
void publish(const Sweep& sweep, SweepState& state, ResultFile& file, BestLists best, ChecksumParts checksums = {});

}  // namespace wholehand::sweeps
