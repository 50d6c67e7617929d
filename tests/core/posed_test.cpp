// SPDX-License-Identifier: MIT
// The posed hand alone is that of the whole answer.
// sanitizers: address
#include <gtest/gtest.h>

#include <random>

#include "core/evaluator.h"
#include "tests/support/random_scenes.h"

namespace wholehand {
namespace {

// A grip on the scene's own axes, a range taken at its values.
GripInput drawn_grip(const Scene& scene, std::mt19937& random) {
  const auto one_of = [&](const Axis& axis) { return axis.values[random() % axis.values.size()]; };
  const GripsData& axes = scene.grips;
  const VesselData& vessel = scene.vessels[0];
  const double height = one_of(axes.height);
  return {axes.height_is_fraction ? vessel.base + height * (vessel.height - vessel.base) : height,
          one_of(axes.azimuth),
          one_of(axes.obliquity),
          one_of(axes.roll),
          one_of(axes.offset),
          one_of(axes.hand_scale)};
}

TEST(Posed, IsThatOfTheWholeAnswerBitForBit) {
  std::mt19937 random(1);
  int feasible = 0, infeasible = 0, left = 0;
  for (std::uint64_t seed = 1; seed <= 80; ++seed) {
    const Scene scene = random_scene(seed);
    const auto core = make_core_evaluator(scene);
    for (int i = 0; i < 20; ++i) {
      const GripInput grip = drawn_grip(scene, random);
      GripResult whole;
      core->grip(0, grip, whole);
      const auto posed = core->posed(0, grip);
      ASSERT_EQ(posed.has_value(), whole.reason == Reason::none);
      ++(posed ? feasible : infeasible);
      if (!posed) continue;
      EXPECT_EQ(*posed, whole.posed) << seed;
      left += scene.hand.handedness == Handedness::left;
    }
  }
  // else the seeds say too little
  EXPECT_GT(feasible, 50);
  EXPECT_GT(infeasible, 50);
  EXPECT_GT(left, 5);
}

}  // namespace
}  // namespace wholehand
