// SPDX-License-Identifier: MIT
// Efforts among the planes and in the score: where they are, and that each follows from the states.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/absent.h"
#include "core/evaluator.h"
#include "core/fields.h"
#include "core/force.h"
#include "core/gather.h"
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
      // the friction needed is at most the set friction exactly if the set friction holds the worst state: to 1e-3 of friction, and
      // as much of the effort
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

// Across the axis of a cylinder the opening is its diameter. All digits have the same share of their strength there, so every effort is
// that at full strength over the share, and a hold force is the same.
TEST(EffortPlanes, StrengthShrinksAsTheHandOpens) {
  const std::vector<int> kept{FIELD_STATUS,       FIELD_EFFORT,    FIELD_WORST_EFFORT, FIELD_TIPS_WORST_EFFORT,
                              FIELD_LARGEST_HOLD, FIELD_HOLD_FORCE};
  int held = 0;
  for (const double diameter : {38.1e-3, 44e-3, 50.8e-3, 60e-3, 63.5e-3, 70e-3, 76.2e-3, 90e-3}) {
    Scene scene = scene_of({cylinder("cup", diameter * 1e3, 110, 2)});
    scene.liquid = LiquidData{1000, {0, 0.8}, {}, Pour::away};
    scene.tilts = {0, radians(60), radians(110)};
    scene.strength.emplace();
    scene.hand.depth_limit = 20e-3;  // most grips are plausible
    Scene fixed = scene;
    fixed.strength->by_opening = false;
    const double share = core_f64::strength_at(diameter);
    const FieldSet fields = make_field_set(kept, scene);
    const auto opened = make_core_evaluator(scene), plain = make_core_evaluator(fixed);
    std::vector<GripInput> grips;
    for (const double height : {0.04, 0.055, 0.07})
      for (const double roll : {-60.0, -20.0, 0.0}) {
        GripInput grip;
        grip.height = height;
        grip.roll = radians(roll);
        grips.push_back(grip);
      }
    const GatheredPlanes shrunk = gather(*opened, fields, 0, grips), full = gather(*plain, fields, 0, grips);
    for (std::size_t i = 0; i < grips.size(); ++i) {
      ASSERT_EQ(shrunk.uint(FIELD_STATUS, i), full.uint(FIELD_STATUS, i));
      if ((full.uint(FIELD_STATUS, i) & STATUS_PLAUSIBLE) == 0) continue;
      const auto expect_ratio = [&](int field, int plane, double ratio) {
        const double is = shrunk.real(fields.plane[field] + plane, i), whole = full.real(fields.plane[field] + plane, i);
        if (!std::isfinite(whole)) {
          EXPECT_EQ(std::isnan(is), std::isnan(whole));
          return;
        }
        ++held;
        EXPECT_NEAR(is, whole * ratio, 2e-3 * whole * ratio) << field_row(field).variable << " at " << diameter;  // two brackets
      };
      expect_ratio(FIELD_WORST_EFFORT, 0, 1 / share);
      expect_ratio(FIELD_TIPS_WORST_EFFORT, 0, 1 / share);
      for (int state = 0; state < 6; ++state) expect_ratio(FIELD_EFFORT, state, 1 / share);
      for (int state = 0; state < 6; ++state) expect_ratio(FIELD_HOLD_FORCE, state, 1);
      for (int fill = 0; fill < 2; ++fill) expect_ratio(FIELD_LARGEST_HOLD, fill, 1);
    }
  }
  EXPECT_GT(held, 300);
}

}  // namespace
}  // namespace wholehand
