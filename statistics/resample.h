// SPDX-License-Identifier: MIT
// What a statistic is worth in a small sample of a large population.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "statistics/interval.h"

namespace wholehand {

// The values that `statistic` takes in `resamples` samples, each of `sample` members out of `population` (at least one), drawn
// with replacement. It is given the members' numbers, and may answer NaN where a sample has no such statistic: these are left
// out. The same seed gives the same samples on any machine.
std::vector<double> resampled_values(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                                     const std::function<double(std::span<const std::size_t>)>& statistic);

// The interval from the 2.5th to the 97.5th percentile of them. With `sample` as large as the population: the bootstrap. NaN
// where more than a half of the samples have no such statistic.
Interval resampled_interval(std::size_t population, std::size_t sample, int resamples, std::uint64_t seed,
                            const std::function<double(std::span<const std::size_t>)>& statistic);

}  // namespace wholehand
