// SPDX-License-Identifier: MIT
// The six numbers of the grip that a hand has: what a grip's own tips and axes give back.
// sanitizers: address
#include "device/advice/present_grip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/evaluator.h"
#include "core/mirror.h"
#include "core/vectors.h"
#include "device/session/grip_of_tips.h"
#include "tests/support/live_script.h"
#include "tests/support/scenes.h"
#include "tests/support/session_play.h"

namespace wholehand::device {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

Mat3 about(Vec3 axis, double angle) { return Mat3(glm::rotate(glm::dmat4(1), angle, axis)); }

// The gripper's axes of a grip, as device/simulated/sim_user turns them: the line about up and off the level, the hand about the line.
Mat3 axes_of(const GripInput& grip) {
  return about({0, 1, 0}, grip.azimuth) * about({0, 0, 1}, grip.obliquity) * about({1, 0, 0}, grip.roll);
}

void expect_same(const GripInput& found, const GripInput& grip) {
  EXPECT_NEAR(found.height, grip.height, 1e-12);
  EXPECT_NEAR(found.azimuth, grip.azimuth, 1e-12);
  EXPECT_NEAR(found.obliquity, grip.obliquity, 1e-12);
  EXPECT_NEAR(found.roll, grip.roll, 1e-12);
  EXPECT_NEAR(found.offset, grip.offset, 1e-12);
}

TEST(PresentGrip, IsTheGripWhoseTipsTheyAre) {
  for (const GripInput& grip : {GripInput{0.06, 0, 0, 0, 0, 1}, GripInput{0.06, 0.4, 0.2, -0.9, 0.01, 1},
                                GripInput{0.02, -2.5, -0.3, 0.5, -0.02, 1}, GripInput{0.09, 3.0, 0.1, -1.2, 0.003, 1}}) {
    const Vec3 d = core_f64::grip_direction(grip.azimuth, grip.obliquity);
    const Vec3 aside = Vec3(-d.z, 0, d.x) / std::hypot(d.x, d.z);
    const Vec3 origin = Vec3(0, grip.height, 0) + grip.offset * aside;
    const auto found = grip_of_tips({origin - 0.03 * d, origin + 0.05 * d}, axes_of(grip));
    ASSERT_TRUE(found);
    expect_same(*found, grip);
  }
}

// The core closes a hand at the grip's numbers: its tips are those of the same grip.
TEST(PresentGrip, OfTheCoresOwnTipsIsThatGrip) {
  const Scene scene = scene_of({beaker1()});
  const auto core = make_core_evaluator(scene);
  const GripInput grip{0.06, 0.3, 0.1, -0.6, 0.004, 1};
  GripResult result;
  core->grip(0, grip, result);
  ASSERT_EQ(result.reason, Reason::none);
  const auto found = grip_of_tips({to_vec3(result.joints[3]), to_vec3(result.joints[8])}, axes_of(grip));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->height, grip.height, 1e-6);  // the joints end where the closure's solve ends
  EXPECT_NEAR(found->obliquity, grip.obliquity, 1e-6);
  EXPECT_NEAR(found->offset, grip.offset, 1e-6);
}

TEST(PresentGrip, IsNoneOfALineAlongTheAxis) { EXPECT_FALSE(grip_of_tips({Vec3(0, 0.01, 0), Vec3(0, 0.05, 0)}, Mat3(1))); }

// The approach follows a played session: near, then held at the height that the script has.
TEST(Approach, FollowsASession) {
  const Scene scene = live_scene();
  const LiveScene live(scene);
  LiveScript script;
  script.vessel = scene.vessels[0].place;
  VesselTracker tracker(scene);
  bool was_near = false, was_held = false;
  for (const Tick& tick : play_session(scene, script_for(scene))) {
    tracker.follow(tick);
    const auto approach = approach_of(live, tick, tracker.poses());
    if (!is_held(tick.state)) {
      was_near = was_near || approach;
      continue;
    }
    was_held = true;
    ASSERT_TRUE(approach);
    EXPECT_TRUE(approach->is_held);
    EXPECT_EQ(approach->vessel, 0);
    EXPECT_NEAR(approach->grip.height, tick.grasp_height, 1e-9);  // it goes with the vessel
  }
  EXPECT_TRUE(was_near && was_held);
}

// A left hand whose every tip and turn is the mirror of a right one has the mirrored grip.
TEST(Approach, OfALeftHandIsTheMirroredGrip) {
  Scene scene = live_scene();
  const LiveScene right(scene);
  scene.hand.handedness = Handedness::left;
  const LiveScene left(scene);
  VesselPoses poses = VesselTracker(scene).poses();
  poses[0].place = {0, 0, 0};  // so that it is its own mirror
  Tick tick;
  const GripInput grip{0.06, 0.3, 0.1, -0.6, 0.004, 1};
  const Vec3 d = core_f64::grip_direction(grip.azimuth, grip.obliquity), aside(std::sin(grip.azimuth), 0, std::cos(grip.azimuth));
  const Vec3 origin = Vec3(0, grip.height, 0) + grip.offset * aside;
  tick.proxies = {to_triple(origin - 0.05 * d), to_triple(origin + 0.05 * d)};
  tick.hand_rotation = to_rotation(axes_of(grip));
  const auto of_right = approach_of(right, tick, poses);
  ASSERT_TRUE(of_right);
  expect_same(of_right->grip, grip);
  for (Triple& proxy : tick.proxies) proxy = mirrored(proxy, Handedness::left);
  tick.hand_rotation = to_rotation(mirrored(axes_of(grip), Handedness::left));
  const auto of_left = approach_of(left, tick, poses);
  ASSERT_TRUE(of_left);
  expect_same(of_left->grip, mirrored(grip, Handedness::left));
}

}  // namespace
}  // namespace wholehand::device
