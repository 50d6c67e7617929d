// SPDX-License-Identifier: MIT
#include "statistics/resample.h"

#include <cmath>

#include "core/random_bits.h"

namespace wholehand {

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
  const std::vector<double> values = resampled_values(population, sample, resamples, seed, statistic);
  if (2 * values.size() < static_cast<std::size_t>(resamples)) return {};
  return percentile_interval(values);
}

}  // namespace wholehand
