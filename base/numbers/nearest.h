// SPDX-License-Identifier: MIT
// Values of a list that come back rounded to a coarser precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace wholehand {

// The place in `listed`, which is not empty, of the value nearest to the number `told`.
inline std::size_t nearest_place(const std::vector<double>& listed, double told) {
  const auto nearest = std::min_element(listed.begin(), listed.end(),
                                        [told](double a, double b) { return std::abs(a - told) < std::abs(b - told); });
  return static_cast<std::size_t>(nearest - listed.begin());
}

// The listed value nearest to `told`; NaN for NaN.
inline double nearest_value(const std::vector<double>& listed, double told) {
  return std::isnan(told) ? told : listed[nearest_place(listed, told)];
}

}  // namespace wholehand
