// SPDX-License-Identifier: MIT
// How many of many trials may fail before it is no accident.
#pragma once

#include <cstdint>

namespace wholehand {

// P(X >= count) for `trials` independent trials of probability `share` each; to 1e-8 of itself for up to a million of them.
double binomial_tail(std::uint64_t trials, std::uint64_t count, double share);

// The largest count that is still no evidence against a share: the largest k with P(X >= k) >= significance, and at least 1.
std::uint64_t largest_plausible_count(std::uint64_t trials, double share, double significance);

}  // namespace wholehand
