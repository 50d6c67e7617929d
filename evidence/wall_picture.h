// SPDX-License-Identifier: MIT
// Pictures of where a rendered wall settles.
#pragma once

#include <string>
#include <vector>

#include "evidence/wall_sweep.h"

namespace wholehand {

// gnuplot: rates, damping, delay, encoder in one picture; integrators in another. Names of the files in `folder`.
std::string wall_script(const std::vector<WallSheet>& sheets, const std::string& folder, std::vector<std::string>& files);

}  // namespace wholehand
