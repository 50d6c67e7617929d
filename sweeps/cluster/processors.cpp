// SPDX-License-Identifier: MIT
#include "sweeps/cluster/processors.h"

#include <algorithm>
#include <cstddef>

namespace wholehand::sweeps {

std::vector<int> deal_processors(const std::vector<std::vector<bool>>& allowed) {
  std::vector<std::vector<std::size_t>> ranks_of(allowed.empty() ? 0 : allowed.front().size());
  for (std::size_t rank = 0; rank < allowed.size(); ++rank)
    for (std::size_t p = 0; p < ranks_of.size(); ++p)
      if (allowed[rank][p]) ranks_of[p].push_back(rank);
  // processors that few ranks may use come first: then no rank loses its only one
  std::stable_sort(ranks_of.begin(), ranks_of.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::vector<int> dealt(allowed.size(), 0);
  for (const std::vector<std::size_t>& ranks : ranks_of) {
    const auto poorest =
        std::min_element(ranks.begin(), ranks.end(), [&](std::size_t a, std::size_t b) { return dealt[a] < dealt[b]; });
    if (poorest != ranks.end()) ++dealt[*poorest];
  }
  for (int& count : dealt) count = std::max(count, 1);
  return dealt;
}

}  // namespace wholehand::sweeps
