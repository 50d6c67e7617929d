// SPDX-License-Identifier: MIT
// Tail probabilities that significance tests need, and a quantile for intervals.
#pragma once

namespace wholehand {

// The regularized incomplete beta function I_x(a, b), a and b > 0, x in [0, 1]: its continued fraction (Abramowitz & Stegun 26.5.8) by Lentz's
// method. NaN gives NaN. The relative error is 1e-12 for a and b up to 100, and 1e-9 up to 1e5.
double incomplete_beta(double a, double b, double x);

// P(F > f) of Fisher's F with these degrees of freedom. NaN gives NaN.
double f_tail(double f, double above, double below);

// The quantile of the chi-square distribution at p, 0 < p < 1, with `freedom` degrees of freedom, 1 to 1e4, to 1e-9 of itself.
double chi_square_quantile(double p, double freedom);

}  // namespace wholehand
