// SPDX-License-Identifier: MIT
// Simulates a rendered wall sample by sample.
#pragma once

#include "core/real.h"
#include "core/wall_case.h"

namespace CORE_NS {

// The largest energy (loop_energy, J) of the motion in the last `late` samples; NaN or infinite if it diverges.
double late_energy(const wholehand::WallCase& wall_case, int samples, int late);

}  // namespace CORE_NS
