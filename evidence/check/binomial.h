// SPDX-License-Identifier: MIT
// How many of many trials may fail by chance.
#pragma once

#include <cstdint>

namespace wholehand {

// P(X >= count) for `trials` independent trials of probability `share` each; to a relative error of 1e-8 for up to a million of them.
double binomial_tail(std::uint64_t trials, std::uint64_t count, double share);

// The largest count that is no evidence against a share: the largest k with P(X >= k) >= significance, and at least 1.
std::uint64_t largest_plausible_count(std::uint64_t trials, double share, double significance);

}  // namespace wholehand
