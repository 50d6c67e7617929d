// SPDX-License-Identifier: MIT
// Efforts among the planes and in the score: where they are, and that each follows from the states.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/absent.h"
#include "core/evaluator.h"
#include "core/fields.h"
#include "core/planes.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

const std::vector<int> EFFORT_FIELDS{FIELD_WORST_EFFORT,
                                     FIELD_WORST_EFFORT_FILL,
                                     FIELD_WORST_EFFORT_TILT,
                                     FIELD_TIPS_WORST_EFFORT,
                                     FIELD_PUSH,
                                     FIELD_FRICTION_NEEDED,
                                     FIELD_EFFORT,
                                     FIELD_EFFORT_LOW,
                                     FIELD_TIPS_EFFORT};

Scene effort_scene() {
  Scene scene = three_beakers();
  scene.strength.emplace();
  scene.tilts = {0, radians(30), radians(75), radians(120)};
  return scene;
}

std::vector<int> asked_fields() {
  std::vector<int> fields = EFFORT_FIELDS;
  fields.insert(fields.end(), {FIELD_STATUS, FIELD_SCORE, FIELD_TERMS, FIELD_SAFE_TILT});
  return fields;
}

TEST(EffortPlanes, AreAbsentWithoutStrengthOrTilts) {
  Scene weak = effort_scene(), still = effort_scene();
  weak.strength.reset();
  still.tilts.clear();
  for (const Scene& scene : {weak, still}) {
    const FieldSet fields = make_field_set(asked_fields(), scene);
    for (const int field : EFFORT_FIELDS) EXPECT_FALSE(fields.has(field)) << field_row(field).variable;
  }
}

TEST(EffortPlanes, FollowFromTheStates) {
  const Scene scene = effort_scene();
  const auto evaluator = make_core_evaluator(scene);
  const FieldSet fields = make_field_set(asked_fields(), scene);
  int plausible = 0;
  for (std::size_t vessel = 0; vessel < scene.vessels.size(); ++vessel) {
    const std::vector<GripInput> grips = sample_grips(scene.vessels[vessel], 60, 23);
    std::vector<double> reals(static_cast<std::size_t>(fields.real_planes) * grips.size());
    std::vector<std::uint32_t> uints(static_cast<std::size_t>(fields.uint_planes) * grips.size());
    evaluator->planes(vessel, grips.data(), grips.size(), fields, grips.size(), reals.data(), uints.data());
    const Misplaced misplaced = misplaced_values(scene, vessel, fields, grips.size(), grips.size(), reals.data(), uints.data());
    EXPECT_EQ(misplaced.count, 0u) << describe(misplaced);
    for (std::size_t i = 0; i < grips.size(); ++i) {
      const auto real = [&](int field, std::size_t k = 0) {
        return reals[(static_cast<std::size_t>(fields.plane[field]) + k) * grips.size() + i];
      };
      GripResult result;
      evaluator->grip(vessel, grips[i], result);
      const GripScore score = evaluator->score(vessel, grips[i], result);
      EXPECT_EQ(real(FIELD_SCORE), score.score);
      if (!result.plausible) continue;
      ++plausible;
      const std::size_t tilts = scene.tilts.size(), states = scene_fills(scene) * tilts;
      double worst = 0, tips = 0;
      for (std::size_t state = 0; state < states; ++state) {
        worst = std::max(worst, real(FIELD_EFFORT, state));
        tips = std::max(tips, real(FIELD_TIPS_EFFORT, state));
        if (std::isfinite(real(FIELD_EFFORT, state))) {
          EXPECT_LE(real(FIELD_EFFORT_LOW, state), real(FIELD_EFFORT, state));
        }
        // the tips are contacts of the whole hand: two brackets of 1e-3
        EXPECT_LE(real(FIELD_EFFORT, state), real(FIELD_TIPS_EFFORT, state) * 1.002);
      }
      const auto expect_near = [](double found, double wanted) {
        if (std::isinf(wanted)) {
          EXPECT_EQ(found, wanted);
        } else {
          EXPECT_NEAR(found, wanted, 2e-3 * wanted);  // two brackets of 1e-3
        }
      };
      expect_near(real(FIELD_WORST_EFFORT), worst);
      expect_near(real(FIELD_TIPS_WORST_EFFORT), tips);
      EXPECT_EQ(real(FIELD_TERMS, 5), 1 / (1 + real(FIELD_WORST_EFFORT)));
      EXPECT_EQ(score.terms.hold, real(FIELD_TERMS, 5));
      if (real(FIELD_PUSH) > 0) {
        EXPECT_LE(real(FIELD_EFFORT, states - tilts), 1);  // upright, fullest
      }
      // up to the set friction exactly where the worst state is held with it: 1e-3 of friction, as much of the effort
      if (worst < 0.99) {
        EXPECT_LE(real(FIELD_FRICTION_NEEDED), scene.force.friction + 1e-3);
      }
      if (worst > 1.01) {
        EXPECT_GT(real(FIELD_FRICTION_NEEDED), scene.force.friction);
      }
    }
  }
  EXPECT_GT(plausible, 20);
}

}  // namespace
}  // namespace wholehand
