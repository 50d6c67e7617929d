// SPDX-License-Identifier: MIT
// core/capacity.h: what a vessel holds, from its outline and its wall.
#include <cmath>
#include <cstdio>

#include "core/capacity.h"

int main() {
  using namespace wholehand;
  VesselData can;
  can.name = "can";
  can.height = 0.1;
  can.wall = 2e-3;
  for (const auto& end : {std::array{0.03, 0.0}, std::array{0.03, 0.1}, std::array{0.0, 0.1}}) {
    OutlineElement line;
    line.end = end;
    can.outline.push_back(line);
  }
  const double capacity = capacity_of(can);
  std::printf("%s: %.1f mL\n", can.name.c_str(), capacity * 1e6);
  // the room is a cylinder, thinner by the wall, on a floor as thick as the wall
  const double cylinder = PI * 0.028 * 0.028 * 0.098;
  return std::abs(capacity - cylinder) < 1e-9 * cylinder ? 0 : 1;
}
