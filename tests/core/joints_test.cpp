// SPDX-License-Identifier: MIT
#include "core/joints.h"

#include <gtest/gtest.h>

#include <array>

#include "core/scene.h"
#include "shaders/layout.h"

namespace wholehand {
namespace {

TEST(Joints, AreNumberedFingerByFinger) {
  constexpr std::array<int, JOINT_COUNT> FINGER_OF_JOINT{0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4};
  constexpr std::array<int, FINGER_COUNT> START{0, 4, 9, 14, 19}, COUNT{4, 5, 5, 5, 5};
  for (int j = 0; j < JOINT_COUNT; ++j) EXPECT_EQ(finger_of(j), FINGER_OF_JOINT[static_cast<std::size_t>(j)]) << j;
  for (int f = 0; f < FINGER_COUNT; ++f) {
    EXPECT_EQ(finger_start(f), START[static_cast<std::size_t>(f)]);
    EXPECT_EQ(finger_joints(f), COUNT[static_cast<std::size_t>(f)]);
  }
  EXPECT_EQ(THUMB_TIP, finger_start(0) + finger_joints(0) - 1);
  EXPECT_EQ(INDEX_TIP, finger_start(1) + finger_joints(1) - 1);
}

TEST(JointNames, AreThoseOfTheJoint) {
  EXPECT_EQ(joint_key(2), "thumb_ip");
  EXPECT_EQ(joint_key(7), "index_dip");
  EXPECT_EQ(joint_key(23), "little_tip");
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const int finger = finger_of(j), k = j - finger_start(finger);
    EXPECT_TRUE(joint_key(j).starts_with(FINGER_NAMES[finger])) << j;
    for (const char* name : {JOINT_NAMES[j].paper, JOINT_NAMES[j].webxr})
      EXPECT_EQ(std::string(name).ends_with("tip"), k == finger_joints(finger) - 1) << name;
    EXPECT_EQ(std::string(JOINT_NAMES[j].openxr).ends_with("METACARPAL_EXT"), k == 0) << j;
  }
}

}  // namespace
}  // namespace wholehand
