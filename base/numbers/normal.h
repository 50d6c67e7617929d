// SPDX-License-Identifier: MIT
// The normal distribution.
#pragma once

namespace wholehand {

// The quantile of the standard normal distribution at p, 0 < p < 1, to 1e-9: P. J. Acklam's rational approximation and one step of Halley's method.
// Infinite at 0 and 1.
double normal_quantile(double p);

}  // namespace wholehand
