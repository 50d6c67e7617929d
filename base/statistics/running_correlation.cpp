// SPDX-License-Identifier: MIT
#include "base/statistics/running_correlation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/statistics/moments.h"

namespace wholehand {

void RunningCorrelation::Side::widen(double value, bool is_first) {
  low = is_first ? value : std::min(low, value);
  high = is_first ? value : std::max(high, value);
}

void RunningCorrelation::Side::widen(const Side& other, bool is_first) {
  widen(other.low, is_first);
  widen(other.high, false);
}

// The least and the largest value decide, as they do of all values.
bool RunningCorrelation::Side::varies() const { return wholehand::varies(std::array{low, high}); }

void RunningCorrelation::add(double x, double y) {
  x_.widen(x, pairs_ == 0);
  y_.widen(y, pairs_ == 0);
  ++pairs_;
  weight_ += 1;
  const double dx = x - x_.mean, dy = y - y_.mean;
  x_.mean += dx / weight_;
  y_.mean += dy / weight_;
  x_.squares += dx * (x - x_.mean);
  y_.squares += dy * (y - y_.mean);
  products_ += dx * (y - y_.mean);
}

void RunningCorrelation::add(const RunningCorrelation& other, double weight) {
  if (other.pairs_ == 0) return;
  x_.widen(other.x_, pairs_ == 0);
  y_.widen(other.y_, pairs_ == 0);
  pairs_ += other.pairs_;
  const double more = weight * other.weight_, all = weight_ + more, between = weight_ * more / all;
  const double dx = other.x_.mean - x_.mean, dy = other.y_.mean - y_.mean;
  x_.mean += dx * more / all;
  y_.mean += dy * more / all;
  x_.squares += weight * other.x_.squares + dx * dx * between;
  y_.squares += weight * other.y_.squares + dy * dy * between;
  products_ += weight * other.products_ + dx * dy * between;
  weight_ = all;
}

double RunningCorrelation::mean_y() const { return pairs_ == 0 ? std::numeric_limits<double>::quiet_NaN() : y_.mean; }

Correlation RunningCorrelation::pearson() const {
  if (pairs_ < 3) return {std::nullopt, Lack::fewer_than_3};
  if (!x_.varies() || x_.high - x_.low <= least_x_) return {std::nullopt, Lack::one_x};
  if (!y_.varies()) return {std::nullopt, Lack::one_y};
  return {std::clamp(products_ / std::sqrt(x_.squares) / std::sqrt(y_.squares), -1.0, 1.0)};
}

Correlation RunningCorrelation::point_biserial() const {
  if (pairs_ >= 3 && y_.high == 0) return {std::nullopt, Lack::never};
  if (pairs_ >= 3 && y_.low != 0) return {std::nullopt, Lack::always};
  return pearson();
}

}  // namespace wholehand
