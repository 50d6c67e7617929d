// SPDX-License-Identifier: MIT
// Whether groups differ by more than their members do.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace wholehand {

// A one-way analysis of variance.
struct Anova {
  double f = 0;                    // mean square between groups over that within
  double p = 1;                    // how likely an F as large is where all groups have one mean
  double between = 0, within = 0;  // degrees of freedom
  double share = 0;                // eta squared: the sum of squares between groups over all
};

// One-way ANOVA of groups of values; empty groups do not count. None where fewer than two groups are left, where no group has a second
// value, or where the values of no group differ by more than rounding (base/statistics/moments.h).
std::optional<Anova> one_way_anova(std::span<const std::vector<double>> groups);

}  // namespace wholehand
