// SPDX-License-Identifier: MIT
// Which tilts count for a fill, found by going through its liquid tilt by tilt. A grip's worst values come from these tilts alone.
#include "core/counted_tilts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/absent.h"
#include "core/gather.h"
#include "tests/support/scenes.h"
#include "tests/support/special_values.h"

namespace wholehand {
namespace {

constexpr int STATE_FIELDS[] = {FIELD_PIVOT_LENGTH, FIELD_TORQUE,         FIELD_EXACT_TORQUE,
                                FIELD_NORMAL_FORCE, FIELD_FEEDBACK_FORCE, FIELD_HOLD_FORCE};

Scene poured_scene(double share) {
  Scene scene = scene_of({beaker1(), beaker2(), beaker3(), vase()});
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 1e-3, 0.3, 0.8, 1};
  scene.tilts = linspace(0, PI, 37);
  scene.until_poured = share;
  scene.force.max = 2.2;  // so that safe tilts end among those that count, and beyond them
  return scene;
}

// The rule, word by word: a tilt counts while less than the share has poured at the tilt before it.
std::size_t counted_by_rule(const Scene& scene, const Evaluator& core, std::size_t vessel, double fill) {
  const double filled = fill * core.capacity(vessel);
  std::size_t count = 1;
  while (count < scene.tilts.size() &&
         (filled == 0 || core.liquid(vessel, fill, scene.tilts[count - 1]).poured < *scene.until_poured * filled))
    ++count;
  return count;
}

TEST(CountedTilts, AreThoseBeforeWhichTheShareHasNotPoured) {
  std::size_t left_out = 0;
  for (const double share : {1e-6, 0.01, 0.25, 0.5, 0.9, 1.0}) {
    for (const std::vector<double>& tilts :
         {linspace(0, PI, 37), linspace(0, radians(60), 7), {radians(33.3), radians(71.7), radians(90), radians(179.9)}}) {
      Scene scene = poured_scene(share);
      scene.tilts = tilts;
      const auto core = make_core_evaluator(scene);
      for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
        const std::vector<std::size_t> counted = counted_tilts(scene, v);
        ASSERT_EQ(counted.size(), scene.liquid->fills.size());
        for (std::size_t f = 0; f < counted.size(); ++f) {
          EXPECT_EQ(counted[f], counted_by_rule(scene, *core, v, scene.liquid->fills[f]))
              << share << " " << scene.vessels[v].name << " fill " << scene.liquid->fills[f];
          left_out += tilts.size() - counted[f];
        }
        EXPECT_EQ(counted_tilts(scene, v, {0.8, 0.3}), (std::vector<std::size_t>{counted[3], counted[2]}));
      }
    }
  }
  EXPECT_GT(left_out, 500u);
}

TEST(CountedTilts, AllOfAFillCountsUpToTheTiltAtWhichItIsOut) {
  const Scene scene = poured_scene(1);
  const auto core = make_core_evaluator(scene);
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    const std::vector<std::size_t> counted = counted_tilts(scene, v);
    for (std::size_t f = 1; f < counted.size(); ++f) {
      const double fill = scene.liquid->fills[f];
      ASSERT_GT(counted[f], 1u);
      ASSERT_LT(counted[f], scene.tilts.size()) << "upside down the vessel is empty";
      EXPECT_EQ(core->liquid(v, fill, scene.tilts[counted[f] - 1]).volume, 0);
      EXPECT_GT(core->liquid(v, fill, scene.tilts[counted[f] - 2]).volume, 0);
    }
  }
  EXPECT_EQ(counted_tilts(scene, 0)[4], 19u);  // a cylinder is empty when it lies
}

TEST(CountedTilts, TheFirstTiltCountsWhateverHasPoured) {
  Scene scene = poured_scene(0.1);
  scene.tilts = {radians(170), PI};
  EXPECT_EQ(counted_tilts(scene, 0), (std::vector<std::size_t>{2, 1, 1, 1, 1}));
}

TEST(CountedTilts, AllCountWhereThereIsNothingToPour) {
  Scene scene = poured_scene(0.1);
  EXPECT_EQ(counted_tilts(scene, 0)[0], 37u) << "an empty fill";
  scene.vessels = {ledges()};
  EXPECT_EQ(counted_tilts(scene, 0), (std::vector<std::size_t>(5, 37))) << "no cavity";
  scene.vessels = {beaker1()};
  scene.until_poured.reset();
  EXPECT_EQ(counted_tilts(scene, 0), (std::vector<std::size_t>(5, 37)));
  scene.until_poured = 0.1;
  scene.liquid.reset();
  EXPECT_EQ(counted_tilts(scene, 0), (std::vector<std::size_t>{37}));
  scene.tilts.clear();
  EXPECT_EQ(counted_tilts(scene, 0), (std::vector<std::size_t>{0}));
}

// A grip's values over the tilts of a fill, computed from the states that count.
struct OverTilts {
  double peak = -1, peak_tilt = 0, hold = 0, safe = NOT_A_NUMBER;
};

OverTilts over_tilts(const Scene& scene, const GatheredPlanes& all, std::size_t fill, std::size_t counted, std::size_t i,
                     Precision precision) {
  const auto rounded = [&](double value) { return precision == Precision::single ? double(float(value)) : value; };
  OverTilts over;
  bool safe = true;
  for (std::size_t t = 0; t < counted; ++t) {
    const int state = static_cast<int>(fill * scene.tilts.size() + t);
    const auto force = [&](int field) { return all.real(all.fields.plane[field] + state, i); };
    if (force(FIELD_FEEDBACK_FORCE) > over.peak) {
      over.peak = force(FIELD_FEEDBACK_FORCE);
      over.peak_tilt = rounded(scene.tilts[t]);
    }
    over.hold = std::max(over.hold, force(FIELD_HOLD_FORCE));
    safe = safe && force(FIELD_NORMAL_FORCE) < rounded(scene.force.max) && force(FIELD_HOLD_FORCE) <= scene.force.grip_strength;
    if (safe) over.safe = rounded(scene.tilts[t]);
  }
  return over;
}

void expect_same(double a, double b, const std::string& what) {
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << what << ": " << a << " and " << b;
}

// Compares planes of `cut` with those of the same scene without `until_poured`. Returns for how many grips and fills the worst
// value changes.
std::size_t expect_cut(const Scene& cut, const GatheredPlanes& some, const GatheredPlanes& all, std::size_t vessel,
                       Precision precision) {
  const std::vector<std::size_t> counted = counted_tilts(cut, vessel);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < all.count; ++i) {
    if ((all.uint(FIELD_STATUS, i) & STATUS_REASON_MASK) != REASON_NONE) continue;
    const auto number = [&](int field, std::size_t k) { return some.real(some.fields.plane[field] + static_cast<int>(k), i); };
    double peak = 0, hold = 0;
    for (std::size_t f = 0; f < counted.size(); ++f) {
      for (const int field : STATE_FIELDS) {
        for (std::size_t t = 0; t < cut.tilts.size(); ++t) {
          const std::size_t state = f * cut.tilts.size() + t;
          const double own = all.real(all.fields.plane[field] + static_cast<int>(state), i);
          expect_same(number(field, state), t < counted[f] ? own : NOT_A_NUMBER, "a state");
        }
      }
      const OverTilts over = over_tilts(cut, all, f, counted[f], i, precision);
      expect_same(number(FIELD_PEAK_FORCE, f), over.peak, "peak");
      expect_same(number(FIELD_PEAK_TILT, f), over.peak_tilt, "peak tilt");
      expect_same(number(FIELD_LARGEST_HOLD, f), over.hold, "hold");
      expect_same(number(FIELD_SAFE_TILT, f), over.safe, "safe tilt");
      const OverTilts whole = over_tilts(cut, all, f, cut.tilts.size(), i, precision);
      changed += whole.peak != over.peak || whole.hold != over.hold ? 1 : 0;
      peak = std::max(peak, over.peak);
      hold = std::max(hold, over.hold);
    }
    // a few roundings of the precision, of terms up to 1
    const double tolerance = precision == Precision::single ? 1e-6 : 1e-15;
    EXPECT_NEAR(number(FIELD_TERMS, 4), 1 - peak / cut.force.max, tolerance);
    EXPECT_NEAR(number(FIELD_TERMS, 5), std::min(1.0, cut.force.grip_strength / hold), tolerance);
  }
  return changed;
}

TEST(CountedTilts, TheWorstOfAGripIsThatOfTheStatesThatCount) {
  for (const Precision precision : {Precision::full, Precision::single}) {
    const auto core_of = [&](const Scene& scene) -> std::unique_ptr<Evaluator> {
      return precision == Precision::full ? make_core_evaluator(scene) : make_core_float_evaluator(scene);
    };
    const Scene cut = poured_scene(0.5);
    Scene whole = cut;
    whole.until_poured.reset();
    const auto some = core_of(cut), all = core_of(whole);
    const FieldSet fields = all_fields(cut);
    std::size_t changed = 0;
    for (std::size_t v = 0; v < cut.vessels.size(); ++v) {
      const std::vector<GripInput> grips = sample_grips(cut.vessels[v], 60, 3 + v);
      const GatheredPlanes planes = gather(*some, fields, v, grips);
      changed += expect_cut(cut, planes, gather(*all, fields, v, grips), v, precision);
      EXPECT_EQ(describe(misplaced_values(cut, v, fields, planes.count, planes.count, planes.reals.data(), planes.uints.data())),
                "");
      EXPECT_EQ(some->constants(v).torque_reference, all->constants(v).torque_reference);
      for (const double tilt : cut.tilts) EXPECT_EQ(some->liquid(v, 0.8, tilt).mass, all->liquid(v, 0.8, tilt).mass);
    }
    EXPECT_GT(changed, 50u);
  }
}

TEST(CountedTilts, AScoreIsThatOfThePlanes) {
  const Scene scene = poured_scene(0.5);
  const auto core = make_core_evaluator(scene);
  const FieldSet fields = all_fields(scene);
  const std::vector<GripInput> grips = sample_grips(scene.vessels[1], 40, 5);
  const GatheredPlanes planes = gather(*core, fields, 1, grips);
  for (std::size_t i = 0; i < grips.size(); ++i) {
    GripResult result;
    core->grip(1, grips[i], result);
    const GripScore score = core->score(1, grips[i], result);
    EXPECT_EQ(score.score, planes.real(fields.plane[FIELD_SCORE], i));
    for (std::size_t f = 0; f < score.fills.size(); ++f)
      expect_same(score.fills[f].safe_tilt, planes.real(fields.plane[FIELD_SAFE_TILT] + static_cast<int>(f), i), "safe tilt");
  }
}

// Left-out states have no values, and those that count have them.
TEST(CountedTilts, AMisplacedStateIsFound) {
  const Scene scene = poured_scene(0.5);
  const FieldSet fields = all_fields(scene);
  GatheredPlanes planes = gather(*make_core_evaluator(scene), fields, 0, {{0.055, 0, 0, 0, 0, 1}});
  const auto found = [&] {
    return misplaced_values(scene, 0, fields, planes.count, planes.count, planes.reals.data(), planes.uints.data()).count;
  };
  ASSERT_EQ(found(), 0u);
  const std::size_t last = 4 * scene.tilts.size() + counted_tilts(scene, 0)[4] - 1;
  double* torque = planes.reals.data() + fields.plane[FIELD_TORQUE];
  torque[last + 1] = 0;
  EXPECT_EQ(found(), 1u);
  torque[last + 1] = NOT_A_NUMBER;
  torque[last] = NOT_A_NUMBER;
  EXPECT_EQ(found(), 1u);
}

}  // namespace
}  // namespace wholehand
