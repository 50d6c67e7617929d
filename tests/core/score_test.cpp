// SPDX-License-Identifier: MIT
// Scores: every term at its ends, the weights, and whole scores against states evaluated one by one; planes against single grips.
#include "core/score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "tests/support/scenes.h"
#include "tests/support/special_values.h"

namespace wholehand {
namespace {

constexpr double ROUNDING = 1e-14;  // sums of a few numbers up to 1

// ---- terms ----

TEST(Score, FingersTermIsTheShareOfFive) {
  EXPECT_EQ(core_f64::fingers_term(0), 0);
  EXPECT_DOUBLE_EQ(core_f64::fingers_term(2), 0.4);
  EXPECT_EQ(core_f64::fingers_term(5), 1);
}

TEST(Score, ContactsTermIsTheShareOfTwentyFour) {
  EXPECT_EQ(core_f64::contacts_term(0), 0);
  EXPECT_DOUBLE_EQ(core_f64::contacts_term(6), 0.25);
  EXPECT_EQ(core_f64::contacts_term(24), 1);
}

TEST(Score, DepthTermFallsToZeroAtTenMillimetres) {
  EXPECT_EQ(core_f64::depth_term(0, 0), 1);
  EXPECT_DOUBLE_EQ(core_f64::depth_term(2e-3, 1e-3), 0.8);
  EXPECT_DOUBLE_EQ(core_f64::depth_term(1e-3, 4e-3), 0.6);  // the deeper of the two
  EXPECT_EQ(core_f64::depth_term(10e-3, 0), 0);
  EXPECT_EQ(core_f64::depth_term(0, 50e-3), 0);
}

TEST(Score, PostureTermPrefersTheMiddle) {
  EXPECT_EQ(core_f64::posture_term(0.5), 1);
  EXPECT_EQ(core_f64::posture_term(0), 0);
  EXPECT_EQ(core_f64::posture_term(1), 0);
  EXPECT_DOUBLE_EQ(core_f64::posture_term(0.75), 0.5);
  EXPECT_DOUBLE_EQ(core_f64::posture_term(0.1), 0.2);
}

TEST(Score, ForceTermFallsToZeroAtTheLargest) {
  EXPECT_EQ(core_f64::force_term(0, 8), 1);
  EXPECT_DOUBLE_EQ(core_f64::force_term(2, 8), 0.75);
  EXPECT_EQ(core_f64::force_term(8, 8), 0);
  EXPECT_EQ(core_f64::force_term(0, 0), 0);
}

TEST(Score, HoldTermFallsOnceTheGripStrengthIsNotEnough) {
  EXPECT_EQ(core_f64::hold_term(0, 40), 1);
  EXPECT_EQ(core_f64::hold_term(40, 40), 1);
  EXPECT_DOUBLE_EQ(core_f64::hold_term(80, 40), 0.5);
  EXPECT_EQ(core_f64::hold_term(INFINITE, 40), 0);
  EXPECT_EQ(core_f64::hold_term(5, 0), 0);
  EXPECT_FALSE(std::isnan(core_f64::hold_term(0, 0)));
}

// ---- weights ----

double weighted(const Scene& scene, const ScoreTerms& t) {
  const ScoreWeights& w = scene.score;
  const double still = w.fingers * t.fingers + w.contacts * t.contacts + w.depth * t.depth + w.posture * t.posture;
  if (scene.tilts.empty()) return still / (w.fingers + w.contacts + w.depth + w.posture);
  return still + w.force * t.force + w.hold * t.hold;
}

TEST(Score, WeightsAreTheScenes) {
  const std::array<double, 6> standard{0.30, 0.10, 0.20, 0.10, 0.15, 0.15};
  EXPECT_EQ(effective_weights(three_beakers()), standard);
  Scene scene = three_beakers();
  scene.score = {1, 2, 3, 4, 5, 6};  // they need not sum to 1
  const std::array<double, 6> own{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(effective_weights(scene), own);
}

TEST(Score, WithoutTiltsTheRemainingWeightsSumToOne) {
  const auto weights = effective_weights(scene_of({beaker1()}));
  const std::array<double, 6> expected{0.30 / 0.7, 0.10 / 0.7, 0.20 / 0.7, 0.10 / 0.7, 0, 0};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(weights[k], expected[k], ROUNDING) << k;
  EXPECT_EQ(weights[4], 0);
  EXPECT_EQ(weights[5], 0);
}

TEST(Score, WeightsThatAreAllOnForceAndHoldLeaveNothingWithoutTilts) {
  Scene scene = scene_of({beaker1()});
  scene.score = {0, 0, 0, 0, 0.5, 0.5};
  for (const double weight : effective_weights(scene)) EXPECT_EQ(weight, 0);  // and no division by zero
}

// ---- whole scores ----

// Scene with every kind of grip: a lopsided glass among the beakers, low friction so that some pinches do not hold, a small largest
// force and grip strength so that tilts become unsafe.
Scene hard_scene() {
  Scene scene = three_beakers();
  scene.vessels.push_back(lopsided());
  scene.liquid->fills = {0, 0.4, 1};
  scene.tilts = linspace(0, radians(150), 7);
  scene.force.max = 3.2;
  scene.force.grip_strength = 12;
  scene.force.friction = 0.35;
  scene.hand.depth_limit = 2e-3;
  return scene;
}

std::vector<GripInput> grips_with_hopeless_ones(const VesselData& vessel, std::uint64_t seed, int count = 17) {
  std::vector<GripInput> grips = sample_grips(vessel, count, seed);
  grips[3].obliquity = PI / 2;           // degenerate
  grips[7].height = 10 * vessel.height;  // misses
  grips[11].hand_scale = 0.2;            // too wide
  grips[11].offset = 0;
  grips[13] = {};  // beside the widest part: the tips of 7 and 8 mm are nearer than they are wide
  grips[13].height = 42.5e-3;
  grips[13].offset = largest_radius(vessel) + 6.9e-3;
  return grips;
}

void expect_score(const Scene& scene, const Evaluator& evaluator, std::size_t v, const GripInput& grip, const GripResult& result,
                  const std::string& where) {
  const GripScore score = evaluator.score(v, grip, result);
  if (result.reason != Reason::none) {
    EXPECT_EQ(score.score, 0) << where;
    return;
  }
  EXPECT_NEAR(score.terms.fingers, std::popcount(result.used_mask) / 5.0, ROUNDING) << where;
  EXPECT_NEAR(score.terms.contacts, std::popcount(result.touch_mask) / 24.0, ROUNDING) << where;
  EXPECT_NEAR(score.terms.depth, 1 - std::min(1.0, std::max(result.phalanx_depth, result.palm_depth) / 0.01), ROUNDING) << where;
  EXPECT_NEAR(score.terms.posture, 1 - std::abs(2 * result.closure - 1), ROUNDING) << where;

  const std::vector<double> fills = scene.liquid ? scene.liquid->fills : std::vector<double>{0};
  double largest_force = 0, largest_hold = 0;
  ASSERT_EQ(score.fills.size(), scene.tilts.empty() ? 0 : fills.size()) << where;
  for (std::size_t f = 0; f < score.fills.size(); ++f) {
    double peak = -1, peak_tilt = 0, hold = 0, safe = std::numeric_limits<double>::quiet_NaN();
    bool still_safe = true;
    for (const double tilt : scene.tilts) {
      const LiquidResult liquid = scene.liquid ? evaluator.liquid(v, fills[f], tilt) : LiquidResult{};
      const StateResult state = evaluator.state(v, grip, result, liquid, tilt);
      if (state.feedback_force > peak) {
        peak = state.feedback_force;
        peak_tilt = tilt;
      }
      hold = std::max(hold, state.hold_force);
      still_safe = still_safe && state.normal_force < scene.force.max && state.hold_force <= scene.force.grip_strength;
      if (still_safe) safe = tilt;
    }
    EXPECT_NEAR(score.fills[f].peak_force, peak, 1e-12) << where;  // N: the liquid may have been solved with another start
    EXPECT_EQ(score.fills[f].peak_tilt, peak_tilt) << where;
    if (std::isinf(hold)) {
      EXPECT_EQ(score.fills[f].largest_hold, INFINITE) << where;
    } else {
      EXPECT_NEAR(score.fills[f].largest_hold, hold, 1e-10) << where;
    }
    if (std::isnan(safe)) {
      EXPECT_TRUE(std::isnan(score.fills[f].safe_tilt)) << where;
    } else {
      EXPECT_EQ(score.fills[f].safe_tilt, safe) << where;
    }
    largest_force = std::max(largest_force, peak);
    largest_hold = std::max(largest_hold, hold);
  }
  if (scene.tilts.empty()) {
    EXPECT_EQ(score.terms.force, 0) << where;
    EXPECT_EQ(score.terms.hold, 0) << where;
  } else {
    EXPECT_NEAR(score.terms.force, 1 - largest_force / scene.force.max, 1e-12) << where;
    EXPECT_NEAR(score.terms.hold, largest_hold > 0 ? std::min(1.0, scene.force.grip_strength / largest_hold) : 1, 1e-12) << where;
  }
  if (result.plausible) {
    EXPECT_NEAR(score.score, weighted(scene, score.terms), ROUNDING) << where;
  } else {
    EXPECT_EQ(score.score, 0) << where;
  }
}

TEST(Score, ScoresAreTheWeightedTermsOverAllStates) {
  int feasible = 0, infeasible = 0, implausible = 0, pinched = 0, unsafe = 0, ends_early = 0;
  for (const Scene& scene : {hard_scene(), three_beakers()}) {
    const auto evaluator = make_core_evaluator(scene);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      int i = 0;
      for (const GripInput& grip : grips_with_hopeless_ones(scene.vessels[v], 21 + v, 40)) {
        GripResult result;
        evaluator->grip(v, grip, result);
        expect_score(scene, *evaluator, v, grip, result, scene.vessels[v].name + " grip " + std::to_string(i++));
        (result.reason == Reason::none ? feasible : infeasible) += 1;
        if (result.reason != Reason::none) continue;
        implausible += !result.plausible;
        pinched += !result.antipodal;
        for (const FillTerms& fill : evaluator->score(v, grip, result).fills) {
          unsafe += std::isnan(fill.safe_tilt);
          ends_early += fill.safe_tilt < scene.tilts.back();
        }
      }
    }
  }
  // the samples hold every kind
  EXPECT_GT(feasible, 100);
  EXPECT_GT(infeasible, 10);
  EXPECT_GT(implausible, 10);
  EXPECT_GT(pinched, 10);
  EXPECT_GT(unsafe, 10);
  EXPECT_GT(ends_early, 10);
}

TEST(Score, WithoutLiquidThereIsOneFillTheEmptyGlass) {
  Scene scene = three_beakers();
  scene.liquid.reset();
  const auto evaluator = make_core_evaluator(scene);
  for (const GripInput& grip : sample_grips(scene.vessels[0], 10, 31)) {
    GripResult result;
    evaluator->grip(0, grip, result);
    expect_score(scene, *evaluator, 0, grip, result, "no liquid");
    if (result.reason == Reason::none) {
      EXPECT_EQ(evaluator->score(0, grip, result).fills.size(), 1u);
    }
  }
}

TEST(Score, WithoutTiltsThereAreNoFillTerms) {
  Scene scene = three_beakers();
  scene.tilts.clear();
  const auto evaluator = make_core_evaluator(scene);
  double best = 0;
  for (const GripInput& grip : sample_grips(scene.vessels[0], 20, 32)) {
    GripResult result;
    evaluator->grip(0, grip, result);
    expect_score(scene, *evaluator, 0, grip, result, "no tilts");
    best = std::max(best, evaluator->score(0, grip, result).score);
  }
  EXPECT_GT(best, 0.3);
  EXPECT_LE(best, 1);
}

TEST(Score, LoneTiltZeroIsAllThatCounts) {
  Scene scene = three_beakers();
  scene.tilts = {0};
  const auto evaluator = make_core_evaluator(scene);
  GripInput grip;
  grip.height = 50e-3;
  GripResult result;
  evaluator->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  for (const FillTerms& fill : evaluator->score(0, grip, result).fills) {
    EXPECT_EQ(fill.peak_force, 0.8);  // no tilt, no torque: the base
    EXPECT_EQ(fill.peak_tilt, 0);
    EXPECT_EQ(fill.safe_tilt, 0);
  }
  EXPECT_NEAR(evaluator->score(0, grip, result).terms.force, 0.9, ROUNDING);
}

TEST(Score, SafeUpToTheGripStrengthAndShortOfTheLargestForce) {
  Scene scene = three_beakers();
  scene.tilts = linspace(0, radians(60), 4);
  scene.liquid->fills = {0};
  GripInput grip;
  grip.height = 60e-3;
  GripResult result;
  const auto evaluator = make_core_evaluator(scene);
  evaluator->grip(0, grip, result);
  ASSERT_TRUE(result.antipodal);
  const StateResult third = evaluator->state(0, grip, result, evaluator->liquid(0, 0, scene.tilts[2]), scene.tilts[2]);
  const StateResult last = evaluator->state(0, grip, result, evaluator->liquid(0, 0, scene.tilts[3]), scene.tilts[3]);
  ASSERT_LT(third.normal_force, last.normal_force);
  const auto safe_tilt = [&](double largest, double strength) {
    scene.force.max = largest;
    scene.force.grip_strength = strength;
    return make_core_evaluator(scene)->score(0, grip, result).fills[0].safe_tilt;
  };
  EXPECT_EQ(safe_tilt(100, 1000), scene.tilts[3]);
  EXPECT_EQ(safe_tilt(last.normal_force, 1000), scene.tilts[2]);  // at F_max the rendered force no longer grows: not safe
  EXPECT_EQ(safe_tilt(std::nextafter(last.normal_force, 100), 1000), scene.tilts[3]);
  double largest_hold = 0;
  for (const double tilt : scene.tilts) {
    largest_hold = std::max(largest_hold, evaluator->state(0, grip, result, evaluator->liquid(0, 0, tilt), tilt).hold_force);
  }
  EXPECT_EQ(safe_tilt(100, largest_hold), scene.tilts[3]);  // as strong as it takes is enough
  EXPECT_NE(safe_tilt(100, std::nextafter(largest_hold, 0)), scene.tilts[3]);
}

// ---- planes are the grips one by one ----

std::vector<int> every_field() {
  std::vector<int> fields(FIELDS);
  for (int field = 0; field < FIELDS; ++field) fields[static_cast<std::size_t>(field)] = field;
  return fields;
}

struct Planes {
  FieldSet fields;
  std::size_t stride = 0;
  std::vector<double> reals;
  std::vector<std::uint32_t> uints;
  double real(int field, int plane, std::size_t i) const { return reals[std::size_t(fields.plane[field] + plane) * stride + i]; }
  std::uint32_t uint(int field, std::size_t i) const { return uints[std::size_t(fields.plane[field]) * stride + i]; }
};

constexpr double UNTOUCHED = -12345;

Planes evaluate_planes(const Scene& scene, const Evaluator& evaluator, std::size_t v, const std::vector<GripInput>& grips,
                       const std::vector<int>& kept, std::size_t stride) {
  Planes planes;
  planes.fields = make_field_set(kept, scene);
  planes.stride = stride;
  planes.reals.assign(std::size_t(planes.fields.real_planes) * stride, UNTOUCHED);
  planes.uints.assign(std::size_t(planes.fields.uint_planes) * stride, 0xDEADBEEF);
  evaluator.planes(v, grips.data(), grips.size(), planes.fields, stride, planes.reals.data(), planes.uints.data());
  return planes;
}

void expect_same(double a, double b, const std::string& where) {
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << where << ": " << a << " and " << b;
}

void expect_grip_in_planes(const Scene& scene, const Evaluator& evaluator, std::size_t v, const GripInput& grip, const Planes& p,
                           std::size_t i, const std::string& where) {
  GripResult r;
  evaluator.grip(v, grip, r);
  EXPECT_EQ(p.uint(FIELD_STATUS, i), r.status) << where;
  EXPECT_EQ(r.status & STATUS_REASON_MASK, static_cast<std::uint32_t>(r.reason)) << where;
  EXPECT_EQ((r.status & STATUS_PLAUSIBLE) != 0, r.plausible) << where;
  EXPECT_EQ((r.status & STATUS_ANTIPODAL) != 0, r.antipodal) << where;
  EXPECT_EQ((r.status & STATUS_GRAZING) != 0, r.grazing) << where;
  EXPECT_EQ(p.uint(FIELD_TOUCH_MASK, i), r.touch_mask) << where;
  EXPECT_EQ(p.uint(FIELD_TIP_MASK, i), r.tip_mask) << where;
  EXPECT_EQ(p.uint(FIELD_FINGER_MASK, i), r.finger_mask) << where;
  EXPECT_EQ(p.uint(FIELD_INNER_MASK, i), r.inner_mask) << where;
  EXPECT_EQ(p.uint(FIELD_USED_MASK, i), r.used_mask) << where;

  const std::size_t fills = scene_fills(scene), tilts = scene.tilts.size();
  if (r.reason != Reason::none) {
    // the score and its terms are 0; gap and midpoint are there from too_wide on; nothing else is
    for (int field = 0; field < REAL_FIELDS; ++field) {
      const bool scored = field == FIELD_SCORE || field == FIELD_TERMS;
      const bool reached = r.reason >= Reason::too_wide &&
                           (field == FIELD_T_INDEX || field == FIELD_T_THUMB || field == FIELD_GAP || field == FIELD_MIDPOINT);
      for (int plane = 0; plane < field_planes(field, fills, tilts); ++plane) {
        if (scored) {
          EXPECT_EQ(p.real(field, plane, i), 0) << where;
        } else {
          EXPECT_EQ(std::isnan(p.real(field, plane, i)), !reached) << where << " field " << field;
        }
      }
    }
    if (r.reason < Reason::too_wide) return;
  }

  // t along the line from o: both ends of the gap, and the midpoint between them
  const double t_index = p.real(FIELD_T_INDEX, 0, i), t_thumb = p.real(FIELD_T_THUMB, 0, i);
  EXPECT_NEAR(t_index - t_thumb, r.gap, 1e-15) << where;  // m: one rounding
  const Long3 d = rotation_y(grip.azimuth) * (rotation_z(grip.obliquity) * Long3{1, 0, 0}), side = cross(d, {0, 1, 0});
  const Long3 o = Long3{0, grip.height, 0} + (grip.offset / length(side)) * side;
  const Long3 middle = o + ((static_cast<long double>(t_index) + t_thumb) / 2) * d;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(r.midpoint[k], double(middle[k]), 1e-15) << where;

  expect_same(p.real(FIELD_GAP, 0, i), r.gap, where + " gap");
  for (int k = 0; k < 3; ++k) expect_same(p.real(FIELD_MIDPOINT, k, i), r.midpoint[k], where + " midpoint");
  if (r.reason != Reason::none) return;
  expect_same(p.real(FIELD_CLOSURE, 0, i), r.closure, where + " closure");
  expect_same(p.real(FIELD_PHALANX_DEPTH, 0, i), r.phalanx_depth, where + " phalanx depth");
  expect_same(p.real(FIELD_PALM_DEPTH, 0, i), r.palm_depth, where + " palm depth");
  expect_same(p.real(FIELD_BONE_STRETCH, 0, i), r.bone_stretch, where + " bone stretch");
  for (int k = 0; k < 2; ++k) expect_same(p.real(FIELD_CONTACT_ANGLES, k, i), r.contact_angles[k], where + " contact angle");
  for (int j = 0; j < JOINT_COUNT; ++j) {
    for (int k = 0; k < 3; ++k) {
      expect_same(p.real(FIELD_JOINTS, 3 * j + k, i), r.joints[j][k], where + " joint");
      expect_same(p.real(FIELD_POSED, 3 * j + k, i), r.posed[j][k], where + " posed");
      expect_same(p.real(FIELD_PROXIES, 3 * j + k, i), r.proxies[j][k], where + " proxy");
    }
    expect_same(p.real(FIELD_SEPARATION, j, i), r.separation[j], where + " separation");
  }

  const GripScore score = evaluator.score(v, grip, r);
  expect_same(p.real(FIELD_SCORE, 0, i), score.score, where + " score");
  const std::array<double, 6> terms{score.terms.fingers, score.terms.contacts, score.terms.depth,
                                    score.terms.posture, score.terms.force,    score.terms.hold};
  for (int k = 0; k < field_planes(FIELD_TERMS, fills, tilts); ++k)
    expect_same(p.real(FIELD_TERMS, k, i), terms[k], where + " term");
  if (tilts == 0) return;
  for (std::size_t f = 0; f < fills; ++f) {
    const int plane = static_cast<int>(f);
    expect_same(p.real(FIELD_PEAK_FORCE, plane, i), score.fills[f].peak_force, where + " peak force");
    expect_same(p.real(FIELD_PEAK_TILT, plane, i), score.fills[f].peak_tilt, where + " peak tilt");
    expect_same(p.real(FIELD_LARGEST_HOLD, plane, i), score.fills[f].largest_hold, where + " largest hold");
    expect_same(p.real(FIELD_SAFE_TILT, plane, i), score.fills[f].safe_tilt, where + " safe tilt");
    for (std::size_t t = 0; t < tilts; ++t) {
      const int state_plane = static_cast<int>(f * tilts + t);
      const LiquidResult liquid = scene.liquid ? evaluator.liquid(v, scene.liquid->fills[f], scene.tilts[t]) : LiquidResult{};
      const StateResult s = evaluator.state(v, grip, r, liquid, scene.tilts[t]);
      expect_same(p.real(FIELD_PIVOT_LENGTH, state_plane, i), s.pivot_length, where + " pivot length");
      expect_same(p.real(FIELD_TORQUE, state_plane, i), s.torque, where + " torque");
      expect_same(p.real(FIELD_EXACT_TORQUE, state_plane, i), s.exact_torque, where + " exact torque");
      expect_same(p.real(FIELD_NORMAL_FORCE, state_plane, i), s.normal_force, where + " normal force");
      expect_same(p.real(FIELD_FEEDBACK_FORCE, state_plane, i), s.feedback_force, where + " feedback force");
      expect_same(p.real(FIELD_HOLD_FORCE, state_plane, i), s.hold_force, where + " hold force");
    }
  }
}

TEST(Score, PlanesHoldTheGripsOneByOneInEveryPose) {
  for (const Pose pose : {Pose::articulated, Pose::paper, Pose::rigged}) {
    Scene scene = hard_scene();
    scene.pose = pose;
    const auto evaluator = make_core_evaluator(scene);
    for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
      const std::vector<GripInput> grips = grips_with_hopeless_ones(scene.vessels[v], 40 + v);
      const Planes planes = evaluate_planes(scene, *evaluator, v, grips, every_field(), grips.size());
      int infeasible = 0;
      for (std::size_t i = 0; i < grips.size(); ++i) {
        expect_grip_in_planes(scene, *evaluator, v, grips[i], planes, i, scene.vessels[v].name + " grip " + std::to_string(i));
        infeasible += (planes.uint(FIELD_STATUS, i) & STATUS_REASON_MASK) != REASON_NONE;
      }
      EXPECT_GE(infeasible, 4);
    }
  }
}

TEST(Score, PlanesWithoutTiltsOrLiquid) {
  for (const bool tilts : {false, true}) {
    Scene scene = hard_scene();
    scene.liquid.reset();
    if (!tilts) scene.tilts.clear();
    const auto evaluator = make_core_evaluator(scene);
    const std::vector<GripInput> grips = grips_with_hopeless_ones(scene.vessels[2], 50);
    const Planes planes = evaluate_planes(scene, *evaluator, 2, grips, every_field(), grips.size());
    for (std::size_t i = 0; i < grips.size(); ++i) {
      expect_grip_in_planes(scene, *evaluator, 2, grips[i], planes, i, std::to_string(i));
    }
  }
}

TEST(Score, PlanesOfALeftHand) {
  Scene scene = hard_scene();
  scene.hand.handedness = Handedness::left;
  const auto evaluator = make_core_evaluator(scene);
  const std::vector<GripInput> grips = grips_with_hopeless_ones(scene.vessels[3], 51);
  const Planes planes = evaluate_planes(scene, *evaluator, 3, grips, every_field(), grips.size());
  for (std::size_t i = 0; i < grips.size(); ++i) {
    GripResult r;
    evaluator->grip(3, grips[i], r);
    if (r.reason != Reason::none) continue;
    const GripScore score = evaluator->score(3, grips[i], r);
    expect_same(planes.real(FIELD_SCORE, 0, i), score.score, "score");
    for (int k = 0; k < 3; ++k) expect_same(planes.real(FIELD_MIDPOINT, k, i), r.midpoint[k], "midpoint");
    for (int k = 0; k < 3; ++k) expect_same(planes.real(FIELD_POSED, 3 * INDEX_TIP + k, i), r.posed[INDEX_TIP][k], "posed");
    for (int k = 0; k < 3; ++k) expect_same(planes.real(FIELD_JOINTS, k, i), r.joints[0][k], "joint");
    for (int k = 0; k < 3; ++k) expect_same(planes.real(FIELD_PROXIES, k, i), r.proxies[0][k], "proxy");
  }
}

TEST(Score, StrideBeyondTheCountLeavesTheRestAlone) {
  const Scene scene = hard_scene();
  const auto evaluator = make_core_evaluator(scene);
  const std::vector<GripInput> grips = grips_with_hopeless_ones(scene.vessels[1], 60);
  const Planes tight = evaluate_planes(scene, *evaluator, 1, grips, every_field(), grips.size());
  const Planes wide = evaluate_planes(scene, *evaluator, 1, grips, every_field(), grips.size() + 6);
  for (int plane = 0; plane < tight.fields.real_planes; ++plane) {
    for (std::size_t i = 0; i < wide.stride; ++i) {
      const double value = wide.reals[std::size_t(plane) * wide.stride + i];
      if (i < grips.size()) {
        expect_same(value, tight.reals[std::size_t(plane) * tight.stride + i], "plane " + std::to_string(plane));
      } else {
        EXPECT_EQ(value, UNTOUCHED) << plane;
      }
    }
  }
  for (int plane = 0; plane < tight.fields.uint_planes; ++plane) {
    for (std::size_t i = 0; i < wide.stride; ++i) {
      const std::uint32_t value = wide.uints[std::size_t(plane) * wide.stride + i];
      EXPECT_EQ(value, i < grips.size() ? tight.uints[std::size_t(plane) * tight.stride + i] : 0xDEADBEEF) << plane;
    }
  }
}

TEST(Score, LeavingFieldsOutChangesNothingInTheOthers) {
  const Scene scene = hard_scene();
  const auto evaluator = make_core_evaluator(scene);
  const std::vector<GripInput> grips = grips_with_hopeless_ones(scene.vessels[0], 70);
  const Planes all = evaluate_planes(scene, *evaluator, 0, grips, every_field(), grips.size());
  for (int field = 0; field < FIELDS; ++field) {
    const Planes alone = evaluate_planes(scene, *evaluator, 0, grips, {field}, grips.size());
    const int count = field_planes(field, scene_fills(scene), scene.tilts.size());
    ASSERT_TRUE(alone.fields.has(field)) << field;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      for (int plane = 0; plane < count; ++plane) {
        if (field < REAL_FIELDS) {
          expect_same(alone.real(field, plane, i), all.real(field, plane, i), "field " + std::to_string(field));
        } else {
          EXPECT_EQ(alone.uint(field, i), all.uint(field, i)) << field;
        }
      }
    }
  }
}

TEST(Score, NoGripsAreNoWork) {
  const Scene scene = hard_scene();
  const Planes planes = evaluate_planes(scene, *make_core_evaluator(scene), 0, {}, every_field(), 3);
  for (const double value : planes.reals) EXPECT_EQ(value, UNTOUCHED);
}

}  // namespace
}  // namespace wholehand
