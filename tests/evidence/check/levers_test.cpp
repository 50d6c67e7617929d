// SPDX-License-Identifier: MIT
// Contacts without torsion: which levers count, on every backend, and what the comparison makes of them.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/force.h"
#include "core/vectors.h"
#include "evidence/check/check.h"
#include "evidence/check/compare.h"
#include "tests/support/scenes.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

constexpr double LEVER_SHARE = 1e-3,
                 LEAST_PIVOT = 5e-3;  // m: a lever up to the share of the pivot length, or of the least one, is none

// Tilts whose levers are nanometers upright and tens of nanometers upside down.
Scene bare_scene() {
  Scene scene = scene_of({cylinder("v0", 70, 100, 2)});
  scene.force.torsion = 0;
  scene.tilts = {0, radians(1e-6), radians(179.9999)};
  return scene;
}

// On the level line along x: past the axis by an offset, at heights around the center of mass.
std::vector<GripInput> swept_grips() {
  std::vector<GripInput> grips;
  for (const double height : {0.04, 0.05, 0.06})
    for (int k = -48; k <= -8; ++k) {
      GripInput grip;
      grip.height = height;
      grip.roll = radians(-30);
      grip.offset = std::pow(10, k / 4.0);
      grips.push_back(grip);
    }
  return grips;
}

struct LeverAnswers {
  std::string who;
  GatheredPlanes planes;
};

std::vector<LeverAnswers> lever_answers(const Scene& scene, const std::vector<GripInput>& grips) {
  const FieldSet fields = all_fields(scene);
  std::vector<LeverAnswers> all;
  for (const Precision precision : {Precision::full, Precision::single}) {
    const std::string name = precision == Precision::full ? " double" : " float";
    all.push_back({"core" + name, gather(*core_of(scene, precision), fields, 0, grips)});
    all.push_back({"vulkan" + name, gather(*backend_of(scene, fields, precision), 0, grips)});
  }
  return all;
}

TEST(Levers, CountAlikeOnEveryBackend) {
  const Scene scene = bare_scene();
  const std::vector<GripInput> grips = swept_grips();
  const auto core = make_core_evaluator(scene);
  const VesselConstants glass = core->constants(0);
  const double needed = glass.mass * scene.gravity / (2 * scene.force.friction);
  std::size_t held = 0, unheld = 0;
  for (const auto& [who, planes] : lever_answers(scene, grips)) {
    for (std::size_t i = 0; i < grips.size(); ++i) {
      ASSERT_NE(planes.uint(FIELD_STATUS, i) & STATUS_ANTIPODAL, 0u) << who << " " << i;
      bool is_all_held = true, is_known = true;
      for (std::size_t s = 0; s < scene.tilts.size(); ++s) {
        // the line's lever on the weight: along z upright, and as high as the tilt turns it
        const double beside = -grips[i].offset, above = glass.center_of_mass[1] - grips[i].height;
        const double lever = std::abs(above * std::sin(scene.tilts[s]) - beside * std::cos(scene.tilts[s]));
        const double longest = LEVER_SHARE * std::max(LEAST_PIVOT, std::hypot(beside, above));
        if (std::abs(lever / longest - 1) < 0.05) {
          is_known = false;
          continue;
        }
        const bool is_held = lever < longest;
        is_all_held = is_all_held && is_held;
        const double hold = planes.real(planes.fields.plane[FIELD_HOLD_FORCE] + static_cast<int>(s), i);
        const std::string where = who + ", offset " + std::to_string(grips[i].offset) + ", state " + std::to_string(s);
        ++(is_held ? held : unheld);
        if (is_held) {
          EXPECT_NEAR(hold, needed, 1e-5 * needed) << where;
        } else {
          EXPECT_EQ(hold, HUGE_VAL) << where;
        }
      }
      if (!is_known) continue;
      const double largest = planes.real(planes.fields.plane[FIELD_LARGEST_HOLD], i);
      EXPECT_EQ(std::isfinite(largest), is_all_held) << who << " " << i;
      if (is_all_held) {
        EXPECT_NEAR(planes.real(planes.fields.plane[FIELD_SAFE_TILT], i), scene.tilts.back(), 1e-6) << who << " " << i;
      }
    }
  }
  EXPECT_GT(held, 800u);
  EXPECT_GT(unheld, 200u);
}

// The longest lever of forces at a place about the line of two contacts, over the longest that is none.
double longest_share(const Vec3& a, const Vec3& b, const Vec3& place, const std::vector<Vec3>& directions) {
  const Vec3 arm = place - (a + b) * 0.5, line = glm::normalize(b - a);
  double most = 0;
  for (const Vec3& along : directions) most = std::max(most, std::abs(glm::dot(line, glm::cross(arm, along))));
  return most / (LEVER_SHARE * std::max(LEAST_PIVOT, glm::length(arm)));
}

// A puck that the tips alone touch: what holds for the tips holds for the whole hand, its reserves too.
Scene puck_scene() {
  Scene scene = bare_scene();
  scene.vessels = {cylinder("puck", 50, 10, 2)};
  return scene;
}

struct CountedLevers {
  int held = 0, unheld = 0, pushed = 0, unpushed = 0;
};

// Grips so far above a height, each on the axis and then further and further off it.
std::vector<GripInput> grips_off(double height, const std::vector<double>& above) {
  std::vector<GripInput> grips;
  for (const double higher : above)
    for (int k = -49; k <= -12; ++k) {
      GripInput grip;
      grip.height = height + higher;
      grip.roll = radians(-30);
      grip.offset = k == -49 ? 0 : std::pow(10, k / 4.0);
      grips.push_back(grip);
    }
  return grips;
}

// Grips off the axis and off the height of the center of mass against the grip at the same height on the axis, or at the center of mass.
CountedLevers count_levers(Scene scene, const std::vector<double>& above) {
  scene.strength.emplace();
  scene.hand.depth_limit = 20e-3;  // most grips are plausible
  const auto core = make_core_evaluator(scene);
  const Vec3 center = to_vec3<double>(core->constants(0).center_of_mass);
  std::vector<Vec3> weights;
  for (const double tilt : scene.tilts) weights.push_back(core_f64::up_direction({0, 0, -1}, std::sin(tilt), std::cos(tilt)));
  const std::vector<GripInput> grips = grips_off(center.y, above);
  const std::size_t in_a_row = grips.size() / above.size();
  const FieldSet fields = all_fields(scene);
  const GatheredPlanes truth = gather(*core, fields, 0, grips);
  CountedLevers counted;
  for (const auto& [who, planes] : lever_answers(scene, grips)) {
    for (std::size_t i = 0; i < grips.size(); ++i) {
      GripResult result;
      core->grip(0, grips[i], result);
      const std::vector<GripContact> contacts = core->contacts(0, result);
      std::vector<Vec3> tips;
      for (const GripContact& contact : contacts)
        if (contact.is_tip) tips.push_back(to_vec3<double>(contact.point));
      if (tips.size() != 2) {
        ADD_FAILURE() << i;
        continue;
      }
      const std::string where = who + ", above " + std::to_string(grips[i].height - center.y) + ", offset 1e" +
                                std::to_string(std::log10(grips[i].offset));
      const auto expect = [&](int field, bool is_none, double otherwise, std::size_t at) {
        const double found = planes.real(planes.fields.plane[field], i), as = truth.real(fields.plane[field], at);
        if (is_none) {
          EXPECT_NEAR(found, as, 3e-3 * as + (field == FIELD_FRICTION_NEEDED ? 1e-3 : 0)) << where << ", field " << field;
        } else {
          EXPECT_EQ(found, otherwise) << where << ", field " << field;
        }
      };
      const std::size_t on_axis = i - i % in_a_row;
      const double share = longest_share(tips[0], tips[1], center, weights);
      if (std::abs(share - 1) < 0.05) continue;
      const bool is_none = share < 1;
      ++(is_none ? counted.held : counted.unheld);
      expect(FIELD_TIPS_WORST_EFFORT, is_none, HUGE_VAL, on_axis);
      if (contacts.size() > 2) {
        const double whole = planes.real(planes.fields.plane[FIELD_WORST_EFFORT], i),
                     pinch = planes.real(planes.fields.plane[FIELD_TIPS_WORST_EFFORT], i);
        EXPECT_LE(whole, pinch * (1 + 3e-3)) << where;
        continue;
      }
      expect(FIELD_WORST_EFFORT, is_none, HUGE_VAL, on_axis);
      expect(FIELD_FRICTION_NEEDED, is_none, HUGE_VAL, on_axis);
      if (is_none) expect(FIELD_SAFE_TILT, true, 0, on_axis);
      const double of_pushes = longest_share(tips[0], tips[1], center, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
      if (std::abs(of_pushes - 1) < 0.05) continue;
      expect(FIELD_PUSH, of_pushes < 1, 0, 0);
      ++(of_pushes < 1 ? counted.pushed : counted.unpushed);
    }
  }
  return counted;
}

TEST(Levers, CountAlikeInEffortsOnEveryBackend) {
  const CountedLevers puck = count_levers(puck_scene(), {0, 1e-9, -1e-7, 1e-6, 4e-6, -6e-6, 1e-4, 2e-3});
  EXPECT_GT(puck.held, 500);
  EXPECT_GT(puck.unheld, 200);
  EXPECT_GT(puck.pushed, 300);
  EXPECT_GT(puck.unpushed, 300);
  const CountedLevers beaker = count_levers(bare_scene(), {-0.03, 0, 0.02});
  EXPECT_GT(beaker.held, 200);
  EXPECT_GT(beaker.unheld, 60);
}

TEST(Levers, OfASceneWithoutTorsionAgree) {
  Scene scene = bare_scene();
  scene.grips.height.values = {0.04, 0.05, 0.06};
  scene.grips.roll.values = {radians(-60), radians(-30)};
  const CheckReport report = check_scene(scene, {});
  EXPECT_TRUE(verdict_of(report).holds) << check_text(report);
}

// A hold force near no lever is compared like any other, and a lever that counts on one side alone is found.
TEST(Levers, AreComparedWhereTheyAreNone) {
  const Scene scene = bare_scene();
  const std::vector<GripInput> grips = swept_grips();
  const auto core = make_core_evaluator(scene);
  const GatheredPlanes truth = gather(*core, all_fields(scene), 0, grips);
  const int first = truth.fields.plane[FIELD_HOLD_FORCE];
  for (const double wrong : {0.99, HUGE_VAL}) {
    GatheredPlanes other = truth;
    std::uint64_t changed = 0;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      if (grips[i].offset > 1e-7) continue;
      for (std::size_t s = 0; s < scene.tilts.size(); ++s) other.reals[(first + s) * grips.size() + i] *= wrong;
      ++changed;
    }
    Comparer comparer(scene, *core, float_against_double());
    comparer.add(0, grips, other, truth);
    int rows = 0;
    for (const Comparison& row : comparer.rows()) {
      if (row.quantity != "hold force") continue;
      EXPECT_EQ(row.outside, changed) << wrong;
      ++rows;
    }
    EXPECT_EQ(rows, 1);
  }
}

}  // namespace
}  // namespace wholehand
