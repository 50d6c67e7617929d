// SPDX-License-Identifier: MIT
// Divides a node's processors among its ranks.
#pragma once

#include <vector>

namespace wholehand::sweeps {

// `allowed[rank][p]`: whether a rank may run on processor p; equally long for all. Assigns each processor once, to a rank that may run on it, as
// evenly as possible. Returns the number for each rank, at least 1, although a rank that shares all its processors may get none.
std::vector<int> deal_processors(const std::vector<std::vector<bool>>& allowed);

}  // namespace wholehand::sweeps
