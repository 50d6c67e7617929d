// SPDX-License-Identifier: MIT
// Which planes a field has, where they stand, and how a grip is read back from them.
#include "core/planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/evaluator.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

int planes_of(int field, const Scene& scene) { return field_planes(field, scene); }

// Planes of a kind of field (reals or uints) stand side by side without a gap: kept ones first.
void expect_packed(const FieldSet& fields, const std::vector<int>& kept, const Scene& scene, bool reals) {
  const int first = reals ? 0 : REAL_FIELDS, last = reals ? REAL_FIELDS : FIELDS;
  const int kept_planes = reals ? fields.real_kept : fields.uint_kept, all = reals ? fields.real_planes : fields.uint_planes;
  std::vector<int> taken(static_cast<std::size_t>(all), 0);
  int of_kept = 0;
  for (int field = first; field < last; ++field) {
    if (!fields.has(field)) continue;
    const bool is_kept = std::find(kept.begin(), kept.end(), field) != kept.end();
    for (int k = 0; k < planes_of(field, scene); ++k) {
      const int plane = fields.plane[static_cast<std::size_t>(field)] + k;
      ASSERT_GE(plane, 0) << field;
      ASSERT_LT(plane, all) << field;
      ++taken[static_cast<std::size_t>(plane)];
      EXPECT_EQ(plane < kept_planes, is_kept) << "field " << field;
      of_kept += is_kept;
    }
  }
  EXPECT_EQ(of_kept, kept_planes);
  for (const int times : taken) EXPECT_EQ(times, 1);
}

void expect_packed(const std::vector<int>& kept, const Scene& scene) {
  const FieldSet fields = make_field_set(kept, scene);
  for (const int field : kept) EXPECT_EQ(fields.has(field), planes_of(field, scene) > 0) << field;
  expect_packed(fields, kept, scene, true);
  expect_packed(fields, kept, scene, false);
}

TEST(Planes, FieldsHaveTheCountsOfTheLayout) {
  for (const int field :
       {FIELD_T_INDEX, FIELD_T_THUMB, FIELD_GAP, FIELD_CLOSURE, FIELD_PHALANX_DEPTH, FIELD_PALM_DEPTH, FIELD_BONE_STRETCH,
        FIELD_SCORE, FIELD_STATUS, FIELD_TOUCH_MASK, FIELD_TIP_MASK, FIELD_FINGER_MASK, FIELD_INNER_MASK, FIELD_USED_MASK}) {
    EXPECT_EQ(field_planes(field, 5, 31), 1) << field;
    EXPECT_EQ(field_planes(field, 1, 0), 1) << field;
  }
  EXPECT_EQ(field_planes(FIELD_MIDPOINT, 5, 31), 3);
  EXPECT_EQ(field_planes(FIELD_CONTACT_ANGLES, 5, 31), 2);
  for (const int field : {FIELD_JOINTS, FIELD_POSED, FIELD_PROXIES}) EXPECT_EQ(field_planes(field, 5, 31), 72) << field;
  EXPECT_EQ(field_planes(FIELD_SEPARATION, 5, 31), 24);
  EXPECT_EQ(field_planes(FIELD_TERMS, 5, 31), 6);
  for (const int field : {FIELD_PEAK_FORCE, FIELD_PEAK_TILT, FIELD_LARGEST_HOLD, FIELD_SAFE_TILT}) {
    EXPECT_EQ(field_planes(field, 5, 31), 5) << field;
    EXPECT_EQ(field_planes(field, 5, 0), 0) << field;
  }
  for (const int field :
       {FIELD_PIVOT_LENGTH, FIELD_TORQUE, FIELD_EXACT_TORQUE, FIELD_NORMAL_FORCE, FIELD_FEEDBACK_FORCE, FIELD_HOLD_FORCE}) {
    EXPECT_EQ(field_planes(field, 5, 31), 155) << field;
    EXPECT_EQ(field_planes(field, 5, 0), 0) << field;
  }
}

TEST(Planes, FillsAreTheLiquidsOrTheEmptyGlass) {
  Scene scene = three_beakers();
  EXPECT_EQ(scene_fills(scene), 5u);
  scene.liquid.reset();
  EXPECT_EQ(scene_fills(scene), 1u);
}

TEST(Planes, KeptPlanesComeFirstWhateverIsKept) {
  for (const bool with_tilts : {true, false}) {
    Scene scene = three_beakers();
    if (!with_tilts) scene.tilts.clear();
    for (int field = 0; field < FIELDS; ++field) expect_packed({field}, scene);
    std::vector<int> every(FIELDS);
    std::iota(every.begin(), every.end(), 0);
    expect_packed(every, scene);
    std::reverse(every.begin(), every.end());
    expect_packed(every, scene);
    expect_packed({FIELD_STATUS, FIELD_SCORE, FIELD_HOLD_FORCE, FIELD_GAP, FIELD_USED_MASK}, scene);
    expect_packed({}, scene);
  }
}

TEST(Planes, EverythingKeptLeavesNoScratch) {
  const Scene scene = three_beakers();
  std::vector<int> every(FIELDS);
  std::iota(every.begin(), every.end(), 0);
  const FieldSet fields = make_field_set(every, scene);
  EXPECT_EQ(fields.real_kept, fields.real_planes);
  EXPECT_EQ(fields.uint_kept, 6);
  EXPECT_EQ(fields.uint_planes, 6);
  const int scalars = 8, vectors = 3 + 2 + 3 * 72 + 24 + 6, per_fill = 4 * 5, per_state = 6 * 5 * 31;
  EXPECT_EQ(fields.real_kept, scalars + vectors + per_fill + per_state);
}

TEST(Planes, AskingTwiceIsAskingOnce) {
  const Scene scene = three_beakers();
  const FieldSet once = make_field_set({FIELD_GAP, FIELD_SCORE}, scene),
                 twice = make_field_set({FIELD_GAP, FIELD_SCORE, FIELD_GAP}, scene);
  EXPECT_EQ(once.plane, twice.plane);
  EXPECT_EQ(once.real_kept, twice.real_kept);
  EXPECT_EQ(once.real_planes, twice.real_planes);
}

TEST(Planes, ScratchIsWhatTheKeptFieldsNeed) {
  const Scene scene = three_beakers();
  // the score needs masks, depths and the force terms, but no joints
  const FieldSet score = make_field_set({FIELD_SCORE}, scene);
  EXPECT_EQ(score.real_kept, 1);
  EXPECT_EQ(score.uint_kept, 0);
  for (const int field : {FIELD_JOINTS, FIELD_POSED, FIELD_PROXIES, FIELD_BONE_STRETCH, FIELD_TORQUE, FIELD_HOLD_FORCE}) {
    EXPECT_FALSE(score.has(field)) << field;
  }
  // the score itself is always there: the best grips are chosen by it
  EXPECT_TRUE(make_field_set({}, scene).has(FIELD_SCORE));
  EXPECT_EQ(make_field_set({}, scene).real_kept, 0);
  // what is not asked for is not there
  EXPECT_FALSE(make_field_set({FIELD_GAP}, scene).has(FIELD_HOLD_FORCE));
}

TEST(Planes, ForceFieldsDoNotExistWithoutTilts) {
  Scene scene = three_beakers();
  scene.tilts.clear();
  const FieldSet fields = make_field_set({FIELD_PEAK_FORCE, FIELD_SAFE_TILT, FIELD_TORQUE, FIELD_SCORE}, scene);
  EXPECT_FALSE(fields.has(FIELD_PEAK_FORCE));
  EXPECT_FALSE(fields.has(FIELD_SAFE_TILT));
  EXPECT_FALSE(fields.has(FIELD_TORQUE));
  EXPECT_TRUE(fields.has(FIELD_SCORE));
}

TEST(Planes, TheTablesFieldExistsOnlyOnATable) {
  Scene scene = three_beakers();
  EXPECT_FALSE(make_field_set({FIELD_TABLE_DEPTH}, scene).has(FIELD_TABLE_DEPTH));
  EXPECT_EQ(field_planes(FIELD_TABLE_DEPTH, scene), 0);
  scene.table.emplace();
  const FieldSet fields = make_field_set({FIELD_TABLE_DEPTH}, scene);
  EXPECT_TRUE(fields.has(FIELD_TABLE_DEPTH));
  EXPECT_EQ(fields.real_kept, 1);
  EXPECT_FALSE(make_field_set({FIELD_SCORE}, scene).has(FIELD_TABLE_DEPTH)) << "the status has what the score needs of it";
  for (int field = 0; field < FIELDS; ++field) expect_packed({field}, scene);
}

// ---- reading back ----

struct Evaluated {
  Scene scene = three_beakers();
  std::vector<GripInput> grips;
  FieldSet fields;
  std::vector<double> reals;
  std::vector<float> floats;
  std::vector<std::uint32_t> uints;
  PlaneChunk chunk;
};

Evaluated evaluated(const std::vector<int>& kept) {
  Evaluated e;
  e.grips = sample_grips(e.scene.vessels[0], 13, 5);
  e.grips[4].hand_scale = 0.3;  // too wide
  e.fields = make_field_set(kept, e.scene);
  e.chunk.count = e.grips.size();
  e.chunk.stride = e.grips.size() + 3;
  e.reals.resize(std::size_t(e.fields.real_planes) * e.chunk.stride);
  e.uints.resize(std::size_t(e.fields.uint_planes) * e.chunk.stride);
  make_core_evaluator(e.scene)->planes(0, e.grips.data(), e.grips.size(), e.fields, e.chunk.stride, e.reals.data(), e.uints.data());
  e.floats.assign(e.reals.begin(), e.reals.end());
  e.chunk.uints = e.uints.data();
  return e;
}

TEST(Planes, DecodedGripIsTheGrip) {
  std::vector<int> every(FIELDS);
  std::iota(every.begin(), every.end(), 0);
  Evaluated e = evaluated(every);
  e.chunk.doubles = e.reals.data();
  const auto evaluator = make_core_evaluator(e.scene);
  int feasible = 0;
  for (std::size_t i = 0; i < e.grips.size(); ++i) {
    GripResult expected;
    evaluator->grip(0, e.grips[i], expected);
    const GripResult decoded = decode_grip(e.chunk, e.fields, i);
    EXPECT_EQ(decoded.reason, expected.reason) << i;
    EXPECT_EQ(decoded.status, expected.status) << i;
    EXPECT_EQ(decoded.plausible, expected.plausible) << i;
    EXPECT_EQ(decoded.antipodal, expected.antipodal) << i;
    EXPECT_EQ(decoded.grazing, expected.grazing) << i;
    if (expected.reason != Reason::none) continue;
    ++feasible;
    EXPECT_EQ(decoded.contact_angles, expected.contact_angles) << i;
    EXPECT_EQ(decoded.closure, expected.closure) << i;
    EXPECT_EQ(decoded.gap, expected.gap) << i;
    EXPECT_EQ(decoded.midpoint, expected.midpoint) << i;
    EXPECT_EQ(decoded.joints, expected.joints) << i;
    EXPECT_EQ(decoded.posed, expected.posed) << i;
    EXPECT_EQ(decoded.proxies, expected.proxies) << i;
    EXPECT_EQ(decoded.separation, expected.separation) << i;
    EXPECT_EQ(decoded.touch_mask, expected.touch_mask) << i;
    EXPECT_EQ(decoded.tip_mask, expected.tip_mask) << i;
    EXPECT_EQ(decoded.finger_mask, expected.finger_mask) << i;
    EXPECT_EQ(decoded.inner_mask, expected.inner_mask) << i;
    EXPECT_EQ(decoded.used_mask, expected.used_mask) << i;
    EXPECT_EQ(decoded.phalanx_depth, expected.phalanx_depth) << i;
    EXPECT_EQ(decoded.palm_depth, expected.palm_depth) << i;
    EXPECT_EQ(decoded.bone_stretch, expected.bone_stretch) << i;
    EXPECT_EQ(decoded.through_table, expected.through_table) << i;
    EXPECT_TRUE(std::isnan(decoded.table_depth) && std::isnan(expected.table_depth)) << i;
  }
  EXPECT_GT(feasible, 5);
}

TEST(Planes, DecodedGripOfFloatsIsTheirValues) {
  Evaluated e = evaluated({FIELD_STATUS, FIELD_GAP, FIELD_MIDPOINT});
  e.chunk.floats = e.floats.data();
  for (std::size_t i = 0; i < e.grips.size(); ++i) {
    const GripResult decoded = decode_grip(e.chunk, e.fields, i);
    if (decoded.reason != Reason::none) continue;
    EXPECT_EQ(decoded.gap, static_cast<double>(e.floats[std::size_t(e.fields.plane[FIELD_GAP]) * e.chunk.stride + i]));
    EXPECT_EQ(decoded.midpoint[2],
              static_cast<double>(e.floats[std::size_t(e.fields.plane[FIELD_MIDPOINT] + 2) * e.chunk.stride + i]));
  }
}

TEST(Planes, FieldsThatAreNotThereDecodeAsZero) {
  Evaluated e = evaluated({FIELD_STATUS, FIELD_GAP});
  e.chunk.doubles = e.reals.data();
  for (std::size_t i = 0; i < e.grips.size(); ++i) {
    const GripResult decoded = decode_grip(e.chunk, e.fields, i);
    if (decoded.reason != Reason::none) continue;
    EXPECT_GT(decoded.gap, 0);
    EXPECT_EQ(decoded.joints[5], (Triple{}));
    EXPECT_EQ(decoded.proxies[23], (Triple{}));
    EXPECT_EQ(decoded.bone_stretch, 0);
  }
}

}  // namespace
}  // namespace wholehand
