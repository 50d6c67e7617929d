// SPDX-License-Identifier: MIT
// No NaN and no infinity leaves a kernel where a value must be: a search among grips made to find one.
// sanitizers: address
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "tests/support/adversarial.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

Searched search_core(std::size_t grips, Precision precision) {
  return search(grips, [precision](const Scene& scene) -> Answer {
    const std::shared_ptr<const Evaluator> core = core_of(scene, precision);
    return [core, fields = all_fields(scene)](std::size_t vessel, const std::vector<GripInput>& asked) {
      return gather(*core, fields, vessel, asked);
    };
  });
}

TEST(Search, CoreInDoubleIsFinite) {
  const Searched searched = search_core(search_grips(60000), Precision::full);
  EXPECT_GT(4 * searched.feasible, searched.grips);
}

TEST(Search, CoreInFloatIsFinite) {
  const Searched searched = search_core(search_grips(60000), Precision::single);
  EXPECT_GT(4 * searched.feasible, searched.grips);
}

// What the kernels do not promise to answer, they still answer: every iteration is bounded.
TEST(Search, GripsBeyondAnyRangeEnd) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const std::vector<double> wild{nan, infinite, -infinite, 1e30, -1e30, 1e19, 3e38, -3e38, 0};
  for (const Scene& scene : adversarial_scenes()) {
    std::vector<GripInput> grips;
    for (const double value : wild) {
      for (int k = 0; k < 6; ++k) {
        GripInput grip{0.5 * scene.vessels[0].height, 0, 0, 0, 0, 1};
        (k == 0   ? grip.height
         : k == 1 ? grip.azimuth
         : k == 2 ? grip.obliquity
         : k == 3 ? grip.roll
         : k == 4 ? grip.offset
                  : grip.hand_scale) = value;
        grips.push_back(grip);
      }
    }
    for (const Precision precision : {Precision::full, Precision::single}) {
      const GatheredPlanes planes = gather(*core_of(scene, precision), all_fields(scene), 0, grips);
      EXPECT_EQ(planes.count, grips.size());
    }
  }
}

}  // namespace
}  // namespace wholehand
