// SPDX-License-Identifier: MIT
#include "statistics/running_correlation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "statistics/moments.h"

namespace wholehand {

void RunningCorrelation::Side::widen(double value, bool is_first) {
  low = is_first ? value : std::min(low, value);
  high = is_first ? value : std::max(high, value);
}

// The least and the largest value decide, as they do of all values.
bool RunningCorrelation::Side::varies() const { return wholehand::varies(std::array{low, high}); }

void RunningCorrelation::add(double x, double y) {
  x_.widen(x, pairs_ == 0);
  y_.widen(y, pairs_ == 0);
  ++pairs_;
  const auto n = static_cast<double>(pairs_);
  const double dx = x - x_.mean, dy = y - y_.mean;
  x_.mean += dx / n;
  y_.mean += dy / n;
  x_.squares += dx * (x - x_.mean);
  y_.squares += dy * (y - y_.mean);
  products_ += dx * (y - y_.mean);
}

double RunningCorrelation::mean_y() const { return pairs_ == 0 ? std::numeric_limits<double>::quiet_NaN() : y_.mean; }

Correlation RunningCorrelation::pearson() const {
  if (pairs_ < 3) return {std::nullopt, Lack::fewer_than_3};
  if (!x_.varies()) return {std::nullopt, Lack::one_x};
  if (!y_.varies()) return {std::nullopt, Lack::one_y};
  return {std::clamp(products_ / std::sqrt(x_.squares) / std::sqrt(y_.squares), -1.0, 1.0)};
}

Correlation RunningCorrelation::point_biserial() const {
  if (pairs_ >= 3 && y_.high == 0) return {std::nullopt, Lack::never};
  if (pairs_ >= 3 && y_.low != 0) return {std::nullopt, Lack::always};
  return pearson();
}

}  // namespace wholehand
