// SPDX-License-Identifier: MIT
// base/numbers/sobol.h: points that fill the axes of grips evenly, without a grid.
#include <array>
#include <cstdio>
#include <set>
#include <vector>

#include "base/numbers/sobol.h"

int main() {
  using namespace wholehand;
  constexpr std::size_t COUNT = 16;
  std::vector<SobolPoint> points(COUNT);
  Sobol(7).points(0, COUNT, points.data());
  for (std::size_t i = 0; i < 4; ++i) std::printf("%.3f %.3f %.3f\n", points[i][0], points[i][1], points[i][2]);
  // of 16 points, each sixteenth of each axis has one
  for (std::size_t axis = 0; axis < SOBOL_DIMENSIONS; ++axis) {
    std::set<int> sixteenths;
    for (const SobolPoint& point : points) sixteenths.insert(static_cast<int>(point[axis] * COUNT));
    if (sixteenths.size() != COUNT) return 1;
  }
  return 0;
}
