// SPDX-License-Identifier: MIT
#include "base/statistics/sobol_indices.h"

#include <limits>
#include <numeric>

#include "base/statistics/moments.h"
#include "base/statistics/resample.h"

namespace wholehand {
namespace {

// Over these rows; NaN where the answer does not vary.
double first_order(std::span<const double> a, std::span<const double> b, std::span<const double> mixed,
                   std::span<const std::size_t> rows) {
  const auto n = static_cast<double>(rows.size());
  double mean = 0;
  for (const std::size_t k : rows) mean += a[k] + b[k];
  mean /= 2 * n;
  double variance = 0, part = 0;
  for (const std::size_t k : rows) {
    variance += (a[k] - mean) * (a[k] - mean) + (b[k] - mean) * (b[k] - mean);
    part += (b[k] - mean) * (mixed[k] - a[k]);
  }
  return variance > 0 ? part / n / (variance / (2 * n)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<SensitivityIndex> first_order_indices(std::span<const double> a, std::span<const double> b,
                                                  std::span<const std::vector<double>> mixed, int resamples, std::uint64_t seed) {
  std::vector<std::size_t> all(a.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<double> answers(a.begin(), a.end());
  answers.insert(answers.end(), b.begin(), b.end());
  const bool is_constant = !varies(answers);
  std::vector<SensitivityIndex> indices;
  for (const std::vector<double>& one : mixed) {
    SensitivityIndex index;
    if (!is_constant) {
      index.first = first_order(a, b, one, all);
      index.interval = resampled_interval(a.size(), a.size(), resamples, seed,
                                          [&](std::span<const std::size_t> rows) { return first_order(a, b, one, rows); });
    }
    indices.push_back(index);
  }
  return indices;
}

}  // namespace wholehand
