// SPDX-License-Identifier: MIT
// Which values of planes may be absent or infinite, and which must not. Each test spoils one value of good planes.
#include "core/absent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "core/fields.h"
#include "tests/support/special_values.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

// One grip that is feasible and antipodal, one that is too wide, one that misses.
struct Absent : testing::Test {
  Absent() : scene(wet_scene({beaker1()}, Pose::articulated)) {
    scene.table.emplace();
    scene.arm.emplace();
    scene.hand.between = 2;
    fields = all_fields(scene);
    const std::vector<GripInput> grips{{0.055, 0, 0, 0, 0, 1}, {0.055, 0, 0, 0, 0, 0.3}, {0.3, 0, 0, 0, 0, 1}};
    planes = gather(*make_core_evaluator(scene), fields, 0, grips);
    EXPECT_NE(status(0) & STATUS_ANTIPODAL, 0u);
    EXPECT_EQ(status(1) & STATUS_REASON_MASK, unsigned(REASON_TOO_WIDE));
    EXPECT_EQ(status(2) & STATUS_REASON_MASK, unsigned(REASON_MISSES));
  }
  std::uint32_t& status(std::size_t grip) { return planes.uints[fields.plane[FIELD_STATUS] * planes.count + grip]; }
  double& value(int field, std::size_t grip) { return planes.reals[fields.plane[field] * planes.count + grip]; }
  Misplaced look(bool overflows = false) const {
    return misplaced_values(scene, 0, fields, planes.count, planes.count, planes.reals.data(), planes.uints.data(), overflows);
  }
  // Changes the value, counts what is misplaced, and puts the value back.
  std::uint64_t with(int field, std::size_t grip, double changed) {
    const double kept = std::exchange(value(field, grip), changed);
    const Misplaced found = look();
    value(field, grip) = kept;
    if (found.count > 0) {
      EXPECT_EQ(found.field, field);
      EXPECT_EQ(found.grip, grip);
      EXPECT_NE(describe(found), "");
    }
    return found.count;
  }

  Scene scene;
  FieldSet fields;
  GatheredPlanes planes;
};

TEST_F(Absent, WhatTheCoreSaysIsWhereItShouldBe) {
  EXPECT_EQ(look().count, 0u);
  EXPECT_EQ(describe(look()), "");
}

TEST_F(Absent, AFeasibleGripHasFiniteValuesEverywhere) {
  for (int field = 0; field < REAL_FIELDS; ++field) {
    if (field_row(field).of_strength) continue;  // this scene has none
    EXPECT_EQ(with(field, 0, NOT_A_NUMBER), field == FIELD_SAFE_TILT ? 0u : 1u) << field;
    EXPECT_EQ(with(field, 0, INFINITE), 1u) << field;
    EXPECT_EQ(with(field, 0, -INFINITE), 1u) << field;
  }
}

TEST_F(Absent, AnInfiniteHoldForceNeedsAReason) {
  for (const int field : {FIELD_HOLD_FORCE, FIELD_LARGEST_HOLD}) {
    const double kept = std::exchange(value(field, 0), INFINITE);
    EXPECT_EQ(look().count, 1u);
    EXPECT_EQ(look(true).count, 0u) << "it may be too large";
    status(0) ^= STATUS_ANTIPODAL;
    EXPECT_EQ(look().count, 0u) << "the pinch is not antipodal";
    status(0) ^= STATUS_ANTIPODAL;
    const ForceData force = scene.force;
    scene.force.friction = 0;
    EXPECT_EQ(look().count, 0u) << "no friction";
    scene.force = force;
    scene.force.torsion = 0;
    EXPECT_EQ(look().count, 0u) << "no torsion";
    scene.force = force;
    value(field, 0) = kept;
  }
}

TEST_F(Absent, AnInfeasibleGripHasWhatItsReasonLeaves) {
  for (const std::size_t grip : {1u, 2u}) {
    EXPECT_EQ(with(FIELD_SCORE, grip, 0.5), 1u);
    EXPECT_EQ(with(FIELD_TERMS, grip, NOT_A_NUMBER), 1u);
    for (const int field : {FIELD_CLOSURE, FIELD_POSED, FIELD_SEPARATION, FIELD_HOLD_FORCE, FIELD_SAFE_TILT}) {
      EXPECT_EQ(with(field, grip, 0), 1u) << field;
      EXPECT_EQ(with(field, grip, INFINITE), 1u) << field;
    }
  }
  for (const int field : {FIELD_GAP, FIELD_MIDPOINT, FIELD_T_INDEX, FIELD_T_THUMB}) {
    EXPECT_EQ(with(field, 1, NOT_A_NUMBER), 1u) << field;
    EXPECT_EQ(with(field, 2, 0), 1u) << field;
  }
}

}  // namespace
}  // namespace wholehand
