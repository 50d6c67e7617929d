// SPDX-License-Identifier: MIT
// The normal distribution.
#pragma once

namespace wholehand {

// The number that a standard normal variable is below with the probability p, 0 < p < 1. To 1e-9: P. J. Acklam's rational
// approximation and one step of Halley's method. Infinite at 0 and 1.
double normal_quantile(double p);

}  // namespace wholehand
