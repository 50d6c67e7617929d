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

// From the 2.5th to the 97.5th percentile of the values of samples (at least one); NaN stands for a sample without a value. Samples without a value
// may be the unusual ones, so there is no interval (NaN) unless 95 % of the samples have one.
Interval sample_interval(std::span<const double> values);

// The same for each of many values: samples[k][i] is value i of sample k.
std::vector<Interval> sample_intervals(const std::vector<std::vector<double>>& samples);

// The sample_interval of resampled_values. If `sample` is as large as the population, this is the bootstrap.
Interval resampled_interval(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                            const std::function<double(std::span<const std::size_t>)>& statistic);

}  // namespace wholehand
