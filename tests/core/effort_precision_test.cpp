// SPDX-License-Identifier: MIT
// The brackets of efforts in float and in double hold the same number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/gather.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "core/scene.h"

namespace wholehand {
namespace {

struct Bracket {
  double low = 0, high = 0;
};

// Grips about a hand that is weak, so that some states are held, some take more than there is, and some are not resisted.
class EffortPrecision : public testing::Test {
 protected:
  EffortPrecision() : scene_(read_scene_file(find_scene("small"))) {
    scene_.strength = StrengthData{};
    scene_.strength->by_opening = false;
    for (double& digit : scene_.strength->digits) digit *= 0.1;
    scene_.hand.depth_limit = 20e-3;
    for (int i = 0; i < 100; ++i) {
      GripInput grip;
      grip.height = 0.02 + 0.0006 * i;
      grip.roll = -1.5 + 0.03 * (i * 7 % 60);
      grip.obliquity = 0.3 * std::sin(i);
      grips_.push_back(grip);
    }
  }
  std::vector<GripInput> higher(double by) const {
    std::vector<GripInput> moved = grips_;
    for (GripInput& grip : moved) grip.height += by;
    return moved;
  }
  GatheredPlanes planes(const Evaluator& core, const std::vector<GripInput>& grips) const {
    return gather(core, make_field_set({FIELD_EFFORT, FIELD_EFFORT_LOW, FIELD_STATUS}, scene_), 0, grips);
  }
  static Bracket of(const GatheredPlanes& planes, int state, std::size_t grip) {
    return {planes.real(planes.fields.plane[FIELD_EFFORT_LOW] + state, grip),
            planes.real(planes.fields.plane[FIELD_EFFORT] + state, grip)};
  }
  // What is finite where an effort is not.
  static double share(double effort) { return 1 / (1 + effort); }
  static double room(double effort) {
    const double t = share(effort);
    return 4e-4 * t * (1 - t) + 3e-5 * 8 * (1 - t) * (1 - t);
  }
  Scene scene_;
  std::vector<GripInput> grips_;
};

// In float, fingers rest within 1e-6 m of the surface, so the bracket is also compared with those of the grip 3e-6 m higher and
// lower. Two differences remain. Places of contacts end 1e-6 m off, on arms of 5 mm, twice. Rounding takes 3e-5 of the strength
// from what the hand can carry; S over the weight of this is 8.
TEST_F(EffortPrecision, BracketsOfFloatMeetThoseOfDouble) {
  const auto core = make_core_evaluator(scene_), single = make_core_float_evaluator(scene_);
  const GatheredPlanes in_float = planes(*single, grips_);
  const std::vector<GatheredPlanes> in_double{planes(*core, grips_), planes(*core, higher(3e-6)), planes(*core, higher(-3e-6))};
  int compared = 0, finite = 0, held = 0;
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if ((in_float.uint(FIELD_STATUS, i) & STATUS_PLAUSIBLE) == 0 || (in_double[0].uint(FIELD_STATUS, i) & STATUS_PLAUSIBLE) == 0)
      continue;
    for (int state = 0; state < static_cast<int>(scene_fills(scene_) * scene_.tilts.size()); ++state) {
      const Bracket found = of(in_float, state, i);
      Bracket truth{std::numeric_limits<double>::infinity(), 0};
      for (const GatheredPlanes& planes : in_double) {
        const Bracket one = of(planes, state, i);
        truth.low = std::min(truth.low, one.low);
        truth.high = std::max(truth.high, one.high);
      }
      EXPECT_LE(found.low, found.high) << "grip " << i << ", state " << state;
      EXPECT_GE(share(found.low) + room(truth.high), share(truth.high)) << "grip " << i << ", state " << state;
      EXPECT_LE(share(found.high), share(truth.low) + room(truth.low)) << "grip " << i << ", state " << state;
      ++compared;
      finite += std::isfinite(found.high) ? 1 : 0;
      held += found.high <= 1 ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 200);
  EXPECT_GT(finite, held);  // some take more than there is
  EXPECT_GT(held, 50);
}

}  // namespace
}  // namespace wholehand
