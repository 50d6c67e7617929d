// SPDX-License-Identifier: MIT
// Looks up values of a list after they were rounded to a coarser precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace wholehand {

// The index in `listed`, which is not empty, of the value nearest to the number `value`.
inline std::size_t nearest_place(const std::vector<double>& listed, double value) {
  const auto nearest = std::min_element(listed.begin(), listed.end(),
                                        [value](double a, double b) { return std::abs(a - value) < std::abs(b - value); });
  return static_cast<std::size_t>(nearest - listed.begin());
}

// The listed value nearest to `value`; NaN for NaN.
inline double nearest_value(const std::vector<double>& listed, double value) {
  return std::isnan(value) ? value : listed[nearest_place(listed, value)];
}

}  // namespace wholehand
