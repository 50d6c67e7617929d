// SPDX-License-Identifier: MIT
// Tests whether groups differ by more than their members do.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace wholehand {

// A one-way analysis of variance.
struct Anova {
  double f = 0;                    // mean square between groups over the mean square within
  double p = 1;                    // probability of an F at least this large if all groups have one mean
  double between = 0, within = 0;  // degrees of freedom
  double share = 0;                // eta squared: sum of squares between groups over the total
};

// One-way ANOVA of groups of values; empty groups do not count. None if fewer than two groups are left, if no group has a second value, or if no
// group's values differ by more than rounding (base/statistics/moments.h).
std::optional<Anova> one_way_anova(std::span<const std::vector<double>> groups);

}  // namespace wholehand
