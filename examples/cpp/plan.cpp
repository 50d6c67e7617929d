// SPDX-License-Identifier: MIT
// sweeps/plan/plan.h: the grips that a scene asks for, by number.
#include <cstdio>

#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/plan/plan.h"

int main() {
  using namespace wholehand;
  const Scene scene = read_scene_file(find_scene("small"));
  const sweeps::Plan plan(scene, false);
  std::printf("%llu grips are evaluated, and %llu are stored\n", static_cast<unsigned long long>(plan.grips()),
              static_cast<unsigned long long>(plan.stored_grips()));
  for (std::uint64_t number = 0; number < 4; ++number) {
    const GripInput grip = plan.grip(0, number);
    std::printf("%llu: height %.0f mm, roll %.0f degrees\n", static_cast<unsigned long long>(number), grip.height * 1e3,
                degrees(grip.roll));
  }
  // 3 heights x 3 obliquities x 4 rolls; the two azimuths are the same for a body of revolution
  return plan.grips() == 36 && plan.stored_grips() == 72 && plan.grip(0, 1).height == 55e-3 ? 0 : 1;
}
