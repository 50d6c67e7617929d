// SPDX-License-Identifier: MIT
// Which processors each rank of a node may take for itself.
#pragma once

#include <vector>

namespace wholehand {

// `allowed[rank][p]`: whether a rank may run on processor p; equally long for all. Deals out each processor once, to one of those that may run on it,
// as evenly as possible. Returns how many each rank has, at least 1, although a rank that shares all its processors may get none.
std::vector<int> deal_processors(const std::vector<std::vector<bool>>& allowed);

}  // namespace wholehand
