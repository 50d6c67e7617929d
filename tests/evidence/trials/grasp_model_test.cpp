// SPDX-License-Identifier: MIT
// The hand as the engine takes it: its joints can do what the strength of its digits asks of them, and not much more.
#include "evidence/trials/grasp_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/joints.h"
#include "core/prepare.h"
#include "core/vectors.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::ContactForce;
using core_f64::Vec3;

class ArticulatedHand : public testing::Test {
 protected:
  ArticulatedHand() {
    const GripInput grip{0.0942827124, 0, 0.250430391, 0.172007776, 0, 1};  // a beaker with the whole hand
    const auto evaluator = make_core_evaluator(scene_);
    evaluator->grip(0, grip, result_);
    for (const GripContact& found : evaluator->contacts(0, result_)) {
      contacts_.points.push_back({to_vec3(found.point), to_vec3(found.normal), found.digit});
      contacts_.joints.push_back(found.joint);
      contacts_.between.push_back(found.between);
    }
    contacts_.strength = {0.6, 5e-3, scene_.strength.value_or(StrengthData{}).digits};
  }
  GraspModel model() const {
    const PreparedHand hand = prepare_hand(scene_.hand);
    return articulated_hand(hand, scene_.hand, result_.joints, result_.posed, scene_.hand.scale, contacts_);
  }
  // The force of full strength on the edge of the cone that is of most use along a direction.
  ContactForce strongest(std::size_t contact, const Vec3& force, double torsion) const {
    const auto& [place, normal, digit, is_tip] = contacts_.points[contact];
    const double strength = contacts_.strength.digits[static_cast<std::size_t>(digit)], mu = contacts_.strength.friction;
    const Vec3 along = force - glm::dot(force, normal) * normal;
    const double twist = contacts_.strength.torsion * torsion, size = std::hypot(glm::length(along), twist);
    if (!(size > 0)) return {strength * normal, 0};
    return {strength * (normal + mu / size * along), strength * mu / size * twist * contacts_.strength.torsion};
  }

  Scene scene_ = three_beakers();
  GripResult result_;
  GraspContacts contacts_;
};

// One contact of a digit at a time at its full strength, the most that a joint can be asked for; and within a fifth of what is
// there for the outermost one.
TEST_F(ArticulatedHand, ItsJointsCanDoWhatTheStrengthAsksFor) {
  const GraspModel hand = model();
  ASSERT_GT(hand.contacts, 4u);
  double fullest = 0;
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const GraspJoint& joint = hand.joints[j];
    EXPECT_GT(joint.most, 0);
    for (std::size_t i = 0; i < hand.contacts; ++i) {
      const GraspModel::Lever& lever = hand.levers[j * hand.contacts + i];
      for (const double sense : {-1.0, 1.0}) {
        std::vector<ContactForce> forces(hand.contacts);
        forces[i] = strongest(i, sense * lever.force, sense * lever.torsion);
        const double torque = std::abs(hand.drives(forces)[j]);
        EXPECT_LE(torque, (1 + 1e-9) * joint.most) << "joint " << j << ", contact " << i;
        fullest = std::max(fullest, torque / joint.most);
      }
    }
  }
  EXPECT_GT(fullest, 0.8);
}

// No point that a joint moves goes faster than `reach` times its rate.
TEST_F(ArticulatedHand, AJointReachesItsFingertip) {
  const GraspModel hand = model();
  std::size_t j = 0;
  for (int finger = 0; finger < FINGER_COUNT; ++finger) {
    const auto place = [&](int k) { return to_vec3(result_.posed[static_cast<std::size_t>(finger_start(finger) + k)]); };
    const int bones = finger_joints(finger) - 1;
    for (int bone = finger == 0 ? 0 : 1; bone < bones; ++bone, ++j) {
      double way = 0;
      for (int k = bone; k < bones; ++k) way += glm::distance(place(k), place(k + 1));
      EXPECT_GE(hand.joints[j].reach, way + scene_.hand.fingers[static_cast<std::size_t>(finger)].radii.back());
    }
  }
  EXPECT_EQ(j, hand.joints.size());
}

}  // namespace
}  // namespace wholehand
