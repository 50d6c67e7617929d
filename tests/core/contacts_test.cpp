// SPDX-License-Identifier: MIT
// Kernel 9: where the posed hand presses.
#include "core/contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/evaluator.h"
#include "core/joints.h"
#include "core/mirror.h"
#include "core/vectors.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

using core_f64::Vec3;

// A hand whose joints are all at one height outside a cylinder of 40 mm, one every 15 degrees.
std::array<Vec3, JOINTS> ring_of_joints(double radius, double height) {
  std::array<Vec3, JOINTS> posed;
  for (int j = 0; j < JOINTS; ++j) {
    const double angle = radians(15.0 * j);
    posed[j] = {radius * std::cos(angle), height, radius * std::sin(angle)};
  }
  return posed;
}

// Radially in, at the wall; metacarpal bases are the palm's.
TEST(Contacts, LieOnTheWallAlongTheInwardNormal) {
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  for (const double radius : {48e-3, 39e-3}) {  // clear of it and inside
    std::array<core_f64::PressingJoint, JOINTS> pressing;
    ASSERT_EQ(core_f64::find_contacts(vessel, ring_of_joints(radius, 50e-3), (1u << JOINTS) - 1, pressing), JOINTS);
    for (int j = 0; j < JOINTS; ++j) {
      EXPECT_EQ(pressing[j].joint, j);
      const Vec3 outward(std::cos(radians(15.0 * j)), 0, std::sin(radians(15.0 * j)));
      EXPECT_LT(glm::distance(pressing[j].contact.place, 40e-3 * outward + Vec3(0, 50e-3, 0)), 1e-15);
      EXPECT_LT(glm::distance(pressing[j].contact.normal, -outward), 1e-15);
      const bool is_base = j == 0 || j == 4 || j == 9 || j == 14 || j == 19;
      EXPECT_EQ(pressing[j].contact.digit, is_base ? core_f64::PALM : finger_of(j));
    }
  }
}

TEST(Contacts, AreThoseOfTheTouchMask) {
  const core_f64::Vessel vessel = ready_vessel(beaker1());
  std::array<core_f64::PressingJoint, JOINTS> pressing;
  ASSERT_EQ(core_f64::find_contacts(vessel, ring_of_joints(48e-3, 50e-3), 1u << 3 | 1u << 8 | 1u << 23, pressing), 3);
  EXPECT_EQ(pressing[0].joint, 3);
  EXPECT_EQ(pressing[1].joint, 8);
  EXPECT_EQ(pressing[2].joint, 23);
  EXPECT_EQ(core_f64::find_contacts(vessel, ring_of_joints(48e-3, 50e-3), 0, pressing), 0);
}

// There is no glass at the mouth, so nothing presses there. A shell has a rim there, and its wall takes a contact.
TEST(Contacts, NothingPressesOnTheMouth) {
  std::array<core_f64::PressingJoint, JOINTS> pressing;
  const auto above = ring_of_joints(20e-3, 118e-3);
  EXPECT_EQ(core_f64::find_contacts(ready_vessel(beaker1()), above, 1u << 3, pressing), 0);
  EXPECT_EQ(core_f64::find_contacts(ready_vessel(shell_of(beaker1())), above, 1u << 3, pressing), 1);
  EXPECT_EQ(core_f64::find_contacts(ready_vessel(beaker1()), ring_of_joints(20e-3, -8e-3), 1u << 3, pressing), 1)
      << "below the base";
}

// Contacts of a whole grip, by the evaluator: each lies on the surface, and its normal is that of the distance; a left hand's mirror a
// right hand's.
TEST(Contacts, OfAGripLieOnItsVessel) {
  Scene scene = three_beakers(), left = scene;
  left.hand.handedness = Handedness::left;
  const auto evaluator = make_core_evaluator(scene), other = make_core_evaluator(left);
  for (std::size_t vessel = 0; vessel < scene.vessels.size(); ++vessel) {
    GripInput grip;
    grip.height = 0.5 * scene.vessels[vessel].height;
    grip.azimuth = 0.3;
    GripResult result, mirror;
    evaluator->grip(vessel, grip, result);
    other->grip(vessel, grip, mirror);
    if (result.reason != Reason::none) continue;
    const auto contacts = evaluator->contacts(vessel, result);
    ASSERT_GE(contacts.size(), 2u);
    for (const GripContact& contact : contacts) {
      EXPECT_NEAR(evaluator->distance(vessel, contact.point), 0, 1e-12);
      const Triple outward = evaluator->gradient(vessel, result.posed[contact.joint]);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(contact.normal[k], -outward[k]);
    }
  }
  // the mirrored grip, by the left hand
  GripInput grip;
  grip.height = 0.05;
  GripResult result, mirror;
  evaluator->grip(0, grip, result);
  other->grip(0, mirrored(grip, Handedness::left), mirror);
  const auto rights = evaluator->contacts(0, result), lefts = other->contacts(0, mirror);
  ASSERT_EQ(rights.size(), lefts.size());
  for (std::size_t k = 0; k < rights.size(); ++k) {
    EXPECT_NEAR(lefts[k].point[0], -rights[k].point[0], 1e-12);
    EXPECT_NEAR(lefts[k].point[1], rights[k].point[1], 1e-12);
    EXPECT_NEAR(lefts[k].normal[0], -rights[k].normal[0], 1e-12);
  }
}

}  // namespace
}  // namespace wholehand
