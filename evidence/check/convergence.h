// SPDX-License-Identifier: MIT
// How fast an error falls with its cause.
#pragma once

#include <vector>

namespace wholehand {

// The p of error = C step^p that fits best: the slope of a line through their logarithms. Steps or errors of 0, NaN or infinity are skipped; NaN if
// fewer than two different steps are left.
double fitted_order(const std::vector<double>& steps, const std::vector<double>& errors);

}  // namespace wholehand
