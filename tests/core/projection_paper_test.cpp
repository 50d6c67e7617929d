// SPDX-License-Identifier: MIT
// Kernel 5 in pose `paper`: points turn about one axis until they touch.
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

using core_f64::Vec3;

// Rodrigues' rotation of p about the axis through `pivot`.
Vec3 turned_about(const Vec3& p, const Vec3& pivot, const Vec3& axis, double angle) {
  const Vec3 arm = p - pivot;
  return pivot + std::cos(angle) * arm + std::sin(angle) * glm::cross(axis, arm) +
         (1 - std::cos(angle)) * glm::dot(axis, arm) * axis;
}

std::vector<ProjectionCase> paper_cases() {
  std::vector<ProjectionCase> all = projection_cases(Pose::paper);
  for (ProjectionCase& one : all) {
    if (one.name != "odd") one.scene.hand.paper_max_angle = radians(one.name.size() % 2 ? 5 : 25);  // rare at 5 degrees
  }
  return all;
}

TEST(Paper, AngleIsTheFirstRootOfDenseSampling) {
  int found = 0, none = 0, left_out = 0;
  for (const ProjectionCase& one : paper_cases()) {
    const HandData& hand = one.scene.hand;
    for_each_grip(one, 120, [&](const Evaluator& evaluator, const GripInput& grip, const GripResult& result) {
      const Vec3 index_mcp = to_vec3(result.joints[5]), little_mcp = to_vec3(result.joints[20]);
      const Vec3 index_tip = to_vec3(result.joints[INDEX_TIP]), thumb_tip = to_vec3(result.joints[THUMB_TIP]);
      Vec3 u = glm::normalize(little_mcp - index_mcp);
      if (glm::dot(glm::cross(u, index_tip - index_mcp), thumb_tip - index_tip) < 0) u = -u;
      for (int finger = 2; finger < FINGER_COUNT; ++finger) {
        const Placed placed = placed_finger(hand, result, finger, grip.hand_scale);
        for (std::size_t k = 2; k < 5; ++k) {
          const std::size_t j = finger_start(finger) + k;
          const Vec3 p = to_vec3(result.joints[j]);
          const auto separation = [&](double angle) {
            return evaluator.distance(0, to_triple(turned_about(p, placed.mcp, u, angle))) - placed.radius[k];
          };
          if (separation(0) <= hand.contact_tolerance) {  // it touches: it stays, however deep
            EXPECT_EQ(result.posed[j], result.joints[j]) << one.name;
            continue;
          }
          const Vec3 arm = p - placed.mcp;
          const Crossing crossing = first_zero(separation, hand.paper_max_angle, glm::length(arm - glm::dot(arm, u) * u));
          if (crossing.doubtful) {
            ++left_out;
          } else if (crossing.found) {
            ++found;
            // 1e-7 m: the stop tolerance over the least approach, 1e-9 / 0.05
            ASSERT_LT(glm::distance(to_vec3(result.posed[j]), turned_about(p, placed.mcp, u, crossing.at)),
                      1e-7 * std::max(1.0, hand.scale))
                << one.name << ", joint " << j;
            EXPECT_NEAR(result.separation[j], 0, FINGER_TOUCHING + 1e-15);
          } else {
            ++none;
            EXPECT_EQ(result.posed[j], result.joints[j]) << one.name << ", joint " << j;  // it stays
          }
        }
      }
    });
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(none, 500);
  EXPECT_LT(left_out, (found + none) / 100);
}

TEST(Paper, LargestTurnIsItsOwn) {
  // `max_angle` is the articulated pose's
  Scene one = scene_of({vase()}, Pose::paper), other = one;
  other.hand.max_angle = radians(1);
  const auto evaluator = make_core_evaluator(other);
  int moved = 0;
  for_each_grip({"vase", one}, 60, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
    GripResult again;
    evaluator->grip(0, grip, again);
    EXPECT_EQ(result.posed, again.posed);
    for (std::size_t j = 9; j < JOINT_COUNT; ++j) {
      const double moves = glm::distance(to_vec3(result.posed[j]), to_vec3(result.joints[j]));
      const std::size_t mcp = finger_start(finger_of(static_cast<int>(j))) + 1;
      const double arm = glm::distance(to_vec3(result.joints[j]), to_vec3(result.joints[mcp]));
      EXPECT_LE(moves, 2 * arm * std::sin(radians(2.5)) + 1e-15) << j;  // a chord of 5 degrees
      moved += moves > 0;
    }
  });
  EXPECT_GT(moved, 10);
}

TEST(Paper, RolesAreJudgedInTheRiggedHand) {
  std::array<int, 3> seen{};
  for (const ProjectionCase& one : paper_cases()) {
    Scene scene = one.scene;
    scene.pose = Pose::rigged;
    const auto rigged = make_core_evaluator(scene);
    for_each_grip(one, 100, [&](const Evaluator&, const GripInput& grip, const GripResult& result) {
      GripResult state;
      rigged->grip(0, grip, state);
      for (std::size_t j = 9; j < JOINT_COUNT; ++j) {
        const std::size_t first = finger_start(finger_of(static_cast<int>(j))), k = j - first;
        const unsigned before = state.touch_mask >> first & 31u;
        const bool projected = (result.touch_mask >> j & 1) && !(before >> k & 1);
        const bool is_tip = k == 4 && (before & 15u) != 0, is_finger = !is_tip && before == 0;
        EXPECT_EQ(result.tip_mask >> j & 1, unsigned(projected && is_tip)) << one.name;
        EXPECT_EQ(result.finger_mask >> j & 1, unsigned(projected && is_finger)) << one.name;
        EXPECT_EQ(result.inner_mask >> j & 1, unsigned(projected && !is_tip && !is_finger)) << one.name;
        if (projected) ++seen[is_tip ? 0u : is_finger ? 1u : 2u];
      }
    });
  }
  for (const int count : seen) EXPECT_GT(count, 5);
}

TEST(Paper, AxisCarriesTheIndexTipTowardsTheThumbTip) {
  Random random(43);
  const auto point = [&random] { return Vec3{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)}; };
  for (int n = 0; n < 200; ++n) {
    const Vec3 index_mcp = point(), little_mcp = point(), index_tip = point(), thumb_tip = point();
    const auto axis = core_f64::paper_axis(index_mcp, little_mcp, index_tip, thumb_tip);
    ASSERT_TRUE(axis.exists);
    const Vec3 u = glm::normalize(little_mcp - index_mcp);
    EXPECT_NEAR(std::abs(glm::dot(axis.direction, u)), 1, 1e-15);  // rounding
    EXPECT_NEAR(glm::length(axis.direction), 1, 1e-15);
    const double angle = 1e-6;  // so small that only the sense decides
    EXPECT_LT(glm::distance(turned_about(index_tip, index_mcp, axis.direction, angle), thumb_tip),
              glm::distance(index_tip, thumb_tip));
  }
}

TEST(Paper, AxisOfOneKnuckleDoesNotExist) {
  const auto axis = core_f64::paper_axis({1, 2, 3}, {1, 2, 3}, {0, 0, 0}, {1, 1, 1});
  EXPECT_FALSE(axis.exists);
}

TEST(Paper, TurnedPointIsARotation) {
  Random random(44);
  for (int n = 0; n < 200; ++n) {
    const double angle = random.uniform(0, 1);
    const Vec3 p{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)}, pivot{0.03, -0.02, 0.05};
    const Vec3 arm = p - pivot;
    const std::array<LongRotation, 3> by_axis{rotation_x(angle), rotation_y(angle), rotation_z(angle)};
    for (int k = 0; k < 3; ++k) {
      Vec3 axis{};
      axis[k] = 1;
      const Long3 expected = by_axis[static_cast<std::size_t>(k)] * Long3{arm.x, arm.y, arm.z};
      const Vec3 placed =
          pivot + Vec3{static_cast<double>(expected[0]), static_cast<double>(expected[1]), static_cast<double>(expected[2])};
      EXPECT_LT(glm::distance(core_f64::turned_point(p, pivot, axis, angle), placed), 1e-15);  // rounding
    }
  }
}

TEST(Paper, PointOnItsAxisStays) {
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  const Vec3 pivot{60e-3, 20e-3, 0};
  bool unsettled = false;
  // beside a vertical axis 60 mm from the beaker's, its skin half a micrometer from the wall: a quarter turn would touch
  for (const double off : {0.0, 0.9e-6, 1.1e-6}) {
    const Vec3 p{60e-3, 55e-3, off};
    const Vec3 placed = core_f64::project_point(vessel, p, 20e-3 - 0.5e-6, pivot, {{0, -1, 0}, true}, radians(90), unsettled);
    EXPECT_FALSE(unsettled);
    EXPECT_EQ(placed == p, off < 1e-6) << off;
  }
  // where there is no axis
  const Vec3 p{60e-3, 55e-3, 30e-3};
  EXPECT_EQ(core_f64::project_point(vessel, p, 5e-3, pivot, {{0, -1, 0}, false}, radians(90), unsettled), p);
}

TEST(Paper, PointTurnsToTheWallInClosedForm) {
  // about a vertical axis 60 mm from the beaker's, on a circle of 30 mm: its skin of 5 mm meets the wall 45 mm from the axis at
  // cos(angle from the axis' direction) = (60^2 + 30^2 - 45^2) / (2 60 30)
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  const double meets = std::acos((3600.0 + 900 - 2025) / 3600);
  for (const double sense : {1.0, -1.0}) {
    const Vec3 pivot{60e-3, 50e-3, 0}, p{60e-3, 55e-3, sense * 30e-3};
    // a turn about +y carries +z to +x, so towards the beaker it is about -y
    const core_f64::PaperAxis axis{{0, -sense, 0}, true};
    bool unsettled = false;
    const Vec3 placed = core_f64::project_point(vessel, p, 5e-3, pivot, axis, radians(89), unsettled);
    EXPECT_FALSE(unsettled);
    const Vec3 expected = pivot + 30e-3 * Vec3{-std::cos(meets), 0, sense * std::sin(meets)} + Vec3{0, 5e-3, 0};
    EXPECT_LT(glm::distance(placed, expected), 1e-8);  // the stop tolerance over the approach, about a half
    // not allowed so far, it stays
    EXPECT_EQ(core_f64::project_point(vessel, p, 5e-3, pivot, axis, PI / 2 - meets - 1e-6, unsettled), p);
    EXPECT_NE(core_f64::project_point(vessel, p, 5e-3, pivot, axis, PI / 2 - meets + 1e-6, unsettled), p);
  }
}

}  // namespace
}  // namespace wholehand
