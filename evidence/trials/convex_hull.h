// SPDX-License-Identifier: MIT
// The convex hull of points in space, by Qhull.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/scene.h"

namespace wholehand {

// Below this volume over area (m) a hull counts as flat. MuJoCo refuses flat hulls, and no finger feels them.
constexpr double FLAT_HULL = 5e-6;

struct ConvexHull {
  std::vector<Triple> vertices;                         // the extreme points alone
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  double volume = 0;                                    // m3
};

// None if the points are flat, by FLAT_HULL, or fewer than four. The same points give the same bits.
std::optional<ConvexHull> convex_hull(const std::vector<Triple>& points);

// The joint hull of two.
std::optional<ConvexHull> joint_hull(const ConvexHull& a, const ConvexHull& b);

// The signed distance to the farthest of the planes of its triangles: negative inside; outside at most the distance to the hull.
double plane_distance(const ConvexHull& hull, const Triple& point);

}  // namespace wholehand
