// SPDX-License-Identifier: MIT
// What a statistic is worth in a small sample of a large population.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/statistics/interval.h"

namespace wholehand {

// The values that `statistic` takes in `resamples` samples, each of `sample` members out of `population` (at least one), drawn
// with replacement. It is given the members' numbers, and may answer NaN where a sample has no such statistic: these are left
// out. The same seed gives the same samples on any machine.
std::vector<double> resampled_values(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                                     const std::function<double(std::span<const std::size_t>)>& statistic);

// From the 2.5th to the 97.5th percentile of the values that samples (at least one) have; NaN stands for a sample without a value.
// Samples without one may well be the unusual ones. So there is no interval (NaN) unless 95 % of the samples have a value.
Interval sample_interval(std::span<const double> values);

// The same of each of many values: samples[k][i] is the value i of sample k.
std::vector<Interval> sample_intervals(const std::vector<std::vector<double>>& samples);

// The sample_interval of resampled_values. With `sample` as large as the population: the bootstrap.
Interval resampled_interval(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                            const std::function<double(std::span<const std::size_t>)>& statistic);

}  // namespace wholehand
