// SPDX-License-Identifier: MIT
// The hand as nodes: names, positions and OpenXR's orientations against the rotation matrices of the specification, for either
// hand.
// sanitizers: address
#include "sweeps/grips/hand_nodes.h"
#include "core/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "core/evaluator.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

LongRotation rotation_of(const Quaternion& q) {
  const long double x = q[0], y = q[1], z = q[2], w = q[3];
  return {Long3{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
          Long3{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
          Long3{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
}

Long3 long_of(const Triple& p) { return {p[0], p[1], p[2]}; }
Long3 column(const LongRotation& m, int k) { return {m[0][k], m[1][k], m[2][k]}; }
Long3 apart(const Triple& a, const Triple& b) { return long_of(b) - long_of(a); }

struct HeldHand {
  Scene scene;
  GripInput grip;
  GripResult result;
};

HeldHand held(const HandData& hand, Pose pose, const GripInput& grip) {
  HeldHand held{scene_of({beaker1()}, pose, hand), grip, {}};
  make_core_evaluator(held.scene)->grip(0, grip, held.result);
  EXPECT_EQ(held.result.reason, Reason::none);
  return held;
}

const GripInput SHOWN_GRIP{0.055, 0.6, 0.15, -0.4, 0.004, 1.02};

// Rotations of the joints in the hand frame as the specification chains them. A thumb bends towards its +y, so its nail is at -y.
LongRotation reference_rotation(const HandData& hand, int finger, int joint, long double closure) {
  const Long3 angles = finger == 0 ? reference_thumb_angles(hand, closure) : reference_finger_angles(hand, closure);
  const FingerData& data = hand.fingers[finger];
  const int bone = std::min(joint, finger_joints(finger) - 2);  // a tip has that of its last bone
  if (finger == 0) {
    LongRotation r = rotation_y(data.splay) * rotation_x(-angles[0]);
    for (int k = 1; k <= bone; ++k) r = r * rotation_x(angles[k]);
    return r * rotation_z(PI);
  }
  LongRotation r = rotation_y(-data.splay) * rotation_x(-data.arch);
  for (int k = 1; k <= bone; ++k) r = r * rotation_x(-angles[k - 1]);
  return r;
}

void expect_as_specified(const HandData& hand) {
  const HeldHand h = held(hand, Pose::rigged, SHOWN_GRIP);
  const HandNodes nodes = hand_nodes(hand, h.grip, h.result);
  const LongRotation wrist = rotation_of(nodes.wrist.rotation);
  const long double side = hand.handedness == Handedness::left ? -1 : 1;
  const LongRotation mirror{Long3{side, 0, 0}, Long3{0, 1, 0}, Long3{0, 0, 1}};
  for (int f = 0; f < FINGER_COUNT; ++f) {
    const std::vector<Long3> joints = reference_finger(
        hand, f, f == 0 ? reference_thumb_angles(hand, h.result.closure) : reference_finger_angles(hand, h.result.closure));
    for (int k = 0; k < finger_joints(f); ++k) {
      const int j = finger_start(f) + k;
      // the closure is solved to 1e-9 m of the gap
      const Long3 there = long_of(nodes.wrist.position) + wrist * (mirror * ((long double)(SHOWN_GRIP.hand_scale) * joints[k]));
      EXPECT_LT(length(there - long_of(nodes.joints[j].position)), 1e-8L) << nodes.joints[j].name;
      EXPECT_EQ(nodes.joints[j].position, h.result.posed[j]);
      const LongRotation expected = wrist * (mirror * reference_rotation(hand, f, k, h.result.closure) * mirror);
      for (int axis = 0; axis < 3; ++axis) {
        // 1e-9 m over the shortest bone of 1 cm
        EXPECT_LT(length(column(rotation_of(nodes.joints[j].rotation), axis) - column(expected, axis)), 1e-6L)
            << nodes.joints[j].name << " axis " << axis;
      }
      EXPECT_DOUBLE_EQ(nodes.joints[j].radius, hand.scale * SHOWN_GRIP.hand_scale * hand.fingers[f].radii[k]);
    }
  }
}

TEST(HandNodes, RightHandIsTheChainOfTheSpecification) { expect_as_specified({}); }
TEST(HandNodes, LeftHandIsItsMirrorImage) { expect_as_specified(left_hand()); }

TEST(HandNodes, HandOfOtherNumbersToo) {
  HandData hand = paper_hand();
  hand.scale = 1.1;
  hand.handedness = Handedness::left;
  hand.fingers[2].splay = 0.05;
  hand.fingers[4].arch = 0.3;
  hand.fingers[0].radii = {9e-3, 8.5e-3, 8e-3, 7.5e-3, 0};
  expect_as_specified(hand);
}

// What the bones of a posed hand say of it, whatever the pose.
TEST(HandNodes, PosedBonesRunAlongMinusZWithTheBackUp) {
  for (const Pose pose : {Pose::articulated, Pose::paper}) {
    for (const HandData& hand : {paper_hand(), left_hand()}) {
      const HeldHand h = held(hand, pose, SHOWN_GRIP);
      const HandNodes nodes = hand_nodes(hand, h.grip, h.result);
      const Long3 palm_to_back = column(rotation_of(nodes.wrist.rotation), 1);
      for (int f = 0; f < FINGER_COUNT; ++f) {
        for (int k = 0; k + 1 < finger_joints(f); ++k) {
          const int j = finger_start(f) + k;
          const LongRotation r = rotation_of(nodes.joints[j].rotation);
          const Long3 bone = apart(h.result.posed[j], h.result.posed[j + 1]);
          EXPECT_NEAR((double)(dot(bone, column(r, 2)) / length(bone)), -1, 1e-12) << nodes.joints[j].name;
          EXPECT_NEAR((double)dot(cross(column(r, 0), column(r, 1)), column(r, 2)), 1, 1e-12);  // right-handed
          if (k + 2 < finger_joints(f) && pose == Pose::articulated) {
            // it bends towards the pad
            const Long3 next = apart(h.result.posed[j + 1], h.result.posed[j + 2]);
            EXPECT_LT(dot(next, column(r, 1)), 1e-9L) << nodes.joints[j].name;
          }
        }
        if (f > 0) {
          const LongRotation r = rotation_of(nodes.joints[finger_start(f)].rotation);
          EXPECT_GT(dot(palm_to_back, column(r, 1)), 0.9L);
        }
        const int tip = finger_start(f) + finger_joints(f) - 1;
        EXPECT_EQ(nodes.joints[tip].rotation, nodes.joints[tip - 1].rotation);
      }
    }
  }
}

TEST(HandNodes, NamesAreThoseOfHandRigs) {
  const HeldHand h = held({}, Pose::articulated, SHOWN_GRIP);
  const HandNodes nodes = hand_nodes({}, h.grip, h.result);
  EXPECT_STREQ(nodes.wrist.name, "wrist");
  EXPECT_STREQ(nodes.joints[0].name, "thumb-metacarpal");
  EXPECT_STREQ(nodes.joints[2].name, "thumb-phalanx-distal");
  EXPECT_STREQ(nodes.joints[6].name, "index-finger-phalanx-intermediate");
  EXPECT_STREQ(nodes.joints[23].name, "pinky-finger-tip");
  EXPECT_STREQ(nodes.joints[23].openxr, "XR_HAND_JOINT_LITTLE_TIP_EXT");
  std::set<std::string> names, openxr;
  for (int f = 0; f < FINGER_COUNT; ++f) {
    for (int k = 0; k < finger_joints(f); ++k) {
      const HandNode& node = nodes.joints[finger_start(f) + k];
      names.insert(node.name);
      openxr.insert(node.openxr);
      EXPECT_EQ(node.parent, k == 0 ? -1 : finger_start(f) + k - 1);
    }
  }
  EXPECT_EQ(names.size(), 24u);
  EXPECT_EQ(openxr.size(), 24u);
}

TEST(HandNodes, AChildsPlaceIsThatInItsParent) {
  const HeldHand h = held(left_hand(), Pose::articulated, SHOWN_GRIP);
  const HandNodes nodes = hand_nodes(h.scene.hand, h.grip, h.result);
  const HandNode &a = nodes.joints[10], &b = nodes.joints[11];
  const Triple within = relative_position(a, b.position);
  EXPECT_NEAR(within[0], 0, 1e-15);
  EXPECT_NEAR(within[1], 0, 1e-15);
  EXPECT_LT(within[2], -0.01);  // along its bone
  const LongRotation whole = rotation_of(a.rotation) * rotation_of(relative_rotation(a, b.rotation));
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(length(column(whole, axis) - column(rotation_of(b.rotation), axis)), 1e-14L);
}

}  // namespace
}  // namespace wholehand::sweeps
