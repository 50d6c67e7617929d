// SPDX-License-Identifier: MIT
// The scatter of a statistic in small samples of a large population.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/statistics/interval.h"

namespace wholehand {

// The values of `statistic` in `resamples` samples, each of `sample` members out of `population` (at least one), drawn with replacement. `statistic`
// receives the members' numbers and may return NaN if a sample has no value; such samples are left out. A seed gives the same samples on any machine.
std::vector<double> resampled_values(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                                     const std::function<double(std::span<const std::size_t>)>& statistic);

// Where a further sample's value lies in 95 % of cases: from value k in ascending order to value k from the end, of n values with k = (n + 1) / 40,
// rounded down. A further one is equally likely to take each of its n + 1 places among them, so it lies outside in at most 2 k of n + 1 cases
// (Wilks 1941), exactly if no two are equal. Percentiles interpolated between values would hold less: 94.8 % with 1,000 values, 94.1 % with 200. Fewer
// than 39 values hold no 95 %: their interval is all of them. NaN stands for a sample without a value. Such samples may be the unusual ones, so there
// is no interval (NaN) unless 95 % of the samples (at least one) have one.
Interval sample_interval(std::span<const double> values);

// The same for each of many values: samples[k][i] is value i of sample k.
std::vector<Interval> sample_intervals(const std::vector<std::vector<double>>& samples);

// From the 2.5th to the 97.5th percentile of resampled_values; NaN as for sample_interval. If `sample` is as large as the population, this is the bootstrap.
Interval resampled_interval(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                            const std::function<double(std::span<const std::size_t>)>& statistic);

}  // namespace wholehand
