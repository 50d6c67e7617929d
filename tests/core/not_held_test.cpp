// SPDX-License-Identifier: MIT
// Grips that take more than all of the hand's strength: which they are, by the efforts of their states, and what follows from it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/evaluator.h"
#include "core/gather.h"
#include "core/score.h"
#include "shaders/status.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

Scene held_scene() {
  Scene scene = three_beakers();
  scene.strength.emplace();
  scene.tilts = {0, radians(30), radians(75), radians(120)};
  return scene;
}

std::vector<int> asked() { return {FIELD_STATUS, FIELD_SCORE, FIELD_TERMS, FIELD_WORST_EFFORT, FIELD_EFFORT}; }

TEST(NotHeld, AnEffortOfOneHolds) {
  EXPECT_TRUE(core_f64::effort_holds(0));
  EXPECT_TRUE(core_f64::effort_holds(1)) << "all of the strength and no more";
  EXPECT_FALSE(core_f64::effort_holds(std::nextafter(1.0, 2.0)));
  EXPECT_FALSE(core_f64::effort_holds(std::numeric_limits<double>::infinity()));
}

TEST(NotHeld, TheBitDecidesWhoIsEligible) {
  EXPECT_TRUE(is_eligible(STATUS_PLAUSIBLE));
  EXPECT_FALSE(is_eligible(STATUS_PLAUSIBLE | STATUS_NOT_HELD));
  EXPECT_TRUE(is_plausible(STATUS_PLAUSIBLE | STATUS_NOT_HELD));
  EXPECT_FALSE(is_eligible(0));
  for (const std::uint32_t reason : {REASON_MISSES, REASON_ON_MOUTH}) EXPECT_FALSE(is_eligible(STATUS_PLAUSIBLE | reason));
  EXPECT_FALSE(is_plausible(STATUS_PLAUSIBLE | STATUS_OUT_OF_TURNS));
}

TEST(NotHeld, IsAPlausibleGripWithAStateThatTakesMoreThanTheStrength) {
  const Scene scene = held_scene();
  const FieldSet fields = make_field_set(asked(), scene);
  int held = 0, not_held = 0, infinite = 0;
  for (const auto& core : {make_core_evaluator(scene), make_core_float_evaluator(scene)})
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const std::vector<GripInput> grips = sample_grips(scene.vessels[v], 100, 29);
      const GatheredPlanes planes = gather(*core, fields, v, grips);
      for (std::size_t i = 0; i < grips.size(); ++i) {
        const auto real = [&](int field, int k = 0) { return planes.real(fields.plane[field] + k, i); };
        const std::uint32_t status = planes.uint(FIELD_STATUS, i);
        const bool is_not_held = (status & STATUS_NOT_HELD) != 0;
        if (!is_plausible(status)) {
          EXPECT_FALSE(is_not_held);
          continue;
        }
        EXPECT_EQ(is_not_held, real(FIELD_WORST_EFFORT) > 1) << real(FIELD_WORST_EFFORT);
        // the states one by one, each to a bracket of 1e-3
        double worst = 0;
        for (int state = 0; state < field_planes(FIELD_EFFORT, scene); ++state) worst = std::max(worst, real(FIELD_EFFORT, state));
        if (std::abs(worst - 1) > 2e-3) {
          EXPECT_EQ(is_not_held, worst > 1) << worst;
        }
        GripResult result;
        core->grip(v, grips[i], result);
        const GripScore score = core->score(v, grips[i], result);
        EXPECT_EQ(score.not_held, is_not_held);
        EXPECT_EQ(score.score, real(FIELD_SCORE));
        EXPECT_NEAR(real(FIELD_TERMS, 5), 1 / (1 + real(FIELD_WORST_EFFORT)), 1e-6) << "terms stay";
        if (is_not_held) {
          EXPECT_EQ(score.score, 0);
        } else {
          EXPECT_GT(score.score, 0);
        }
        (is_not_held ? not_held : held) += 1;
        infinite += std::isinf(worst) ? 1 : 0;
      }
    }
  EXPECT_GT(held, 20);
  EXPECT_GT(not_held, 20);
  EXPECT_GT(infinite, 2);
}

// Scaling all strengths by s divides an effort by s.
TEST(NotHeld, TheWorstEffortIsTheStrengthThatIsMissing) {
  const Scene scene = held_scene();
  const FieldSet fields = make_field_set(asked(), scene);
  const std::vector<GripInput> grips = sample_grips(scene.vessels[0], 100, 31);
  const GatheredPlanes planes = gather(*make_core_evaluator(scene), fields, 0, grips);
  int tried = 0;
  for (std::size_t i = 0; i < grips.size() && tried < 6; ++i) {
    const double worst = planes.real(fields.plane[FIELD_WORST_EFFORT], i);
    if (!is_plausible(planes.uint(FIELD_STATUS, i)) || !std::isfinite(worst)) continue;
    ++tried;
    for (const double share : {0.997, 1.003}) {
      Scene other = scene;
      for (double& digit : other.strength->digits) digit *= worst * share;
      const GatheredPlanes scaled = gather(*make_core_evaluator(other), fields, 0, {grips[i]});
      EXPECT_EQ((scaled.uint(FIELD_STATUS, 0) & STATUS_NOT_HELD) != 0, share < 1) << worst;
    }
  }
  EXPECT_EQ(tried, 6);
}

TEST(NotHeld, WithoutStrengthOrTiltsNoGripHasTheBit) {
  Scene weak = held_scene(), still = held_scene();
  weak.strength.reset();
  still.tilts.clear();
  for (const Scene& scene : {weak, still}) {
    const std::vector<GripInput> grips = sample_grips(scene.vessels[0], 60, 29);
    const GatheredPlanes planes = gather(*make_core_evaluator(scene), make_field_set({FIELD_STATUS}, scene), 0, grips);
    for (std::size_t i = 0; i < grips.size(); ++i) EXPECT_EQ(planes.uint(FIELD_STATUS, i) & STATUS_NOT_HELD, 0u);
  }
}

}  // namespace
}  // namespace wholehand
