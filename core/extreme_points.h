// SPDX-License-Identifier: MIT
// Which of many points matter to the largest value of a convex function that is 0 at the origin and grows in proportion along each ray.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace wholehand {

using Point5 = std::array<double, 5>;
// With more points than this all count as extreme: the time of the test grows with their square.
constexpr std::size_t MOST_EXTREME = 512;

// Numbers of some of the points, ascending. Each other point is a sum of these with shares that are not negative and add up to 1 at most, but for
// a rest of 1e-9 of the largest point: no gauge is larger there than at the largest of these. Points of 0 are left out.
std::vector<std::size_t> extreme_points(const std::vector<Point5>& points);

}  // namespace wholehand
