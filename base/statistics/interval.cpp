// SPDX-License-Identifier: MIT
#include "base/statistics/interval.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wholehand {

Share share_of(std::size_t yes, std::size_t of) {
  Share share{yes, of, std::numeric_limits<double>::quiet_NaN(), {}};
  if (of == 0) return share;
  const double n = static_cast<double>(of), p = static_cast<double>(yes) / n, square = NORMAL_95 * NORMAL_95;
  const double middle = (p + square / (2 * n)) / (1 + square / n);
  const double half = NORMAL_95 / (1 + square / n) * std::sqrt(p * (1 - p) / n + square / (4 * n * n));
  share.share = p;
  share.interval = {std::max(0.0, middle - half), std::min(1.0, middle + half)};
  return share;
}

double percentile_of(std::span<const double> ascending, double share) {
  const double place = share * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return ascending[below] + (place - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

Interval percentile_interval(std::span<const double> values) {
  if (values.empty()) return {};
  std::vector<double> ascending(values.begin(), values.end());
  std::sort(ascending.begin(), ascending.end());
  return {percentile_of(ascending, 0.025), percentile_of(ascending, 0.975)};
}

}  // namespace wholehand
