// SPDX-License-Identifier: MIT
// Kernel 1: joints against the specification's rotation matrices, the gap and its inverse, hands that are refused.
#include "core/hand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/text/error.h"
#include "core/evaluator.h"
#include "core/joints.h"
#include "tests/support/refusal.h"
#include "tests/support/scenes.h"
#include "tests/support/vectors.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

// 1e-15 m: a joint is a sum of at most five terms under 0.3 m, each rounded to 5e-17 m, with sines good to 1e-15.
constexpr double JOINT_ROUNDING = 1e-15;
const std::array<const char*, 3> HAND_NAMES{"default", "odd", "large"};
const std::array<HandData, 3> HANDS{paper_hand(), odd_hand(), large_hand()};
const std::array<double, 7> CLOSURES{0, 0.1, 1.0 / 3, 0.5, 0.75, 0.999, 1};

// Joints of a hand at scale 1 by the leaf functions.
std::array<Long3, JOINT_COUNT> core_joints(const core_f64::Hand& hand, double closure) {
  std::array<Long3, JOINT_COUNT> joints{};
  const auto& thumb = hand.length[0];
  const auto thumb_points =
      core_f64::thumb_points(hand.frame[0], {thumb[0], thumb[1], thumb[2]}, core_f64::thumb_angles(hand, closure));
  joints[0] = widened(hand.frame[0].base);
  joints[1] = widened(thumb_points.pip);
  joints[2] = widened(thumb_points.dip);
  joints[3] = widened(thumb_points.tip);
  for (std::size_t f = 1; f < FINGER_COUNT; ++f) {
    const auto& frame = hand.frame[f];
    const auto& lengths = hand.length[f];
    const Vec3 mcp = core_f64::segment_end(frame, frame.base, lengths[0], 0);
    const auto points =
        core_f64::finger_points(frame, mcp, {lengths[1], lengths[2], lengths[3]}, core_f64::finger_angles(hand, closure));
    const std::size_t first = finger_start(static_cast<int>(f));
    joints[first] = widened(frame.base);
    joints[first + 1] = widened(mcp);
    joints[first + 2] = widened(points.pip);
    joints[first + 3] = widened(points.dip);
    joints[first + 4] = widened(points.tip);
  }
  return joints;
}

std::string refusal(const HandData& hand) {
  return refusal_line([&] { prepare_hand(hand); });
}

TEST(Hand, JointsFollowTheRotationMatrices) {
  for (std::size_t h = 0; h < HANDS.size(); ++h) {
    HandData unscaled = HANDS[h];
    unscaled.scale = 1;  // core's hand is at scale 1
    const core_f64::Hand hand = ready_hand(HANDS[h]);
    for (const double c : CLOSURES) {
      const auto joints = core_joints(hand, c);
      const auto expected = reference_hand(unscaled, c);
      for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
        EXPECT_LT(length(joints[j] - expected[j]), JOINT_ROUNDING) << HAND_NAMES[h] << ", closure " << c << ", joint " << j;
      }
    }
  }
}

TEST(Hand, OpenPostureOfTheIndexFingerWorkedByHand) {
  // default hand at closure 0, by plane trigonometry: the index finger lies in the plane turned by 8 degrees about +y, and its
  // segments point 0, 4, 16 and 23.2 degrees below its forward direction
  const auto joints = core_joints(ready_hand(paper_hand()), 0);
  const double forward =
      68.12e-3 + 39.78e-3 * std::cos(radians(4)) + 22.38e-3 * std::cos(radians(16)) + 19.66e-3 * std::cos(radians(23.2));
  const double down = 39.78e-3 * std::sin(radians(4)) + 22.38e-3 * std::sin(radians(16)) + 19.66e-3 * std::sin(radians(23.2));
  // Ry(8 degrees) (0, 0, -1) = (-sin 8, 0, -cos 8): towards the thumb side
  EXPECT_NEAR(static_cast<double>(joints[INDEX_TIP][0]), -13e-3 - forward * std::sin(radians(8)), JOINT_ROUNDING);
  EXPECT_NEAR(static_cast<double>(joints[INDEX_TIP][1]), -down, JOINT_ROUNDING);
  EXPECT_NEAR(static_cast<double>(joints[INDEX_TIP][2]), -28e-3 - forward * std::cos(radians(8)), JOINT_ROUNDING);
}

TEST(Hand, MetacarpalBasesAndMcpsDoNotMove) {
  const core_f64::Hand hand = ready_hand(odd_hand());
  const auto open = core_joints(hand, 0), closed = core_joints(hand, 1);
  for (const std::size_t j : {0, 4, 5, 9, 10, 14, 15, 19, 20}) EXPECT_EQ(open[j], closed[j]) << j;
  EXPECT_GT(length(open[1] - closed[1]), 1e-3);  // the thumb's MCP does: abduction
}

TEST(Hand, SegmentsKeepTheirLengths) {
  for (const HandData& data : HANDS) {
    const core_f64::Hand hand = ready_hand(data);
    for (const double c : CLOSURES) {
      const auto joints = core_joints(hand, c);
      for (int f = 0; f < FINGER_COUNT; ++f) {
        const int first = finger_start(f);
        for (int k = 0; k + 1 < finger_joints(f); ++k) {
          EXPECT_NEAR(static_cast<double>(length(joints[first + k + 1] - joints[first + k])), data.fingers[f].segments[k],
                      JOINT_ROUNDING)
              << "closure " << c << ", finger " << f << ", segment " << k;
        }
      }
    }
  }
}

TEST(Hand, AnglesAreLinearInTheClosure) {
  const HandData data = odd_hand();
  const core_f64::Hand hand = ready_hand(data);
  for (const double c : CLOSURES) {
    const Long3 thumb = reference_thumb_angles(data, c), finger = reference_finger_angles(data, c);
    const Vec3 core_thumb = core_f64::thumb_angles(hand, c), core_finger = core_f64::finger_angles(hand, c);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(core_thumb[k], static_cast<double>(thumb[static_cast<std::size_t>(k)]), JOINT_ROUNDING);
      EXPECT_NEAR(core_finger[k], static_cast<double>(finger[static_cast<std::size_t>(k)]), JOINT_ROUNDING);
    }
    EXPECT_NEAR(core_finger.z, data.dip_per_pip * core_finger.y, JOINT_ROUNDING);
  }
}

TEST(Hand, FramesAreOrthonormal) {
  for (const HandData& data : HANDS) {
    const core_f64::Hand hand = ready_hand(data);
    for (const auto& frame : hand.frame) {
      EXPECT_NEAR(glm::length(frame.forward), 1, JOINT_ROUNDING);
      EXPECT_NEAR(glm::length(frame.palmward), 1, JOINT_ROUNDING);
      EXPECT_NEAR(glm::dot(frame.forward, frame.palmward), 0, JOINT_ROUNDING);
    }
  }
}

TEST(Hand, GapOpensTo128Millimeters) {
  const core_f64::Hand hand = ready_hand(paper_hand());
  EXPECT_NEAR(core_f64::gap_at(hand, 0), 0.128, 1e-3);  // 1e-3 m: the specification gives whole millimeters
  EXPECT_EQ(hand.gap_open, core_f64::gap_at(hand, 0));
  EXPECT_EQ(hand.gap_closed, core_f64::gap_at(hand, 1));
}

TEST(Hand, GapClosesUntilThePadsTouch) {
  // the pads touch where the gap is the sum of the tips' radii, 15 mm
  const core_f64::Hand hand = ready_hand(paper_hand());
  EXPECT_LT(hand.gap_closed, hand.radius[0][3] + hand.radius[1][4]);
}

TEST(Hand, GapIsTheDistanceOfTheTips) {
  for (std::size_t h = 0; h < HANDS.size(); ++h) {
    const core_f64::Hand hand = ready_hand(HANDS[h]);
    for (const double c : CLOSURES) {
      const double expected = static_cast<double>(reference_gap(HANDS[h], c)) / HANDS[h].scale;
      EXPECT_NEAR(core_f64::gap_at(hand, c), expected, JOINT_ROUNDING) << HAND_NAMES[h] << " " << c;
      Vec3 slope;
      EXPECT_NEAR(glm::length(core_f64::tip_to_tip(hand, c, slope)), expected, JOINT_ROUNDING);
    }
  }
}

TEST(Hand, GapFallsStrictly) {
  for (std::size_t h = 0; h < HANDS.size(); ++h) {
    const core_f64::Hand hand = ready_hand(HANDS[h]);
    double last = core_f64::gap_at(hand, 0);
    for (int i = 1; i <= 4096; ++i) {
      const double gap = core_f64::gap_at(hand, i / 4096.0);
      ASSERT_LT(gap, last) << HAND_NAMES[h] << ", step " << i;
      last = gap;
    }
  }
}

TEST(Hand, TipToTipPointsFromThumbToIndex) {
  const HandData data = odd_hand();
  const core_f64::Hand hand = ready_hand(data);
  for (const double c : CLOSURES) {
    Vec3 slope;
    const Vec3 line = core_f64::tip_to_tip(hand, c, slope);
    const auto joints = reference_hand(data, c);
    const Long3 expected = (1 / static_cast<long double>(data.scale)) * (joints[INDEX_TIP] - joints[THUMB_TIP]);
    EXPECT_LT(length(widened(line) - expected), JOINT_ROUNDING) << c;
  }
}

TEST(Hand, TipToTipSlopeIsItsDerivative) {
  // central differences with h = 1e-5: h^2 / 6 times the third derivative (under 1 m: lengths 0.1 m, swings of 3 rad at most)
  // plus rounding 1e-16 / h: 2e-11 each
  const double h = 1e-5;
  for (const HandData& data : HANDS) {
    const core_f64::Hand hand = ready_hand(data);
    for (const double c : {h, 0.1, 1.0 / 3, 0.5, 0.75, 1 - h}) {
      Vec3 slope, unused;
      core_f64::tip_to_tip(hand, c, slope);
      const Vec3 difference = (core_f64::tip_to_tip(hand, c + h, unused) - core_f64::tip_to_tip(hand, c - h, unused)) / (2 * h);
      EXPECT_LT(glm::length(slope - difference), 1e-10) << c;
    }
  }
}

TEST(Hand, ClosureOfGapInvertsTheGap) {
  for (std::size_t h = 0; h < HANDS.size(); ++h) {
    const core_f64::Hand hand = ready_hand(HANDS[h]);
    for (int i = 0; i <= 1000; ++i) {
      const double gap = hand.gap_closed + (hand.gap_open - hand.gap_closed) * i / 1000;
      const double c = core_f64::closure_of_gap(hand, gap, STOP_TOLERANCE_F64);
      EXPECT_GE(c, 0);
      EXPECT_LE(c, 1);
      // 1e-9 m: the specification's
      ASSERT_LT(std::abs(core_f64::gap_at(hand, c) - gap), 1e-9) << HAND_NAMES[h] << ", gap " << gap;
    }
  }
}

TEST(Hand, ClosureOfGapHoldsAtBothEnds) {
  for (const HandData& data : HANDS) {
    const core_f64::Hand hand = ready_hand(data);
    EXPECT_LT(std::abs(core_f64::gap_at(hand, core_f64::closure_of_gap(hand, hand.gap_open, STOP_TOLERANCE_F64)) - hand.gap_open),
              1e-9);
    EXPECT_LT(
        std::abs(core_f64::gap_at(hand, core_f64::closure_of_gap(hand, hand.gap_closed, STOP_TOLERANCE_F64)) - hand.gap_closed),
        1e-9);
  }
}

TEST(Hand, ScaleMultipliesEveryLength) {
  // the facade gives the gap with the scene's scale
  const double open = make_core_evaluator(scene_of({beaker1()}))->gap_at(0);
  for (const double scale : {0.1, 3.0}) {
    HandData hand = paper_hand();
    hand.scale = scale;
    const auto evaluator = make_core_evaluator(scene_of({beaker1()}, Pose::articulated, hand));
    EXPECT_NEAR(evaluator->gap_at(0), scale * open, JOINT_ROUNDING);
    EXPECT_NEAR(evaluator->gap_at(0.5), static_cast<double>(reference_gap(hand, 0.5)), JOINT_ROUNDING);
  }
}

TEST(Hand, WhoseGapRisesIsRefusedFromTheStart) {
  HandData hand = paper_hand();
  std::swap(hand.mcp.open, hand.mcp.closed);  // opens as it closes
  EXPECT_NE(refusal(hand), "");
}

TEST(Hand, WhoseGapTurnsIsRefusedWithTheClosureAtWhichItTurns) {
  // a finger that curls on past the thumb: find the first of 1,025 equal steps at which the gap does not fall
  HandData hand = paper_hand();
  hand.mcp.closed = radians(110);
  int turns = 0;
  for (int i = 1; i <= 1024 && turns == 0; ++i) {
    if (!(reference_gap(hand, i / 1024.0L) < reference_gap(hand, (i - 1) / 1024.0L))) turns = i;
  }
  ASSERT_GT(turns, 100);  // neither at the start nor at the end
  ASSERT_LT(turns, 1000);
  const std::string line = refusal(hand);
  ASSERT_NE(line, "");
  // some number of the line is the closure, to the step or the printed digits
  bool named = false;
  for (std::size_t at = line.find_first_of("0123456789"); at != std::string::npos; at = line.find_first_of("0123456789", at)) {
    std::size_t used = 0;
    const double number = std::stod(line.substr(at), &used);
    named = named || std::abs(number - turns / 1024.0) < 2.0 / 1024;
    at += used;
  }
  EXPECT_TRUE(named) << line << " (turns at " << turns / 1024.0 << ")";
}

TEST(Hand, WhoseGapStandsStillIsRefused) {
  HandData hand = paper_hand();  // nothing moves
  for (AngleRange* range : {&hand.thumb_abduction, &hand.thumb_mcp, &hand.thumb_ip, &hand.mcp, &hand.pip})
    range->closed = range->open;
  EXPECT_NE(refusal(hand), "");
}

Long3 joint(const GripResult& result, std::size_t j) { return {result.joints[j][0], result.joints[j][1], result.joints[j][2]}; }

// Positive where the hand is a left one: across the knuckles to the little finger, along the middle finger's metacarpal, and down
// the index finger's curl are a left-handed triple on a right hand.
long double leftness(const GripResult& hand) {
  return dot(cross(joint(hand, 20) - joint(hand, 5), joint(hand, 10) - joint(hand, 9)), joint(hand, 8) - joint(hand, 7));
}

TEST(Hand, LeftHandIsTheRightHandInTheMirroredScene) {
  // mirrored in x, the line d = (cos a cos b, sin b, -sin a cos b) has the azimuth pi - a, and the side d x y of the offset turns
  // over; heights, obliquity and what is above or below stay
  const VesselData vessel = vase();
  const auto right = make_core_evaluator(scene_of({vessel}));
  const auto left = make_core_evaluator(scene_of({vessel}, Pose::articulated, left_hand()));
  int feasible = 0;
  for (const GripInput& grip : sample_grips(vessel, 40, 11)) {
    GripResult ours, theirs;
    left->grip(0, grip, ours);
    right->grip(0, mirrored_grip(grip), theirs);
    ASSERT_EQ(ours.reason, theirs.reason);
    if (ours.reason != Reason::none) continue;
    ++feasible;
    EXPECT_GT(leftness(ours), 0);
    EXPECT_LT(leftness(theirs), 0);
    EXPECT_EQ(ours.touch_mask, theirs.touch_mask);
    for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double sign = k == 0 ? -1 : 1;
        EXPECT_EQ(ours.joints[j][k], sign * theirs.joints[j][k]);
        EXPECT_EQ(ours.posed[j][k], sign * theirs.posed[j][k]);
        EXPECT_EQ(ours.proxies[j][k], sign * theirs.proxies[j][k]);
      }
    }
    // in its own scene: thumb to index along d, through the line of this grip, not of the mirrored one
    const Long3 d = rotation_y(grip.azimuth) * (rotation_z(grip.obliquity) * Long3{1, 0, 0});
    const Long3 side = cross(d, {0, 1, 0});
    const Long3 o = Long3{0, grip.height, 0} + (grip.offset / length(side)) * side;
    const Long3 span = joint(ours, INDEX_TIP) - joint(ours, THUMB_TIP);
    EXPECT_GT(dot(span, d), 0);
    for (const std::size_t tip : {THUMB_TIP, INDEX_TIP}) {
      EXPECT_LT(length(cross(joint(ours, tip) - o, d)), 1e-8);  // the gap's inverse, 1e-9 m, turns the line by as little
    }
  }
  EXPECT_GT(feasible, 20);
}

TEST(Hand, LeftHandTooIsAboveAtRollMinus90) {
  GripInput grip;
  grip.height = 60e-3;
  grip.roll = radians(-90);
  for (const HandData& data : {paper_hand(), left_hand()}) {
    GripResult result;
    make_core_evaluator(scene_of({beaker1()}, Pose::articulated, data))->grip(0, grip, result);
    ASSERT_EQ(result.reason, Reason::none);
    for (const std::size_t base : {0, 4, 9, 14, 19}) EXPECT_GT(result.joints[base][1], grip.height + 20e-3) << base;
  }
}

}  // namespace
}  // namespace wholehand
