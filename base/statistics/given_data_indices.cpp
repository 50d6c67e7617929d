// SPDX-License-Identifier: MIT
#include "base/statistics/given_data_indices.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/statistics/moments.h"

namespace wholehand {
namespace {

constexpr double STUDENT_95 = 2.093024054408263;  // 97.5th percentile of Student's t with GROUPS - 1 degrees of freedom
static_assert(GivenDataIndices::GROUPS == 20);

std::size_t bin_of(double input) {
  constexpr double LAST = GivenDataIndices::BINS - 1;
  return static_cast<std::size_t>(std::fmin(std::fmax(input * GivenDataIndices::BINS, 0.0), LAST));
}

}  // namespace

GivenDataIndices::GivenDataIndices(std::size_t inputs, std::size_t outputs)
    : inputs_(inputs), outputs_(outputs), bins_(inputs * outputs) {}

void GivenDataIndices::add(std::span<const double> inputs, std::span<const double> outputs) {
  assert(inputs.size() == inputs_ && outputs.size() == outputs_.size());
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    const double value = outputs[k];
    if (!std::isfinite(value)) continue;
    Output& output = outputs_[k];
    if (output.values == 0) output.first = output.low = output.high = value;
    output.low = std::min(output.low, value);
    output.high = std::max(output.high, value);
    const std::size_t group = output.values++ % GROUPS;
    const double off = value - output.first;
    Totals& totals = output.groups[group];
    totals.count += 1;
    totals.sum += off;
    totals.squares += off * off;
    for (std::size_t i = 0; i < inputs_; ++i) {
      Sums& sums = bins_[k * inputs_ + i][group][bin_of(inputs[i])];
      sums.count += 1;
      sums.sum += off;
    }
  }
}

// 0 where the sum of squares is no more than `rounding`: there is nothing to share.
double GivenDataIndices::index_of(const Bins& bins, const Totals& all, double rounding) {
  const double of_mean = all.sum * all.sum / all.count, total = all.squares - of_mean;
  if (!(total > rounding)) return 0;
  double between = -of_mean, used = 0;
  for (const Sums& bin : bins) {
    if (bin.count == 0) continue;
    between += bin.sum * bin.sum / bin.count;
    used += 1;
  }
  const double within = (total - between) / (all.count - used);
  return (between - (used - 1) * within) / total;
}

SensitivityIndex GivenDataIndices::first_order(std::size_t output, std::size_t input) const {
  const Output& of = outputs_[output];
  if (of.values < LEAST_VALUES) return {std::numeric_limits<double>::quiet_NaN(), {}};
  if (!varies(std::array{of.low, of.high})) return {};
  const std::array<Bins, GROUPS>& own = bins_[output * inputs_ + input];
  Bins bins{};
  Totals all;
  for (std::size_t g = 0; g < GROUPS; ++g) {
    all.count += of.groups[g].count;
    all.sum += of.groups[g].sum;
    all.squares += of.groups[g].squares;
    for (std::size_t b = 0; b < BINS; ++b) {
      bins[b].count += own[g][b].count;
      bins[b].sum += own[g][b].sum;
    }
  }
  constexpr double ROUNDING = 1e-12;  // of the squares: what the difference of two sums leaves of a group that alone varies
  const double rounding = ROUNDING * all.squares;
  SensitivityIndex index;
  index.first = index_of(bins, all, 0);
  std::array<double, GROUPS> without{};
  for (std::size_t g = 0; g < GROUPS; ++g) {
    Bins rest = bins;
    for (std::size_t b = 0; b < BINS; ++b) {
      rest[b].count -= own[g][b].count;
      rest[b].sum -= own[g][b].sum;
    }
    const Totals& group = of.groups[g];
    without[g] = index_of(rest, {all.count - group.count, all.sum - group.sum, all.squares - group.squares}, rounding);
  }
  const double mean = mean_of(without);
  double squares = 0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  const double half = STUDENT_95 * std::sqrt((GROUPS - 1.0) / GROUPS * squares);
  index.interval = {index.first - half, index.first + half};
  return index;
}

}  // namespace wholehand
