// SPDX-License-Identifier: MIT
// Which processors each rank of a node may take for itself.
#pragma once

#include <vector>

namespace wholehand {

// `allowed[rank][p]`: whether a rank may run on processor p; equally long for all. Deals out each processor once, to one of those that may run on it,
// as evenly as that goes. Answers how many each rank has, and at least 1: who shares all of its processors with others may get none.
std::vector<int> deal_processors(const std::vector<std::vector<bool>>& allowed);

}  // namespace wholehand
