// SPDX-License-Identifier: MIT
// Reduces many points to those that decide the largest value of a gauge: a convex function that is 0 at the origin and grows in proportion along each
// ray.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace wholehand {

using Point5 = std::array<double, 5>;
// With more points than this all count as extreme, because the test's time grows with their square.
constexpr std::size_t MOST_EXTREME = 512;

// Indices of the extreme points, ascending. Each other point is a sum of these with nonnegative shares that add up to at most 1, except for a rest of
// 1e-9 of the largest point, so every gauge has its largest value at one of these. Points at 0 are left out.
std::vector<std::size_t> extreme_points(const std::vector<Point5>& points);

}  // namespace wholehand
