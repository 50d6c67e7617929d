// SPDX-License-Identifier: MIT
// The table that a vessel stands on: how far the hand reaches below it, from the hand by rotation matrices; what this decides, and that
// it changes nothing else.
#include "core/table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "core/gather.h"
#include "core/joints.h"
#include "tests/support/hard_scene.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

Scene scene_on_a_table(Scene scene, double clearance = 2e-3) {
  scene.table = TableData{clearance};
  return scene;
}

GripResult result_on_a_table(const Scene& scene, const GripInput& grip, std::size_t vessel = 0) {
  GripResult result;
  make_core_evaluator(scene)->grip(vessel, grip, result);
  return result;
}

// The frame of three points, as columns.
LongRotation frame_of(const Long3& a, const Long3& b, const Long3& c) {
  const Long3 along = (1 / length(b - a)) * (b - a), normal = cross(along, c - a), up = (1 / length(normal)) * normal;
  const Long3 side = cross(up, along);
  return {{{along[0], side[0], up[0]}, {along[1], side[1], up[1]}, {along[2], side[2], up[2]}}};
}

Long3 long_point(const Triple& p) { return {p[0], p[1], p[2]}; }

LongRotation transposed(const LongRotation& r) {
  LongRotation result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = r[k][i];
  return result;
}

// The heights of the open hand's joints at the place of the rigged hand: three metacarpal bases, which no closure moves, say where it is.
std::array<double, JOINT_COUNT> open_heights(HandData hand, const GripInput& grip, const GripResult& result) {
  hand.scale *= grip.hand_scale;
  const auto open = reference_hand(hand, 0);
  const int a = finger_start(0), b = finger_start(1), c = finger_start(4);
  const LongRotation to = frame_of(long_point(result.joints[a]), long_point(result.joints[b]), long_point(result.joints[c]));
  const LongRotation from = transposed(frame_of(open[a], open[b], open[c]));
  std::array<double, JOINT_COUNT> heights{};
  for (int j = 0; j < JOINT_COUNT; ++j)
    heights[j] = static_cast<double>((long_point(result.joints[a]) + to * (from * (open[j] - open[a])))[1]);
  return heights;
}

double skin_radius(const HandData& hand, const GripInput& grip, int joint) {
  const int f = finger_of(joint);
  return hand.scale * grip.hand_scale * hand.fingers[f].radii[joint - finger_start(f)];
}

double deepest_skin(const HandData& hand, const GripInput& grip, const GripResult& result, double top) {
  const auto open = open_heights(hand, grip, result);
  double deepest = -1e9;
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const double radius = skin_radius(hand, grip, j);
    deepest = std::max({deepest, radius - (result.posed[j][1] - top), radius - (open[j] - top)});
  }
  return deepest;
}

TEST(OnTable, DepthOfAPointInClosedForm) {
  core_f64::Vessel vessel;
  vessel.on_table = true;
  vessel.table_top = 0.25;
  EXPECT_EQ(core_f64::depth_in_table(vessel, {7, 0.5, -3}, 0.125), -0.125);
  EXPECT_EQ(core_f64::depth_in_table(vessel, {0, 0.375, 0}, 0.125), 0);
  EXPECT_EQ(core_f64::depth_in_table(vessel, {0, -0.5, 1}, 0), 0.75);
  const core_f64::FingerPoints points{{0, 1, 0}, {0, 0.75, 0}, {0, 0.5, 0}};
  EXPECT_EQ(core_f64::finger_in_table(vessel, points, {0, 0, 0}), -0.25);       // the tip
  EXPECT_EQ(core_f64::finger_in_table(vessel, points, {0, 0.5, 0.125}), 0);     // the DIP
  EXPECT_EQ(core_f64::finger_in_table(vessel, points, {1, 0.5, 0.125}), 0.25);  // the PIP
}

TEST(OnTable, DepthIsThatOfTheLowestSkinOfThePosedAndTheOpenHand) {
  int feasible = 0, through = 0, by_open_hand = 0;
  for (const HandData& hand : {paper_hand(), odd_hand(), large_hand()}) {
    for (const Pose pose : {Pose::articulated, Pose::paper, Pose::rigged}) {
      const VesselData vessel = scaled(beaker1(), hand.scale);
      const Scene scene = scene_on_a_table(scene_of({vessel}, pose, hand), 3e-3);
      const auto core = make_core_evaluator(scene);
      for (GripInput grip : sample_grips(vessel, 60, 77)) {
        grip.hand_scale = 0.9 + 0.005 * (feasible % 40);
        GripResult result;
        core->grip(0, grip, result);
        if (result.reason != Reason::none) {
          EXPECT_TRUE(std::isnan(result.table_depth));
          EXPECT_FALSE(result.through_table);
          continue;
        }
        ++feasible;
        const double expected = deepest_skin(hand, grip, result, 3e-3);
        // m: roundings of the placed hand
        EXPECT_NEAR(result.table_depth, expected, 1e-13 * hand.scale) << "grip at " << grip.height << " m";
        EXPECT_EQ(result.through_table, result.table_depth > 0);
        EXPECT_FALSE(result.through_table && result.plausible);
        through += result.through_table;
        double posed = -1e9;
        for (int j = 0; j < JOINT_COUNT; ++j) posed = std::max(posed, skin_radius(hand, grip, j) - (result.posed[j][1] - 3e-3));
        by_open_hand += posed < 0 && result.through_table;
      }
    }
  }
  EXPECT_GT(feasible, 200);
  EXPECT_GT(through, 50);
  EXPECT_LT(through, feasible - 50);
  EXPECT_GT(by_open_hand, 0) << "in none of them it is the open hand alone that goes through";
}

// Beside a glass of 80 x 110 mm the tip of the little finger is some 80 mm below that of the index finger.
TEST(OnTable, AHandBesideTheGlassMustHoldItHighEnough) {
  const Scene scene = scene_on_a_table(scene_of({beaker1()}));
  const auto core = make_core_evaluator(scene);
  for (const auto& [grip, is_through] :
       {std::pair{GripInput{20e-3, 0, 0, 0, 0, 1}, true}, std::pair{GripInput{100e-3, 0, 0, 0, 0, 1}, false},
        std::pair{GripInput{100e-3, 0, 0, radians(-90), 0, 1}, false}}) {
    GripResult result;
    core->grip(0, grip, result);
    ASSERT_EQ(result.reason, Reason::none);
    EXPECT_EQ(result.through_table, is_through) << grip.height << " m: " << result.table_depth;
    EXPECT_EQ((result.status & STATUS_THROUGH_TABLE) != 0, is_through);
    const GripScore score = core->score(0, grip, result);
    EXPECT_GT(score.terms.fingers, 0) << "an implausible grip keeps its terms";
    if (is_through) {
      EXPECT_FALSE(result.plausible);
      EXPECT_EQ(score.score, 0);
    }
  }
}

TEST(OnTable, DepthGrowsWithTheClearanceAndWithTheBaseOfTheVessel) {
  const GripInput grip{70e-3, 0.3, 0.1, radians(-20), 2e-3, 1};
  Scene scene = scene_on_a_table(scene_of({beaker1()}), 0);
  const double bare = result_on_a_table(scene, grip).table_depth;
  scene.table->clearance = 5e-3;
  EXPECT_NEAR(result_on_a_table(scene, grip).table_depth, bare + 5e-3, 1e-15);
  scene.vessels[0].base = -20e-3;  // as of a mesh that keeps its own origin
  EXPECT_NEAR(result_on_a_table(scene, grip).table_depth, bare + 5e-3 - 20e-3, 1e-15);
}

TEST(OnTable, ALeftHandReachesAsLowAsTheRight) {
  const Scene right = scene_on_a_table(scene_of({beaker3()}));
  Scene left = right;
  left.hand.handedness = Handedness::left;
  int feasible = 0;
  for (const GripInput& grip : sample_grips(beaker3(), 40, 3)) {
    const GripInput mirrored = mirrored_grip(grip);
    const GripResult of_right = result_on_a_table(right, grip), of_left = result_on_a_table(left, mirrored);
    ASSERT_EQ(of_left.reason, of_right.reason);
    if (of_right.reason != Reason::none) continue;
    ++feasible;
    // m: pi - (pi - a) is a to rounding, and fingers stop within the stop tolerance
    EXPECT_NEAR(of_left.table_depth, of_right.table_depth, 1e-8);
  }
  EXPECT_GT(feasible, 15);
}

// ---- what it leaves alone ----

TEST(OnTable, ChangesOnlyWhetherAGripIsPlausible) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    Scene bare = hard_scene();
    bare.pose = pose;
    const Scene table = scene_on_a_table(bare);
    const FieldSet without = all_fields(bare), with = all_fields(table);
    EXPECT_FALSE(without.has(FIELD_TABLE_DEPTH));
    ASSERT_TRUE(with.has(FIELD_TABLE_DEPTH));
    EXPECT_EQ(with.real_planes, without.real_planes + 1);
    int through = 0, above = 0;
    for (std::size_t v = 0; v < bare.vessels.size(); ++v) {
      const auto grips = grips_with_hopeless_ones(bare.vessels[v], v, 60);
      const GatheredPlanes a = gather(*make_core_evaluator(bare), without, v, grips);
      const GatheredPlanes b = gather(*make_core_evaluator(table), with, v, grips);
      for (std::size_t i = 0; i < grips.size(); ++i) {
        const std::uint32_t status = b.uint(FIELD_STATUS, i);
        const bool is_through = (status & STATUS_THROUGH_TABLE) != 0;
        const bool is_feasible = (status & STATUS_REASON_MASK) == REASON_NONE;
        through += is_through;
        above += is_feasible && !is_through;
        EXPECT_EQ(a.uint(FIELD_STATUS, i) & STATUS_THROUGH_TABLE, 0u);
        EXPECT_EQ(status | (a.uint(FIELD_STATUS, i) & STATUS_PLAUSIBLE),
                  a.uint(FIELD_STATUS, i) | (is_through ? STATUS_THROUGH_TABLE : 0u));
        EXPECT_EQ((status & STATUS_PLAUSIBLE) != 0, (a.uint(FIELD_STATUS, i) & STATUS_PLAUSIBLE) != 0 && !is_through);
        const double depth = b.real(b.fields.plane[FIELD_TABLE_DEPTH], i);
        EXPECT_EQ(std::isnan(depth), !is_feasible);
        EXPECT_EQ(is_through, depth > 0);
        for (int field = 0; field < FIELDS; ++field) {
          if (field == FIELD_STATUS || field == FIELD_TABLE_DEPTH) continue;
          for (int p = 0; p < field_planes(field, bare); ++p) {
            if (field >= REAL_FIELDS) {
              EXPECT_EQ(a.uint(field, i), b.uint(field, i)) << field;
            } else if (field == FIELD_SCORE && is_through) {
              EXPECT_EQ(b.real(b.fields.plane[field], i), 0);
            } else {
              EXPECT_EQ(std::bit_cast<std::uint64_t>(a.real(a.fields.plane[field] + p, i)),
                        std::bit_cast<std::uint64_t>(b.real(b.fields.plane[field] + p, i)))
                  << field;
            }
          }
        }
      }
    }
    EXPECT_GT(through, 20);
    EXPECT_GT(above, 20);
  }
}

}  // namespace
}  // namespace wholehand
