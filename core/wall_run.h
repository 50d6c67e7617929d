// SPDX-License-Identifier: MIT
// A rendered wall, sample after sample.
#pragma once

#include "core/real.h"
#include "core/wall_case.h"

namespace CORE_NS {

// The largest energy (loop_energy, J) that the last `late` samples leave in the motion; NaN or infinite where it flies apart.
double late_energy(const wholehand::WallCase& wall_case, int samples, int late);

}  // namespace CORE_NS
