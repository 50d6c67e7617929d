// SPDX-License-Identifier: MIT
// Kernel 3: the hand is placed at the tips.
#include "core/closure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/evaluator.h"
#include "core/joints.h"
#include "tests/support/closing_hand.h"
#include "tests/support/scenes.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

using core_f64::Closing;

void expect_placed(const VesselData& vessel, const HandData& hand, int least_feasible) {
  const auto evaluator = make_core_evaluator(scene_of({vessel}, Pose::rigged, hand));
  int feasible = 0;
  for (const GripInput& sample : sample_grips(vessel, 120, 23)) {
    GripInput grip = sample;
    grip.hand_scale = 0.9 + 0.2 * std::abs(std::sin(100 * sample.azimuth));
    GripResult result;
    evaluator->grip(0, grip, result);
    if (result.reason != Reason::none) continue;
    ++feasible;
    // the specification's frames, in long double, at the closure that was found
    HandData scaled_hand = hand;
    scaled_hand.scale *= grip.hand_scale;
    const auto in_hand = reference_hand(scaled_hand, result.closure);
    const auto unit = [](const Long3& v) { return 1 / length(v) * v; };
    const Long3 e1 = unit(in_hand[INDEX_TIP] - in_hand[THUMB_TIP]);
    const Long3 e2 = unit(Long3{1, 0, 0} - e1[0] * e1), e3 = cross(e1, e2);
    const Long3 f1 = direction_of(grip);
    const Long3 level = unit(Long3{0, -1, 0} - -f1[1] * f1), beside = cross(f1, level);
    const Long3 f2 = std::cos(static_cast<long double>(grip.roll)) * level + std::sin(static_cast<long double>(grip.roll)) * beside;
    const Long3 f3 = cross(f1, f2);
    const Long3 middle = 0.5L * (in_hand[INDEX_TIP] + in_hand[THUMB_TIP]);
    for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
      const Long3 p = in_hand[j] - middle;
      const Long3 placed = widened(result.midpoint) + dot(p, e1) * f1 + dot(p, e2) * f2 + dot(p, e3) * f3;
      // 1e-13 m: rounding of a frame that is 1 / (1 - 0.95^2)^(1/2) ill-conditioned at most, over hands of up to a meter
      ASSERT_LT(length(placed - widened(result.joints[j])), 1e-13 * std::max(1.0, hand.scale)) << vessel.name << ", joint " << j;
    }
  }
  EXPECT_GE(feasible, least_feasible) << vessel.name;
}

TEST(Closure, HandIsPlacedByItsFrames) {
  expect_placed(beaker1(), {}, 60);
  expect_placed(vase(), odd_hand(), 60);
  expect_placed(scaled(ledges(), 0.1), tiny_hand(), 60);
  expect_placed(scaled(beaker3(), 3), large_hand(), 60);
}

TEST(Closure, TipsOfThePlacedHandLandOnTheTipPoints) {
  for (const VesselData& vessel : {beaker1(), beaker3(), vase()}) {
    const ClosingHand ready(vessel);
    const auto evaluator = make_core_evaluator(scene_of({vessel}, Pose::rigged));
    for (const GripInput& grip : sample_grips(vessel, 60, 24)) {
      const Closing closing = ready.close(grip);
      if (closing.reason != REASON_NONE) continue;
      GripResult result;
      evaluator->grip(0, grip, result);
      const Long3 d = direction_of(grip), o = foot_of(grip);
      // 1e-8 m: the hand's gap is the tips' to 1e-9 m, shared by both ends
      EXPECT_LT(length(widened(result.joints[INDEX_TIP]) - (o + closing.t_index * d)), 1e-8);
      EXPECT_LT(length(widened(result.joints[THUMB_TIP]) - (o + closing.t_thumb * d)), 1e-8);
      // and they rest on the glass
      EXPECT_NEAR(result.separation[INDEX_TIP], 0, 1e-8);
      EXPECT_NEAR(result.separation[THUMB_TIP], 0, 1e-8);
    }
  }
}

TEST(Closure, RotationIsProper) {
  HandData data = odd_hand();
  const core_f64::Hand hand = ready_hand(data);
  data.scale = 1;
  Random random(25);
  for (int n = 0; n < 200; ++n) {
    const double closure = random.uniform(0, 1);
    double e1_x = 9;
    const core_f64::Placement placement =
        core_f64::place_hand(hand, closure, core_f64::grip_direction(random.uniform(-PI, PI), random.uniform(-1.5, 1.5)),
                             random.uniform(-PI, PI), {0.1, 0.2, 0.3}, 1.7, e1_x);
    const core_f64::Mat3& R = placement.rotation;
    // 1e-13: rounding, 1e-16, over the sine of the angle of d with the axis, 0.07 at least here, and of e1 with x, 0.1 at least
    EXPECT_NEAR(glm::determinant(R), 1, 1e-13);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(glm::dot(R[i], R[j]), i == j ? 1 : 0, 1e-13);
    }
    const auto joints = reference_hand(data, closure);
    EXPECT_NEAR(e1_x, static_cast<double>((joints[INDEX_TIP][0] - joints[THUMB_TIP][0]) / reference_gap(data, closure)), 1e-13);
    EXPECT_EQ(placement.scale, 1.7);
  }
}

TEST(Closure, AtRollZeroTheLittleFingerIsBelow) {
  const auto evaluator = make_core_evaluator(scene_of({beaker1()}, Pose::rigged));
  for (const double azimuth : {0.0, 100.0, -60.0}) {
    GripResult result;
    evaluator->grip(0, grip_of(80, 0, 0, 0, azimuth), result);
    ASSERT_EQ(result.reason, Reason::none);
    for (int k = 0; k < 5; ++k) {
      for (int finger = 2; finger < 5; ++finger) {  // each finger under the one before it
        const auto joint = static_cast<std::size_t>(finger_start(finger) + k);
        EXPECT_LT(result.joints[joint][1], result.joints[joint - 5][1]) << "finger " << finger << ", joint " << k;
      }
    }
  }
}

TEST(Closure, AtRollMinus90TheHandIsAbove) {
  const auto evaluator = make_core_evaluator(scene_of({beaker1()}, Pose::rigged));
  for (const double azimuth : {0.0, 45.0, 180.0}) {
    GripResult result;
    evaluator->grip(0, grip_of(60, 0, 0, -90, azimuth), result);
    ASSERT_EQ(result.reason, Reason::none);
    for (const std::size_t j : {0, 1, 4, 5, 9, 10, 14, 15, 19, 20}) EXPECT_GT(result.joints[j][1], 80e-3) << j;  // the palm
    // the little finger's knuckle is level with the index finger's, to the side: e2, across the hand, is horizontal
    EXPECT_LT(std::abs(result.joints[20][1] - result.joints[5][1]), 40e-3);
  }
}

TEST(Closure, AzimuthTurnsEverything) {
  const VesselData vessel = vase();
  const auto evaluator = make_core_evaluator(scene_of({vessel}));
  int feasible = 0;
  for (GripInput grip : sample_grips(vessel, 60, 26)) {
    GripResult turned, straight;
    evaluator->grip(0, grip, turned);
    const LongRotation R = rotation_y(grip.azimuth);
    grip.azimuth = 0;
    evaluator->grip(0, grip, straight);
    ASSERT_EQ(turned.reason, straight.reason);
    if (turned.reason != Reason::none || turned.grazing) continue;
    ++feasible;
    EXPECT_NEAR(turned.closure, straight.closure, 1e-7);  // two stop tolerances over the gap's slope, 0.05 m at least
    for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
      // 1e-7 m: the above, times the fingers' 0.1 m and the inverse of the contact angle's cosine
      EXPECT_LT(length(R * widened(straight.joints[j]) - widened(turned.joints[j])), 1e-7);
    }
  }
  EXPECT_GT(feasible, 30);
}

TEST(Closure, EverythingScalesTogether) {
  const VesselData vessel = vase();
  const auto plain = make_core_evaluator(scene_of({vessel}, Pose::rigged));
  for (const double factor : {0.1, 3.0}) {
    const auto evaluator =
        make_core_evaluator(scene_of({scaled(vessel, factor)}, Pose::rigged, factor < 1 ? tiny_hand() : large_hand()));
    for (const GripInput& grip : sample_grips(vessel, 40, 27)) {
      GripInput scaled_grip = grip;
      scaled_grip.height *= factor;
      scaled_grip.offset *= factor;
      GripResult one, other;
      plain->grip(0, grip, one);
      evaluator->grip(0, scaled_grip, other);
      ASSERT_EQ(one.reason, other.reason);
      if (one.reason != Reason::none || one.grazing) continue;
      EXPECT_NEAR(other.closure, one.closure, 1e-6);  // the stop tolerance is ten times coarser on a hand ten times smaller
      EXPECT_NEAR(other.gap, factor * one.gap, CLOSING_STOPPED);
    }
  }
}

}  // namespace
}  // namespace wholehand
