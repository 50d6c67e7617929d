// SPDX-License-Identifier: MIT
// Intervals of 95 %.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace wholehand {

constexpr double NORMAL_95 = 1.959963984540054;  // 97.5th percentile of the normal distribution

struct Interval {
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;
};

// `yes` of `of`, with Wilson's score interval (1927). NaN if `of` is 0.
struct Share {
  std::size_t yes = 0, of = 0;
  double share = std::numeric_limits<double>::quiet_NaN();
  Interval interval;
};
Share share_of(std::size_t yes, std::size_t of);

// A percentile of ascending values, at least one, by linear interpolation: share 0 is the first, share 1 the last.
double percentile_of(std::span<const double> ascending, double share);

// From the 2.5th to the 97.5th percentile of values in any order; NaN if there are none.
Interval percentile_interval(std::span<const double> values);

}  // namespace wholehand
