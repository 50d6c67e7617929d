// SPDX-License-Identifier: MIT
// The scenes of examples/extreme: each says what makes it hard and what the result must be, and the core gives it.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/effort.h"
#include "core/held.h"
#include "core/joints.h"
#include "core/load.h"
#include "core/prepare.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/extreme.h"
#include "host/open_backend.h"
#include "sweeps/lists/robust.h"
#include "sweeps/plan/plan.h"
#include "tests/support/capsule_check.h"
#include "tests/support/extreme_scenes.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

constexpr double STOP = STOP_TOLERANCE_F64;
constexpr double MICROMETER = 1e-6;

// ---- the effort of a grip, its vessel upright and empty ----

// `tips_only`: thumb and index tip press alone.
std::vector<core_f64::ContactPoint> upright_contacts(const AnsweredScene& a, std::size_t v, std::size_t i, bool tips_only) {
  std::vector<core_f64::ContactPoint> contacts;
  for (const GripContact& at : a.core->contacts(v, a.result(v, i))) {
    const bool is_tip = at.between == 0 && (at.joint == finger_start(0) + 3 || at.joint == finger_start(1) + 4);
    if (tips_only && !is_tip) continue;
    contacts.push_back({{at.point[0], at.point[1], at.point[2]}, {at.normal[0], at.normal[1], at.normal[2]}, at.digit, is_tip});
  }
  return contacts;
}

core_f64::Effort upright_effort(const AnsweredScene& a, std::size_t v, std::size_t i, const core_f64::HandStrength& hand,
                                bool tips_only = false) {
  const std::vector<core_f64::ContactPoint> contacts = upright_contacts(a, v, i, tips_only);
  const VesselConstants vessel = a.core->constants(v);
  const core_f64::Vec3 center(vessel.center_of_mass[0], vessel.center_of_mass[1], vessel.center_of_mass[2]);
  core_f64::EffortSolver solver(contacts, hand, center);
  return solver.solve(core_f64::wrench_at(center, {0, -vessel.mass * a.scene.gravity, 0}));
}

core_f64::HandStrength even_strength(const AnsweredScene& a, double strength) {
  core_f64::HandStrength hand{a.scene.force.friction, a.scene.force.torsion, {}};
  hand.digits.fill(strength);
  return hand;
}

core_f64::HandStrength scene_strength(const AnsweredScene& a, std::size_t v, std::size_t i) {
  return core_f64::load_strength(a.scene, a.result(v, i));
}

// Prices of 1e6, or of the ratio of the digits' strengths, each rounded by 1e-16.
constexpr double EFFORT_ROUNDED = 1e-6;

// ---- expected results, scene by scene, of the core in double ----

void along_the_axis(const AnsweredScene& a) {
  for (std::size_t i = 0; i < a.grips[0].size(); ++i) {
    const bool exactly = std::abs(a.grips[0][i].obliquity) == radians(90);
    EXPECT_EQ(a.reason(0, i), exactly ? REASON_DEGENERATE : REASON_ON_MOUTH) << i;
  }
}

// The line passes the center of mass; the middle of the tips, 8 and 7 mm thick, half a millimeter along it. So no torque topples
// the block, whatever the tilt.
void center_of_mass(const AnsweredScene& a) {
  EXPECT_EQ(a.count_feasible(), a.grips[0].size());
  a.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    const bool through = a.grips[v][i].height == 0.055;
    const double lever = through ? STOP : 2e-9;  // m
    EXPECT_NEAR(a.real(FIELD_PIVOT_LENGTH, v, i, s), 0.5e-3, lever);
    EXPECT_NEAR(a.real(FIELD_FEEDBACK_FORCE, v, i, s), a.scene.force.base, a.scene.force.range * lever / SMALLEST_PIVOT);
  });
}

void creases_and_rim(const AnsweredScene& a) { EXPECT_EQ(a.count_feasible(), a.grips[0].size()); }

// A bead of 1 mm between tips of 15 mm: their gap is theirs and little more.
void one_millimeter(const AnsweredScene& a) {
  EXPECT_EQ(a.count_feasible(), a.grips[0].size());
  a.each([&](std::size_t v, std::size_t i) {
    EXPECT_GE(a.real(FIELD_GAP, v, i), 0.015);
    EXPECT_LE(a.real(FIELD_GAP, v, i), 0.0175);  // a bead's diagonal more, and what the tips stand aslant
  });
}

void dwarf(const AnsweredScene& a) {
  EXPECT_GT(4 * a.count_feasible(), 3 * a.grips[0].size());
  a.each([&](std::size_t v, std::size_t i) { EXPECT_LT(a.real(FIELD_GAP, v, i), 1.28e-3); });
}

void giant(const AnsweredScene& a) {
  EXPECT_GT(4 * a.count_feasible(), 3 * a.grips[0].size());
  EXPECT_GT(a.core->constants(0).largest_mass, 4e5);  // kg
  a.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    EXPECT_LE(a.real(FIELD_FEEDBACK_FORCE, v, i, s), a.scene.force.max);
    EXPECT_GT(a.real(FIELD_HOLD_FORCE, v, i, s), 1e5);  // N; infinite where not antipodal
  });
}

void tank_of_ten_meters(const AnsweredScene& a) {
  for (std::size_t i = 0; i < a.grips[0].size(); ++i) EXPECT_EQ(a.reason(0, i), REASON_TOO_WIDE) << i;
}

void pole_of_ten_meters(const AnsweredScene& a) { EXPECT_EQ(a.count_feasible(), a.grips[0].size()); }

// The same hand on the same vessel at another size: the scene's lengths over `factor` are those of a beaker and a common hand.
void like_a_beaker(const AnsweredScene& a, double factor) {
  Scene common = a.scene;
  common.hand.scale /= factor;
  common.hand.contact_tolerance /= factor;
  common.vessels[0] = scaled(a.scene.vessels[0], 1 / factor);
  const AnsweredScene b(common);
  EXPECT_GT(4 * a.count_feasible(), 3 * a.grips[0].size());
  a.each([&](std::size_t v, std::size_t i) {
    ASSERT_TRUE(b.feasible(v, i)) << i;
    // each of two tips stops within the tolerance of a wall that it meets at up to 45 degrees; the gap falls by 0.1 m over the
    // closures
    const double off = 8 * STOP * std::max(1.0, factor) / std::min(1.0, factor);
    EXPECT_NEAR(a.real(FIELD_GAP, v, i) / factor, b.real(FIELD_GAP, v, i), off);
    EXPECT_NEAR(a.real(FIELD_CLOSURE, v, i), b.real(FIELD_CLOSURE, v, i), off / 0.05);
  });
}
void small_hand(const AnsweredScene& a) { like_a_beaker(a, 0.1); }
void large_hand(const AnsweredScene& a) { like_a_beaker(a, 10); }

void tangent_to_the_wall(const AnsweredScene& a) {
  for (std::size_t i = 0; i < a.grips[0].size(); ++i) {
    const double offset = std::abs(a.grips[0][i].offset);
    const bool within = offset < 0.0469;  // the index tip is 7 mm thick
    const bool beyond = offset > 0.047 + STOP;
    EXPECT_TRUE(!beyond || a.reason(0, i) == REASON_MISSES) << i;
    EXPECT_TRUE(!within || a.feasible(0, i)) << i;
  }
  EXPECT_GE(a.count_feasible(), 20u);
  a.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    EXPECT_FALSE(a.antipodal(v, i)) << i;
    EXPECT_EQ(a.real(FIELD_HOLD_FORCE, v, i, s), HUGE_VAL) << i;
  });
}

void edges_of_a_micrometer(const AnsweredScene& a) {
  Scene smooth = a.scene;
  smooth.vessels[0].outline = cylinder("smooth", 60, 90, 1).outline;
  const AnsweredScene b(smooth);
  EXPECT_EQ(a.count_feasible(), b.count_feasible());
  a.each([&](std::size_t v, std::size_t i) {
    // a micrometer on either side, met aslant
    EXPECT_NEAR(a.real(FIELD_GAP, v, i), b.real(FIELD_GAP, v, i), 4 * MICROMETER) << i;
  });
}

void thousand_elements(const AnsweredScene& a) {
  EXPECT_EQ(a.scene.vessels[0].outline.size(), 1000u);
  EXPECT_GE(prepare_vessel(a.scene.vessels[0], true).cavity.size(), 1000u);
  EXPECT_EQ(a.count_feasible(), a.grips[0].size());
}

void far_off(const AnsweredScene& a) {
  EXPECT_GT(4 * a.count_feasible(), 3 * a.grips[0].size());
  bool clamped = false;
  a.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    EXPECT_NEAR(a.real(FIELD_PIVOT_LENGTH, v, i, s), 10, 0.1);
    EXPECT_LE(a.real(FIELD_FEEDBACK_FORCE, v, i, s), a.scene.force.max);
    clamped |= a.real(FIELD_FEEDBACK_FORCE, v, i, s) == a.scene.force.max;
  });
  EXPECT_TRUE(clamped);
}

// The film of a cylinder of radius R and height H: pi (R^2 H - (R - w)^2 (H - w)).
void thin_wall(const AnsweredScene& a) {
  const double r = 0.03, h = 0.09, w = 1e-4, mass = 2230 * PI * (r * r * h - (r - w) * (r - w) * (h - w));
  EXPECT_NEAR(a.core->constants(0).mass, mass, 1e-10 * 2230 * PI * r * r * h);  // kg: the difference of two volumes
  EXPECT_EQ(a.count_feasible(), a.grips[0].size());
}

void fills_at_their_ends(const AnsweredScene& a) {
  const double capacity = a.core->capacity(0);
  for (const double fill : a.scene.liquid->fills)
    for (const double tilt : {0.0, radians(1e-9)})
      EXPECT_NEAR(a.core->liquid(0, fill, tilt).volume, fill * capacity, LEVEL_TOLERANCE_F64 * capacity) << fill;
  const LiquidResult film = a.core->liquid(0, 1e-12, 0);
  EXPECT_GT(film.mass, 0);
  EXPECT_NEAR(film.mass, 1e-12 * capacity * 1000, 1e-24);
  EXPECT_NEAR(film.height, a.core->liquid(0, 0, 0).height, 1e-9);  // on the floor
}

void full_to_the_brim(const AnsweredScene& a) {
  const double capacity = a.core->capacity(0);
  EXPECT_EQ(a.core->liquid(0, 1, 0).volume, capacity);
  EXPECT_EQ(a.core->liquid(0, 1, PI).volume, 0);
  EXPECT_LT(a.core->pouring_tilt(0, 1), radians(1e-3));
  double before = capacity;
  for (const double tilt : a.scene.tilts) {
    const LiquidResult liquid = a.core->liquid(0, 1, tilt);
    EXPECT_LE(liquid.volume, before) << degrees(tilt);
    EXPECT_NEAR(liquid.volume + liquid.poured, capacity, 1e-15 * capacity);
    before = liquid.volume;
  }
  EXPECT_LT(a.core->liquid(0, 1, radians(1)).volume, capacity);
}

void empty_glass(const AnsweredScene& a) {
  Scene dry = a.scene;
  dry.liquid.reset();
  const AnsweredScene b(dry);
  for (const int field : {FIELD_SCORE, FIELD_PEAK_FORCE, FIELD_LARGEST_HOLD})
    a.each([&](std::size_t v, std::size_t i) { EXPECT_EQ(a.real(field, v, i), b.real(field, v, i)) << field << " " << i; });
  for (const int field : {FIELD_TORQUE, FIELD_EXACT_TORQUE, FIELD_FEEDBACK_FORCE, FIELD_HOLD_FORCE})
    a.each_state([&](std::size_t v, std::size_t i, std::size_t s) { EXPECT_EQ(a.real(field, v, i, s), b.real(field, v, i, s)); });
  EXPECT_TRUE(std::isnan(a.core->pouring_tilt(0, 0)));
}

void right_angles(const AnsweredScene& a) {
  EXPECT_EQ(a.scene.tilts, (std::vector<double>{0, PI / 2, PI}));
  for (const std::size_t v : {0u, 1u}) {
    const double capacity = a.core->capacity(v);
    for (const double fill : {0.5, 1.0}) {
      EXPECT_DOUBLE_EQ(a.core->liquid(v, fill, 0).volume, fill * capacity);
      EXPECT_EQ(a.core->liquid(v, fill, PI).volume, 0);
      const double level = a.core->liquid(v, fill, PI / 2).volume;
      EXPECT_GE(level, v == 0 ? 0 : 0.01 * capacity);
      EXPECT_LE(level, v == 0 ? 0 : 0.9 * fill * capacity);
    }
  }
}

void light_and_heavy(const AnsweredScene& a) {
  EXPECT_EQ(*a.scene.vessels[0].mass, 1e-6);
  EXPECT_EQ(*a.scene.vessels[1].mass, 1000);
  a.each_state([&](std::size_t, std::size_t i, std::size_t s) {
    const double heavy = a.real(FIELD_HOLD_FORCE, 1, i, s), light = a.real(FIELD_HOLD_FORCE, 0, i, s);
    EXPECT_EQ(std::isfinite(heavy), std::isfinite(light));
    EXPECT_TRUE(light * 1e9 == heavy || std::abs(light * 1e9 - heavy) < 1e-12 * heavy) << light << " " << heavy;
    EXPECT_NEAR(a.real(FIELD_FEEDBACK_FORCE, 0, i, s), a.real(FIELD_FEEDBACK_FORCE, 1, i, s), 1e-14 * 8);
  });
}

// The same without [strength]: what holds it is a pinch of two tips.
AnsweredScene pinched(const AnsweredScene& a) {
  Scene scene = a.scene;
  scene.strength.reset();
  return AnsweredScene(scene);
}

void no_friction(const AnsweredScene& a) {
  const AnsweredScene pinch = pinched(a);
  pinch.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    EXPECT_EQ(pinch.real(FIELD_HOLD_FORCE, v, i, s), HUGE_VAL);
    EXPECT_EQ(pinch.real(FIELD_TERMS, v, i, 5), 0);
    EXPECT_TRUE(std::isnan(pinch.real(FIELD_SAFE_TILT, v, i)));
  });
  a.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    EXPECT_FALSE(a.antipodal(v, i));
    const double hold = a.real(FIELD_HOLD_FORCE, v, i, s);
    EXPECT_TRUE((a.status(v, i) & STATUS_PLAUSIBLE) != 0 ? hold == HUGE_VAL : std::isnan(hold)) << i << " " << hold;
    EXPECT_TRUE(std::isfinite(a.real(FIELD_FEEDBACK_FORCE, v, i, s)));
  });
  a.each([&](std::size_t v, std::size_t i) {
    // a hand that is all round it holds it, upright a finger under the base does
    EXPECT_EQ(a.real(FIELD_TERMS, v, i, 5) > 0, std::isfinite(a.real(FIELD_WORST_EFFORT, v, i))) << i;
    const bool is_upright = upright_effort(a, v, i, scene_strength(a, v, i), false).effort <= 1;
    if ((a.status(v, i) & STATUS_PLAUSIBLE) != 0) {
      EXPECT_EQ(std::isfinite(a.real(FIELD_SAFE_TILT, v, i)), is_upright) << i;
    }
    const core_f64::Effort tips = upright_effort(a, v, i, scene_strength(a, v, i), true);
    EXPECT_EQ(tips.low, HUGE_VAL) << i;
    EXPECT_EQ(tips.effort, HUGE_VAL) << i;
  });
}

// From the weakest to the strongest hand less effort; the two are alike but for the size of all strengths.
void weak_and_strong(const AnsweredScene& a) {
  std::size_t held = 0;
  a.each([&](std::size_t v, std::size_t i) {
    const core_f64::Effort weak = upright_effort(a, v, i, even_strength(a, 0.1)),
                           mixed = upright_effort(a, v, i, scene_strength(a, v, i)),
                           strong = upright_effort(a, v, i, even_strength(a, 10000));
    EXPECT_EQ(std::isfinite(weak.effort), std::isfinite(strong.effort)) << i;
    if (a.antipodal(v, i)) {
      EXPECT_TRUE(std::isfinite(weak.effort)) << i;
    }
    if (!std::isfinite(weak.effort)) return;
    ++held;
    EXPECT_NEAR(weak.effort, 1e5 * strong.effort, EFFORT_ROUNDED * weak.effort) << i;
    EXPECT_LE(strong.low, mixed.effort * (1 + EFFORT_ROUNDED)) << i;
    EXPECT_LE(mixed.low, weak.effort * (1 + EFFORT_ROUNDED)) << i;
  });
  EXPECT_GT(held, 10u);
}

void most_friction(const AnsweredScene& a) {
  std::size_t held = 0;
  a.each([&](std::size_t v, std::size_t i) {
    core_f64::HandStrength usual = scene_strength(a, v, i);
    usual.friction = 0.6;
    const core_f64::Effort rough = upright_effort(a, v, i, scene_strength(a, v, i)), smooth = upright_effort(a, v, i, usual);
    EXPECT_LE(rough.low, smooth.effort * (1 + EFFORT_ROUNDED)) << i;
    if ((a.status(v, i) & STATUS_GRAZING) != 0) return;
    EXPECT_TRUE(a.antipodal(v, i)) << i;
    EXPECT_TRUE(std::isfinite(rough.effort)) << i;
    held += std::isfinite(smooth.effort) ? 1 : 0;
  });
  EXPECT_GT(held, 10u);
}

void far_above_the_table(const AnsweredScene& a) {
  Scene bare = a.scene;
  bare.table->clearance = 0;
  const AnsweredScene b(bare);
  std::size_t plausible = 0, through = 0;
  a.each([&](std::size_t v, std::size_t i) {
    const double depth = a.real(FIELD_TABLE_DEPTH, v, i);
    EXPECT_NEAR(depth, b.real(FIELD_TABLE_DEPTH, v, i) + 0.1, 1e-15) << i;
    EXPECT_EQ((a.status(v, i) & STATUS_THROUGH_TABLE) != 0, depth > 0) << i;
    through += depth > 0 ? 1 : 0;
    if ((a.status(v, i) & STATUS_PLAUSIBLE) == 0) return;
    ++plausible;
    const CapsuleCheck check = check_capsules(a.scene, *a.core, v, a.grips[v][i], a.result(v, i));
    EXPECT_GE(check.lowest, 0.1 - 1e-12) << i;
  });
  EXPECT_GT(plausible, 3u);
  EXPECT_GT(through, 10u);
}

// A place on a bone is at most a ninth of half the bone from a sphere, and as much deeper: 68 mm of the longest bone.
void most_bodies(const AnsweredScene& a) {
  Scene bare = a.scene;
  bare.hand.between = 0;
  const AnsweredScene b(bare);
  std::size_t deeper = 0, crossed = 0, plausible = 0;
  a.each([&](std::size_t v, std::size_t i) {
    const GripResult result = a.result(v, i);
    const double half_step = 0.06812 / 18 * a.scene.hand.scale * a.grips[v][i].hand_scale;
    const CapsuleCheck check = check_capsules(a.scene, *a.core, v, a.grips[v][i], result);
    const double depth = std::max(result.phalanx_depth, result.palm_depth);
    EXPECT_LT(check.deepest, depth + half_step) << i;
    EXPECT_LT(std::max(0.0, check.overlap), result.self_depth + 2 * half_step) << i;
    crossed += result.self_depth > 0 ? 1 : 0;
    const GripResult points = b.result(v, i);
    deeper += depth > std::max(points.phalanx_depth, points.palm_depth) + half_step ? 1 : 0;
    plausible += (a.status(v, i) & STATUS_PLAUSIBLE) != 0 ? 1 : 0;
  });
  EXPECT_GT(deeper, 0u);
  EXPECT_GT(crossed, 10u);
  EXPECT_GT(plausible, 10u);
}

void first_drop(const AnsweredScene& a) {
  Scene all = a.scene;
  all.until_poured.reset();
  const AnsweredScene b(all);
  const std::size_t tilts = a.scene.tilts.size();
  std::size_t lower = 0, compared = 0;
  a.each([&](std::size_t v, std::size_t i) {
    for (std::size_t fill = 0; fill < scene_fills(a.scene); ++fill) {
      const double pours = a.core->pouring_tilt(v, vessel_fills(a.scene, a.scene.vessels[v])[fill]);
      // the first tilt at which it has poured counts
      const auto beyond = std::upper_bound(a.scene.tilts.begin(), a.scene.tilts.end(), pours);
      const std::size_t first_poured = static_cast<std::size_t>(beyond - a.scene.tilts.begin());
      ASSERT_LT(first_poured, tilts);
      for (std::size_t t = 0; t < tilts; ++t) {
        const double torque = a.real(FIELD_TORQUE, v, i, fill * tilts + t), of_all = b.real(FIELD_TORQUE, v, i, fill * tilts + t);
        if (t <= first_poured) {
          EXPECT_EQ(torque, of_all) << i << " " << t;
        } else {
          EXPECT_TRUE(std::isnan(torque)) << i << " " << t;
        }
      }
    }
    const double worst = a.real(FIELD_WORST_EFFORT, v, i), of_all = b.real(FIELD_WORST_EFFORT, v, i);
    EXPECT_EQ(std::isnan(worst), std::isnan(of_all));
    if (std::isnan(worst)) return;
    // either search may end half a tolerance early
    EXPECT_LE(worst, of_all * (1 + 1e-3)) << i;
    lower += worst < 0.9 * of_all ? 1 : 0;
    ++compared;
  });
  EXPECT_GT(compared, 0u);
  EXPECT_GT(lower, 0u) << "no grip is worst upside down";
}

void widest_deviations(const AnsweredScene& a) {
  const sweeps::Plan plan(a.scene, true);
  std::vector<std::vector<sweeps::BestGrip>> lists(1);
  for (std::size_t i = 0; i < a.grips[0].size(); ++i) {
    sweeps::BestGrip best;
    best.candidate.index = i;
    best.grip = a.grips[0][i];
    if (a.feasible(0, i)) lists[0].push_back(best);
  }
  const sweeps::OpenBackend open = [](const Scene& scene, const FieldSet& fields) {
    return open_backend(scene, fields, "core", Precision::full, 1);
  };
  ASSERT_TRUE(sweeps::rank_robustly(open, a.scene, plan, sweeps::MOST_ROBUST, nullptr, lists));
  std::size_t above = 0;
  for (const sweeps::BestGrip& best : lists[0]) {
    for (const double score : {best.robust.low, best.robust.mean}) EXPECT_TRUE(score >= 0 && score <= 1) << best.candidate.index;
    above += best.robust.mean > 0 ? 1 : 0;
  }
  EXPECT_GT(above, 0u);
}

// Upright, a line across the axis meets the weight's; any other passes it.
void no_torsion(const AnsweredScene& a) {
  const double weight = a.core->constants(0).mass * a.scene.gravity;
  std::size_t finite = 0;
  const AnsweredScene pinch = pinched(a);
  a.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    const double hold = pinch.real(FIELD_HOLD_FORCE, v, i, s);
    const bool meets = a.antipodal(v, i) && a.grips[v][i].offset == 0 && a.scene.tilts[s] == 0;
    const double needed = meets ? weight / (2 * a.scene.force.friction) : HUGE_VAL;
    EXPECT_TRUE(hold == needed || std::abs(hold - needed) < 1e-14 * weight) << i << " " << hold;
    finite += meets ? 1 : 0;
    if (a.scene.tilts[s] != 0) return;
    // N, of each tip: strengths of 1
    const core_f64::Effort tips = upright_effort(a, v, i, even_strength(a, 1), true);
    EXPECT_LE(tips.low, needed * (1 + EFFORT_ROUNDED)) << i;
    EXPECT_GE(tips.effort, needed * (1 - EFFORT_ROUNDED)) << i;
  });
  EXPECT_GT(finite, 10u);
}

void no_range(const AnsweredScene& a) {
  a.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    EXPECT_EQ(a.real(FIELD_FEEDBACK_FORCE, v, i, s), a.scene.force.base);
    EXPECT_EQ(a.real(FIELD_TORQUE, v, i, s), 0);
    EXPECT_EQ(a.real(FIELD_HOLD_FORCE, v, i, s), a.antipodal(v, i) ? 0 : HUGE_VAL);
  });
}

void stiffest_gains(const AnsweredScene& a) {
  Scene stiffer = a.scene;
  stiffer.force.k_open = 1e7;  // beyond what a scene may ask for
  const auto core = make_core_evaluator(stiffer);
  a.each_state([&](std::size_t v, std::size_t i, std::size_t s) {
    GripResult result;
    a.core->grip(v, a.grips[v][i], result);
    for (const double opening : {-MICROMETER, 0.0, MICROMETER}) {
      const auto force = [&](const Evaluator& of) {
        return of.state(v, a.grips[v][i], result, {}, a.scene.tilts[s], opening).feedback_force;
      };
      const double normal = a.real(FIELD_NORMAL_FORCE, v, i, s), max = a.scene.force.max;
      EXPECT_NEAR(force(*a.core), std::clamp(normal + 1e6 * opening, 0.0, max), 1e-12);
      EXPECT_NEAR(force(*core), std::clamp(normal + 1e7 * opening, 0.0, max), 1e-12);
    }
  });
  const auto pushed = core_f64::coupling_force({0, -MICROMETER, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, 1e7, 1000);
  EXPECT_NEAR(pushed.y, 10, 1e-12);
}

// The scenes of the issue, and the checks of each.
const std::map<std::string, void (*)(const AnsweredScene&)> LOOKS{
    {"along_the_axis", along_the_axis},
    {"center_of_mass", center_of_mass},
    {"creases_and_rim", creases_and_rim},
    {"dwarf", dwarf},
    {"edges_of_a_micrometer", edges_of_a_micrometer},
    {"empty_glass", empty_glass},
    {"far_above_the_table", far_above_the_table},
    {"far_off", far_off},
    {"fills_at_their_ends", fills_at_their_ends},
    {"first_drop", first_drop},
    {"full_to_the_brim", full_to_the_brim},
    {"giant", giant},
    {"large_hand", large_hand},
    {"light_and_heavy", light_and_heavy},
    {"most_bodies", most_bodies},
    {"most_friction", most_friction},
    {"no_friction", no_friction},
    {"no_range", no_range},
    {"no_torsion", no_torsion},
    {"one_millimeter", one_millimeter},
    {"pole_of_ten_meters", pole_of_ten_meters},
    {"right_angles", right_angles},
    {"small_hand", small_hand},
    {"stiffest_gains", stiffest_gains},
    {"tangent_to_the_wall", tangent_to_the_wall},
    {"tank_of_ten_meters", tank_of_ten_meters},
    {"thin_wall", thin_wall},
    {"thousand_elements", thousand_elements},
    {"weak_and_strong", weak_and_strong},
    {"widest_deviations", widest_deviations},
};

TEST(Extreme, EveryCaseHasAScene) {
  std::vector<std::string> found, wanted;
  for (const auto& entry : std::filesystem::directory_iterator(extreme_folder())) found.push_back(entry.path().filename());
  for (const auto& [name, look] : LOOKS) wanted.push_back(name + ".toml");
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(extreme_scene_files().size(), wanted.size());
}

TEST(Extreme, EverySceneSaysWhatIsHardAndWhatComesOut) {
  for (const auto& [name, look] : LOOKS) {
    const ExtremeCase extreme = extreme_case(extreme_scene(name));
    EXPECT_EQ(extreme.name, name);
    EXPECT_GT(extreme.stresses.size(), 10u) << name;
    EXPECT_GT(extreme.expected.size(), 10u) << name;
  }
  Scene silent;
  silent.file = "silent.toml";
  EXPECT_THROW(extreme_case(silent), Error);
}

TEST(Extreme, WhatASceneSaysComesOut) {
  for (const auto& [name, look] : LOOKS) {
    const AnsweredScene answered(extreme_scene(name));
    for (std::size_t v = 0; v < answered.planes.size(); ++v) {
      const GatheredPlanes& planes = answered.planes[v];
      EXPECT_EQ(describe(misplaced_values(answered.scene, v, planes.fields, planes.count, planes.count, planes.reals.data(),
                                          planes.uints.data())),
                "")
          << name;
    }
    SCOPED_TRACE(name);
    look(answered);
  }
}

}  // namespace
}  // namespace wholehand
