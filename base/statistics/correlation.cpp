// SPDX-License-Identifier: MIT
#include "base/statistics/correlation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics/distributions.h"
#include "base/statistics/moments.h"

namespace wholehand {

Correlation pearson(std::span<const double> x, std::span<const double> y) {
  if (x.size() < 3) return {std::nullopt, Lack::fewer_than_3};
  if (!varies(x)) return {std::nullopt, Lack::one_x};
  if (!varies(y)) return {std::nullopt, Lack::one_y};
  const double mean_x = mean_of(x), mean_y = mean_of(y);
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - mean_x, dy = y[i] - mean_y;
    xx += dx * dx;
    yy += dy * dy;
    xy += dx * dy;
  }
  return {std::clamp(xy / std::sqrt(xx) / std::sqrt(yy), -1.0, 1.0)};
}

Correlation point_biserial(std::span<const double> x, std::span<const char> yes) {
  if (x.size() < 3) return {std::nullopt, Lack::fewer_than_3};
  const auto count = static_cast<std::size_t>(std::count_if(yes.begin(), yes.end(), [](char is_yes) { return is_yes != 0; }));
  if (count == 0) return {std::nullopt, Lack::never};
  if (count == yes.size()) return {std::nullopt, Lack::always};
  if (!varies(x)) return {std::nullopt, Lack::one_x};
  const auto n = static_cast<double>(x.size()), n1 = static_cast<double>(count), n0 = n - n1;
  const double mean = mean_of(x);
  double sum_1 = 0, sum_0 = 0, squares = 0;  // about the mean
  for (std::size_t i = 0; i < x.size(); ++i) {
    (yes[i] != 0 ? sum_1 : sum_0) += x[i] - mean;
    squares += (x[i] - mean) * (x[i] - mean);
  }
  const double r = (sum_1 / n1 - sum_0 / n0) / std::sqrt(squares / n) * std::sqrt(n1 / n * (n0 / n));
  return {std::clamp(r, -1.0, 1.0)};
}

Interval correlation_interval(double r, std::size_t pairs) {
  if (pairs <= 3) return {};
  const double middle = std::atanh(r), half = NORMAL_95 / std::sqrt(static_cast<double>(pairs) - 3);
  return {std::tanh(middle - half), std::tanh(middle + half)};
}

double correlation_p(double r, std::size_t pairs) {
  if (pairs <= 2) return std::numeric_limits<double>::quiet_NaN();
  const double freedom = static_cast<double>(pairs) - 2;
  // t^2 = freedom r^2 / (1 - r^2), and freedom / (freedom + t^2) = 1 - r^2
  return incomplete_beta(freedom / 2, 0.5, 1 - r * r);
}

}  // namespace wholehand
