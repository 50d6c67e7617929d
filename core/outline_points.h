// SPDX-License-Identifier: MIT
// Samples an outline as points, for drawings and extents that need no arcs.
#pragma once

#include <array>
#include <vector>

#include "core/prepare.h"

namespace wholehand {

// Points (r, y) along the first `count` elements, m, from the first one's start. An arc is divided into equal angles of at most `step` rad, so chords
// deviate from it by at most its radius times step^2 / 8.
std::vector<std::array<double, 2>> outline_points(const std::vector<PreparedElement>& elements, std::size_t count, double step);

constexpr double ARC_STEP = radians(3);  // 15 um off on a beaker's 40 mm

}  // namespace wholehand
