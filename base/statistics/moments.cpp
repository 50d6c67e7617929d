// SPDX-License-Identifier: MIT
#include "base/statistics/moments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wholehand {

namespace {
constexpr double ROUNDING_SHARE = 1e-9;
}

bool varies(std::span<const double> values) {
  if (values.empty()) return false;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low > ROUNDING_SHARE * std::max(std::abs(*low), std::abs(*high));
}

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_of(std::span<const double> values) {
  if (values.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const double mean = mean_of(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

}  // namespace wholehand
