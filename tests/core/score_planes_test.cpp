// SPDX-License-Identifier: MIT
// Planes of scores against single grips.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "tests/support/hard_scene.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

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

void expect_same_plane_value(double a, double b, const std::string& where) {
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << where << ": " << a << " and " << b;
}

void expect_bits(const GripResult& r, const Planes& p, std::size_t i, const std::string& where) {
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
}

// The score and its terms of an infeasible grip are 0; gap and midpoint are there from too_wide on; nothing else is.
void expect_infeasible(const Scene& scene, const GripResult& r, const Planes& p, std::size_t i, const std::string& where) {
  for (int field = 0; field < REAL_FIELDS; ++field) {
    const bool scored = field == FIELD_SCORE || field == FIELD_TERMS;
    const bool reached = r.reason >= Reason::too_wide &&
                         (field == FIELD_T_INDEX || field == FIELD_T_THUMB || field == FIELD_GAP || field == FIELD_MIDPOINT);
    for (int plane = 0; plane < field_planes(field, scene); ++plane) {
      if (scored) {
        EXPECT_EQ(p.real(field, plane, i), 0) << where;
      } else {
        EXPECT_EQ(std::isnan(p.real(field, plane, i)), !reached) << where << " field " << field;
      }
    }
  }
}

void expect_gap(const GripInput& grip, const GripResult& r, const Planes& p, std::size_t i, const std::string& where) {
  // t along the line from o: both ends of the gap, and the midpoint between them
  const double t_index = p.real(FIELD_T_INDEX, 0, i), t_thumb = p.real(FIELD_T_THUMB, 0, i);
  EXPECT_NEAR(t_index - t_thumb, r.gap, 1e-15) << where;  // m: one rounding
  const Long3 d = rotation_y(grip.azimuth) * (rotation_z(grip.obliquity) * Long3{1, 0, 0}), side = cross(d, {0, 1, 0});
  const Long3 o = Long3{0, grip.height, 0} + (grip.offset / length(side)) * side;
  const Long3 middle = o + ((static_cast<long double>(t_index) + t_thumb) / 2) * d;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(r.midpoint[k], double(middle[k]), 1e-15) << where;

  expect_same_plane_value(p.real(FIELD_GAP, 0, i), r.gap, where + " gap");
  for (int k = 0; k < 3; ++k) expect_same_plane_value(p.real(FIELD_MIDPOINT, k, i), r.midpoint[k], where + " midpoint");
}

void expect_hand(const Scene& scene, const GripResult& r, const Planes& p, std::size_t i, const std::string& where) {
  expect_same_plane_value(p.real(FIELD_CLOSURE, 0, i), r.closure, where + " closure");
  expect_same_plane_value(p.real(FIELD_PHALANX_DEPTH, 0, i), r.phalanx_depth, where + " phalanx depth");
  expect_same_plane_value(p.real(FIELD_PALM_DEPTH, 0, i), r.palm_depth, where + " palm depth");
  expect_same_plane_value(p.real(FIELD_BONE_STRETCH, 0, i), r.bone_stretch, where + " bone stretch");
  EXPECT_EQ((r.status & STATUS_THROUGH_TABLE) != 0, r.through_table) << where;
  if (scene.table) expect_same_plane_value(p.real(FIELD_TABLE_DEPTH, 0, i), r.table_depth, where + " table depth");
  EXPECT_EQ((r.status & STATUS_BEYOND_WRIST) != 0, r.beyond_wrist) << where;
  if (scene.arm) expect_same_plane_value(p.real(FIELD_WRIST_SHARE, 0, i), r.wrist_share, where + " wrist share");
  for (int k = 0; k < 2; ++k)
    expect_same_plane_value(p.real(FIELD_CONTACT_ANGLES, k, i), r.contact_angles[k], where + " contact angle");
  for (int j = 0; j < JOINT_COUNT; ++j) {
    for (int k = 0; k < 3; ++k) {
      expect_same_plane_value(p.real(FIELD_JOINTS, 3 * j + k, i), r.joints[j][k], where + " joint");
      expect_same_plane_value(p.real(FIELD_POSED, 3 * j + k, i), r.posed[j][k], where + " posed");
      expect_same_plane_value(p.real(FIELD_PROXIES, 3 * j + k, i), r.proxies[j][k], where + " proxy");
    }
    expect_same_plane_value(p.real(FIELD_SEPARATION, j, i), r.separation[j], where + " separation");
  }
}

void expect_state(const StateResult& s, const Planes& p, int state_plane, std::size_t i, const std::string& where) {
  expect_same_plane_value(p.real(FIELD_PIVOT_LENGTH, state_plane, i), s.pivot_length, where + " pivot length");
  expect_same_plane_value(p.real(FIELD_TORQUE, state_plane, i), s.torque, where + " torque");
  expect_same_plane_value(p.real(FIELD_EXACT_TORQUE, state_plane, i), s.exact_torque, where + " exact torque");
  expect_same_plane_value(p.real(FIELD_NORMAL_FORCE, state_plane, i), s.normal_force, where + " normal force");
  expect_same_plane_value(p.real(FIELD_FEEDBACK_FORCE, state_plane, i), s.feedback_force, where + " feedback force");
  expect_same_plane_value(p.real(FIELD_HOLD_FORCE, state_plane, i), s.hold_force, where + " hold force");
}

void expect_grip_in_planes(const Scene& scene, const Evaluator& evaluator, std::size_t v, const GripInput& grip, const Planes& p,
                           std::size_t i, const std::string& where) {
  GripResult r;
  evaluator.grip(v, grip, r);
  expect_bits(r, p, i, where);
  if (r.reason != Reason::none) expect_infeasible(scene, r, p, i, where);
  if (r.reason != Reason::none && r.reason < Reason::too_wide) return;
  expect_gap(grip, r, p, i, where);
  if (r.reason != Reason::none) return;
  expect_hand(scene, r, p, i, where);

  const std::size_t fills = scene_fills(scene), tilts = scene.tilts.size();
  const GripScore score = evaluator.score(v, grip, r);
  expect_same_plane_value(p.real(FIELD_SCORE, 0, i), score.score, where + " score");
  const std::array<double, 6> terms{score.terms.fingers, score.terms.contacts, score.terms.depth,
                                    score.terms.posture, score.terms.force,    score.terms.hold};
  for (int k = 0; k < field_planes(FIELD_TERMS, fills, tilts); ++k)
    expect_same_plane_value(p.real(FIELD_TERMS, k, i), terms[k], where + " term");
  if (tilts == 0) return;
  for (std::size_t f = 0; f < fills; ++f) {
    const int plane = static_cast<int>(f);
    expect_same_plane_value(p.real(FIELD_PEAK_FORCE, plane, i), score.fills[f].peak_force, where + " peak force");
    expect_same_plane_value(p.real(FIELD_PEAK_TILT, plane, i), score.fills[f].peak_tilt, where + " peak tilt");
    expect_same_plane_value(p.real(FIELD_LARGEST_HOLD, plane, i), score.fills[f].largest_hold, where + " largest hold");
    expect_same_plane_value(p.real(FIELD_SAFE_TILT, plane, i), score.fills[f].safe_tilt, where + " safe tilt");
    for (std::size_t t = 0; t < tilts; ++t) {
      const LiquidResult liquid = scene.liquid ? evaluator.liquid(v, scene.liquid->fills[f], scene.tilts[t]) : LiquidResult{};
      expect_state(evaluator.state(v, grip, r, liquid, scene.tilts[t]), p, static_cast<int>(f * tilts + t), i, where);
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
    expect_same_plane_value(planes.real(FIELD_SCORE, 0, i), score.score, "score");
    for (int k = 0; k < 3; ++k) expect_same_plane_value(planes.real(FIELD_MIDPOINT, k, i), r.midpoint[k], "midpoint");
    for (int k = 0; k < 3; ++k)
      expect_same_plane_value(planes.real(FIELD_POSED, 3 * INDEX_TIP + k, i), r.posed[INDEX_TIP][k], "posed");
    for (int k = 0; k < 3; ++k) expect_same_plane_value(planes.real(FIELD_JOINTS, k, i), r.joints[0][k], "joint");
    for (int k = 0; k < 3; ++k) expect_same_plane_value(planes.real(FIELD_PROXIES, k, i), r.proxies[0][k], "proxy");
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
        expect_same_plane_value(value, tight.reals[std::size_t(plane) * tight.stride + i], "plane " + std::to_string(plane));
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
  Scene scene = hard_scene();
  scene.table.emplace();
  scene.arm.emplace();
  scene.hand.between = 2;
  scene.strength.emplace();
  const auto evaluator = make_core_evaluator(scene);
  const std::vector<GripInput> grips = grips_with_hopeless_ones(scene.vessels[0], 70);
  const Planes all = evaluate_planes(scene, *evaluator, 0, grips, every_field(), grips.size());
  for (int field = 0; field < FIELDS; ++field) {
    const Planes alone = evaluate_planes(scene, *evaluator, 0, grips, {field}, grips.size());
    const int count = field_planes(field, scene);
    ASSERT_TRUE(alone.fields.has(field)) << field;
    for (std::size_t i = 0; i < grips.size(); ++i) {
      for (int plane = 0; plane < count; ++plane) {
        if (field < REAL_FIELDS) {
          expect_same_plane_value(alone.real(field, plane, i), all.real(field, plane, i), "field " + std::to_string(field));
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
