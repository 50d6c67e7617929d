// SPDX-License-Identifier: MIT
// Mean and deviation of numbers.
#pragma once

#include <span>

namespace wholehand {

// Whether values differ by more than 1e-9 of the largest one; less is rounding. False if there are none.
bool varies(std::span<const double> values);

// NaN of none.
double mean_of(std::span<const double> values);
// Over n - 1; NaN for fewer than two values.
double deviation_of(std::span<const double> values);

}  // namespace wholehand
