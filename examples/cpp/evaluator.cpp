// SPDX-License-Identifier: MIT
// core/evaluator.h: one grip with everything, and what is known of a vessel before any grip.
#include <cmath>
#include <cstdio>

#include "core/evaluator.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"

int main() {
  using namespace wholehand;
  const Scene scene = read_scene_file(find_scene("three_beakers"));
  const auto evaluator = make_core_evaluator(scene);
  GripInput grip;
  grip.height = 51.1e-3;
  grip.obliquity = radians(-10);
  grip.roll = radians(-58);
  GripResult result;
  evaluator->grip(0, grip, result);
  std::printf("%s: %s, closure %.3f, gap %.1f mm, score %.3f\n", scene.vessels[0].name.c_str(),
              result.reason == Reason::none ? "feasible" : REASON_NAMES[static_cast<std::size_t>(result.reason)], result.closure,
              result.gap * 1e3, evaluator->score(0, grip, result).score);
  // the gap is the distance between the tips of thumb (joint 3) and index finger (joint 8), before the fingers rest on the glass
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) squared += std::pow(result.joints[3][axis] - result.joints[8][axis], 2);
  return std::abs(std::sqrt(squared) - result.gap) < 1e-9 ? 0 : 1;
}
