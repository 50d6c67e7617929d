// SPDX-License-Identifier: MIT
// Kernel 5: which points touch in which role, which grips are plausible, what pose `rigged` leaves as it is, and the same in float.
#include "core/joints.h"
#include "core/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/evaluator.h"
#include "core/vectors.h"
#include "tests/support/placed_finger.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

// ---- roles ----

TEST(Projection, RolesInOrder) {
  const int base = 1, mcp = 2, pip = 4, dip = 8, tip = 16;
  enum { TIP, FINGER, INNER };
  // a tip whose finger touched further in, MCP and base included
  for (const int before : {base, mcp, pip, dip, mcp | pip, base | dip})
    EXPECT_EQ(core_f64::projection_role(4, before), TIP) << before;
  // no point of the finger touched
  for (const int point : {2, 3, 4}) EXPECT_EQ(core_f64::projection_role(point, 0), FINGER) << point;
  // anything else
  for (const int before : {base, mcp, dip, tip, mcp | tip}) EXPECT_EQ(core_f64::projection_role(2, before), INNER) << before;
  for (const int before : {base, mcp, pip, tip, pip | tip}) EXPECT_EQ(core_f64::projection_role(3, before), INNER) << before;
}

TEST(Projection, RolesOfWholeGripsAreThoseOfTheStateBefore) {
  // the simulation knows the separations when a finger left its trajectory
  std::array<int, 3> seen{};
  int left_out = 0, compared = 0;
  for (const ProjectionCase& one : projection_cases(Pose::articulated)) {
    const HandData& hand = one.scene.hand;
    const double tolerance = hand.contact_tolerance;
    for_each_grip(one, 50, [&](const Evaluator& evaluator, const GripInput& grip, const GripResult& result) {
      EXPECT_EQ((result.tip_mask | result.finger_mask | result.inner_mask) & 0x1FFu, 0u);  // thumb and index finger
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        const std::size_t j = finger_start(finger);
        const FingerRest rest = simulate(evaluator, hand, placed_finger(hand, result, finger, grip.hand_scale), result.closure);
        bool near = rest.doubtful;
        int before = (result.separation[j] <= tolerance ? 1 : 0) | (result.separation[j + 1] <= tolerance ? 2 : 0);
        for (int k = 0; k < 3; ++k) {
          if (rest.before[k] <= tolerance) before |= 4 << k;
          near = near || std::abs(rest.before[k] - tolerance) < 1e-6 ||
                 std::abs(result.separation[j + 2 + static_cast<std::size_t>(k)] - tolerance) < 1e-6;
        }
        if (near) {
          ++left_out;
          continue;
        }
        ++compared;
        for (std::size_t k = 0; k < 5; ++k) {
          const bool touches = result.touch_mask >> (j + k) & 1, projected = touches && !(before >> k & 1);
          const bool is_tip = k == 4 && (before & 15) != 0, is_finger = !is_tip && before == 0;
          EXPECT_EQ(result.tip_mask >> (j + k) & 1, unsigned(projected && is_tip)) << one.name;
          EXPECT_EQ(result.finger_mask >> (j + k) & 1, unsigned(projected && is_finger)) << one.name;
          EXPECT_EQ(result.inner_mask >> (j + k) & 1, unsigned(projected && !is_tip && !is_finger)) << one.name;
          if (projected) ++seen[is_tip ? 0u : is_finger ? 1u : 2u];
        }
      }
    });
  }
  for (const int count : seen) EXPECT_GT(count, 5);
  EXPECT_LT(left_out, compared / 50);
}

TEST(Projection, ProjectedPointsTouchAndHaveOneRole) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    for (const ProjectionCase& one : projection_cases(pose)) {
      for_each_grip(one, 100, [&](const Evaluator&, const GripInput&, const GripResult& result) {
        EXPECT_EQ(result.tip_mask & result.finger_mask, 0u);
        EXPECT_EQ(result.tip_mask & result.inner_mask, 0u);
        EXPECT_EQ(result.finger_mask & result.inner_mask, 0u);
        EXPECT_EQ((result.tip_mask | result.finger_mask | result.inner_mask) & ~result.touch_mask, 0u);
        EXPECT_EQ(result.tip_mask & ~(1u << 13 | 1u << 18 | 1u << 23), 0u);  // tips only
      });
    }
  }
}

// ---- plausible ----

TEST(Projection, PlausibleIsNoDeeperThanTheLimit) {
  int plausible = 0, implausible = 0, exempt = 0;
  for (const Pose pose : {Pose::articulated, Pose::paper, Pose::rigged}) {
    for (const ProjectionCase& one : projection_cases(pose)) {
      for_each_grip(one, 100, [&](const Evaluator&, const GripInput&, const GripResult& result) {
        double judged = 0, all = 0;
        for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
          if (pose != Pose::paper || j <= INDEX_TIP)
            judged = std::max(judged, -result.separation[j]);  // in `paper` the others are exempt
          all = std::max(all, -result.separation[j]);
        }
        EXPECT_EQ(result.plausible, judged <= one.scene.hand.depth_limit) << one.name;
        EXPECT_EQ((result.status & STATUS_PLAUSIBLE) != 0, result.plausible);
        ++(result.plausible ? plausible : implausible);
        exempt += result.plausible && all > one.scene.hand.depth_limit;
      });
    }
  }
  EXPECT_GT(plausible, 200);
  EXPECT_GT(implausible, 200);
  EXPECT_GT(exempt, 20);
}

TEST(Projection, PlausibleUpToTheLimitItself) {
  const ProjectionCase one{"vase", scene_of({vase()})};
  int checked = 0;
  for_each_grip(one, 60, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
    const double depth = std::max(result.phalanx_depth, result.palm_depth);
    if (depth < 1e-3) return;
    Scene scene = one.scene;
    for (const double factor : {1.0, 1 - 1e-12}) {
      scene.hand.depth_limit = depth * factor;
      GripResult again;
      make_core_evaluator(scene)->grip(0, grip, again);
      EXPECT_EQ(again.plausible, factor == 1.0);
    }
    ++checked;
  });
  EXPECT_GT(checked, 3);
}

// ---- rigged ----

TEST(Rigged, LeavesEveryJointAsRigged) {
  for (const ProjectionCase& one : projection_cases(Pose::rigged)) {
    for_each_grip(one, 60, [&](const Evaluator&, const GripInput&, const GripResult& result) {
      EXPECT_EQ(result.posed, result.joints);
      EXPECT_EQ(result.tip_mask | result.finger_mask | result.inner_mask, 0u);
      EXPECT_EQ((result.status & ~std::uint32_t(STATUS_CONTACT_UNDECIDED)) >> STATUS_BLOCKED_SHIFT, 0u);
    });
  }
}

TEST(Rigged, HandIsTheSameInEveryPose) {
  const auto rigged = make_core_evaluator(scene_of({vase()}, Pose::rigged));
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    for_each_grip({"vase", scene_of({vase()}, pose)}, 60, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
      GripResult other;
      rigged->grip(0, grip, other);
      EXPECT_EQ(result.joints, other.joints);
      EXPECT_EQ(result.closure, other.closure);
      EXPECT_EQ(result.palm_depth, other.palm_depth);  // bases do not move
    });
  }
}

// ---- single precision ----

double furthest_apart(const GripResult& a, const GripResult& b) {
  double largest = 0;
  for (std::size_t j = 0; j < JOINT_COUNT; ++j)
    largest = std::max(largest, glm::distance(to_vec3(a.posed[j]), to_vec3(b.posed[j])));
  return largest;
}

// How far the pose moves for 1e-6 m in height and offset and 1e-5 rad in the angles; 1 m if the grip becomes infeasible.
double moves_of_pose(const Evaluator& evaluator, const GripInput& grip, const GripResult& exact) {
  double moves = 0;
  for (const double sign : {-1.0, 1.0}) {
    for (int axis = 0; axis < 4; ++axis) {
      GripInput beside = grip;
      (axis == 0   ? beside.height
       : axis == 1 ? beside.offset
       : axis == 2 ? beside.obliquity
                   : beside.roll) += sign * (axis < 2 ? 1e-6 : 1e-5);
      GripResult moved;
      evaluator.grip(0, beside, moved);
      moves = std::max(moves, moved.reason == Reason::none ? furthest_apart(exact, moved) : 1.0);
    }
  }
  return moves;
}

TEST(Projection, FloatAgreesWithDouble) {
  // A float distance is good to 1e-8 m and tips stop within 1e-6 m, so an answer may differ by what an input moved by as much does
  // to it. That is measured in double: how far the pose moves for 1e-6 m in height and offset and 1e-5 rad in the angles, the order
  // of the placement's own error (1e-6 m over a hand's half gap of 50 mm).
  int left_out = 0, feasible = 0, other_reasons = 0;
  double worst = 0;
  for (const VesselData& vessel : {beaker1(), beaker2(), beaker3(), vase()}) {
    const Scene scene = scene_of({vessel});
    const auto full = make_core_evaluator(scene), single = make_core_float_evaluator(scene);
    for (const GripInput& grip : sample_grips(vessel, 250, 46)) {
      GripResult exact, rough;
      full->grip(0, grip, exact);
      single->grip(0, grip, rough);
      const double open = full->gap_at(0), closed = std::max(full->gap_at(1), 15e-3);
      if (exact.reason != rough.reason) {
        // only where the gap is within a float's error of its limits
        EXPECT_LT(std::min(std::abs(exact.gap - open), std::abs(exact.gap - closed)), 1e-5) << vessel.name;
        ++other_reasons;
        continue;
      }
      if (exact.reason != Reason::none) continue;
      ++feasible;
      const double moves = moves_of_pose(*full, grip, exact);
      if (moves > 1e-4 || exact.grazing) {  // ill-conditioned: a touch at a grazing angle, or two that are nearly one
        ++left_out;
        continue;
      }
      const double off = furthest_apart(exact, rough);
      worst = std::max(worst, off);
      // 1e-5 m: ten stop tolerances for the chain of touches; ten times what the inputs' own error does
      EXPECT_LT(off, 1e-5 + 10 * moves) << vessel.name << ", moves " << moves;
      EXPECT_NEAR(rough.gap, exact.gap, 1e-5);
      EXPECT_NEAR(rough.closure, exact.closure, 1e-3);  // 1e-5 m over the gap's slope, 0.05 m at least
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        EXPECT_NEAR(rough.separation[j], exact.separation[j], off + 1e-7);  // a distance changes no faster than its point
        const bool near = std::abs(exact.separation[j] - scene.hand.contact_tolerance) < off + 1e-7;
        if (!near) {
          EXPECT_EQ(rough.touch_mask >> j & 1, exact.touch_mask >> j & 1) << vessel.name << ", joint " << j;
        }
      }
    }
  }
  RecordProperty("worst_um", static_cast<int>(worst * 1e6));
  RecordProperty("left_out", left_out);
  EXPECT_GT(feasible, 500);
  EXPECT_LE(other_reasons, 5);  // of 1,000: as rare as a gap within 10 um of its limits
  EXPECT_LE(left_out, feasible / 100);
}

}  // namespace
}  // namespace wholehand
