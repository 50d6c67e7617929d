// SPDX-License-Identifier: MIT
#include "base/statistics/anova.h"

#include <algorithm>

#include "base/statistics/distributions.h"
#include "base/statistics/moments.h"

namespace wholehand {

std::optional<Anova> one_way_anova(std::span<const std::vector<double>> groups) {
  double count = 0, sum = 0, used = 0;
  for (const std::vector<double>& group : groups) {
    count += static_cast<double>(group.size());
    used += group.empty() ? 0 : 1;
    for (const double value : group) sum += value;
  }
  if (used < 2 || count <= used) return std::nullopt;
  const double mean = sum / count;
  double between = 0, within = 0;
  for (const std::vector<double>& group : groups) {
    if (group.empty()) continue;
    const double own = mean_of(group);
    between += static_cast<double>(group.size()) * (own - mean) * (own - mean);
    for (const double value : group) within += (value - own) * (value - own);
  }
  if (std::none_of(groups.begin(), groups.end(), [](const std::vector<double>& group) { return varies(group); }))
    return std::nullopt;
  Anova result;
  result.between = used - 1;
  result.within = count - used;
  result.f = between / result.between / (within / result.within);
  result.p = f_tail(result.f, result.between, result.within);
  result.share = between / (between + within);
  return result;
}

}  // namespace wholehand
