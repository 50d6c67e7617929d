// SPDX-License-Identifier: MIT
#include "core/joint_names.h"

#include <gtest/gtest.h>

#include "core/joints.h"

namespace wholehand {
namespace {

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
