// SPDX-License-Identifier: MIT
// How two numbers go together.
#pragma once

#include <optional>
#include <span>

#include "base/statistics/interval.h"

namespace wholehand {

// Why there is no correlation.
enum class Lack {
  none,          // there is one
  fewer_than_3,  // pairs
  one_x,         // x does not vary by more than 1e-9 of its largest value, which is rounding
  one_y,         // nor y
  never,
  always,  // a yes or no that is the same for all
};

// A coefficient of correlation in [-1, 1], or why there is none.
struct Correlation {
  std::optional<double> r;
  Lack lack = Lack::none;
};

// Pearson's r of pairs.
Correlation pearson(std::span<const double> x, std::span<const double> y);

// Point-biserial r of a number with a yes or no: (M1 - M0) / s sqrt(p q), with the means of x for yes and for no, the deviation of all x (over n) and
// the shares of yes and no. It equals Pearson's r with 1 for yes and 0 for no, and is absent when that is.
Correlation point_biserial(std::span<const double> x, std::span<const char> yes);

// The 95 % interval of a Pearson's r of so many pairs, by Fisher's transform: tanh(atanh r +- 1.96 / sqrt(n - 3)). NaN for three pairs or fewer.
Interval correlation_interval(double r, std::size_t pairs);

// The two-sided p-value of r, from Student's t with n - 2 degrees of freedom. NaN for two pairs or fewer.
double correlation_p(double r, std::size_t pairs);

}  // namespace wholehand
