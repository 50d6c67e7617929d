// SPDX-License-Identifier: MIT
#include "base/statistics/resample.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/numbers/random_bits.h"

namespace wholehand {
namespace {

constexpr std::size_t LEAST_PERCENT = 95;  // of the samples, that must have a value
constexpr std::size_t ONE_OF = 40;         // repetitions lies below an interval of 95 %, and one above

bool are_enough(std::size_t present, std::size_t samples) { return 100 * present >= LEAST_PERCENT * samples; }

}  // namespace

Interval sample_interval(std::span<const double> values) {
  std::vector<double> present;
  std::copy_if(values.begin(), values.end(), std::back_inserter(present), [](double value) { return !std::isnan(value); });
  if (present.empty() || !are_enough(present.size(), values.size())) return {};
  std::sort(present.begin(), present.end());
  const std::size_t outside = std::max<std::size_t>(1, (present.size() + 1) / ONE_OF) - 1;
  return {present[outside], present[present.size() - 1 - outside]};
}

std::vector<Interval> sample_intervals(const std::vector<std::vector<double>>& samples) {
  std::vector<Interval> intervals;
  std::vector<double> values(samples.size());
  for (std::size_t i = 0; i < samples.front().size(); ++i) {
    for (std::size_t k = 0; k < samples.size(); ++k) values[k] = samples[k][i];
    intervals.push_back(sample_interval(values));
  }
  return intervals;
}

std::vector<double> resampled_values(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                                     const std::function<double(std::span<const std::size_t>)>& statistic) {
  std::vector<double> values;
  std::vector<std::size_t> members(sample);
  std::uint64_t state = seed;
  for (int k = 0; k < resamples; ++k) {
    for (std::size_t& member : members)
      member = static_cast<std::size_t>(unit_interval(split_mix(state)) * static_cast<double>(population));
    const double value = statistic(members);
    if (!std::isnan(value)) values.push_back(value);
  }
  return values;
}

Interval resampled_interval(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                            const std::function<double(std::span<const std::size_t>)>& statistic) {
  const std::vector<double> present = resampled_values(population, sample, resamples, seed, statistic);
  return are_enough(present.size(), static_cast<std::size_t>(resamples)) ? percentile_interval(present) : Interval{};
}

}  // namespace wholehand
