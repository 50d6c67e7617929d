// SPDX-License-Identifier: MIT
// The convex hull of points in six dimensions, by Qhull.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace wholehand::sweeps {

using Point6 = std::array<double, 6>;

// One face, a simplex: normal . x <= offset holds for the whole hull.
struct HullFacet {
  Point6 normal{};  // unit, outward
  double offset = 0;
  double volume = 0;  // of the pyramid over it with the apex as its tip
};

struct Hull {
  std::vector<HullFacet> facets;
  double moved = 0;  // Qhull may move points by this length, so that all faces are simplices
};

// The pyramids fill the hull if `apex` lies inside it. Points in a plane get a hull as thin as they are moved. Nothing if Qhull finds none. Prints
// nothing.
std::optional<Hull> hull_of(std::vector<Point6> points, const Point6& apex);

}  // namespace wholehand::sweeps
