// SPDX-License-Identifier: MIT
// From the gripper's own frame to the hand in the world and back.
// sanitizers: address
#include "device/session/workspace.h"
#include "core/vectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/text/error.h"
#include "tests/support/scenes.h"

namespace wholehand::device {
namespace {

using core_f64::Mat3;
using core_f64::Vec3;

constexpr std::array<double, 2> OF_DEVICE{0.001, 0.026}, OF_HAND{0.015, 0.127};
// Rounding of a few products of numbers under 1.
constexpr double CORNER_ROUNDING = 1e-15;

Mat3 turn(Random& random) {
  const double a = random.uniform(-PI, PI), b = random.uniform(-PI, PI), c = random.uniform(-PI, PI);
  const Mat3 x(1, 0, 0, 0, std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a));
  const Mat3 y(std::cos(b), 0, -std::sin(b), 0, 1, 0, std::sin(b), 0, std::cos(b));
  const Mat3 z(std::cos(c), std::sin(c), 0, -std::sin(c), std::cos(c), 0, 0, 0, 1);
  return x * y * z;
}

double difference(const Mat3& a, const Mat3& b) {
  double largest = 0;
  for (int k = 0; k < 3; ++k) largest = std::max(largest, glm::length(a[k] - b[k]));
  return largest;
}

GripperState state_of(Vec3 position, const Mat3& rotation, double gap, bool clutch = false) {
  GripperState state;
  state.position = to_triple(position);
  state.rotation = to_rotation(rotation);
  state.gap = gap;
  state.buttons = clutch ? 4u : 0u;
  return state;
}

Scene plain() { return scene_of({beaker1()}); }

TEST(Workspace, RotationsGoThereAndBack) {
  Random random(1);
  for (int k = 0; k < 20; ++k) {
    const Mat3 m = turn(random);
    const wholehand::Rotation r = to_rotation(m);
    EXPECT_EQ(to_mat3(r), m);
    const Vec3 v(1, 2, 3);
    // row-major: the first row times v
    EXPECT_NEAR((m * v).x, r[0] * 1 + r[1] * 2 + r[2] * 3, CORNER_ROUNDING * 10);
    // the first column is the first axis
    EXPECT_EQ((m * Vec3(1, 0, 0)), Vec3(r[0], r[3], r[6]));
  }
}

TEST(Workspace, AsItIsWithoutAnyMapping) {
  Random random(2);
  Workspace workspace(plain(), OF_DEVICE, OF_HAND);
  for (int k = 0; k < 50; ++k) {
    const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Mat3 m = turn(random);
    const HandPose pose = workspace.map(state_of(p, m, 0.02));
    EXPECT_LT(glm::length(pose.middle - p), CORNER_ROUNDING);
    EXPECT_LT(difference(pose.rotation, m), CORNER_ROUNDING);
  }
}

// The gap's ends to the hand's ends, the middle to the middle, and beyond its ends nothing more.
TEST(Workspace, MapsTheGapLinearly) {
  Workspace workspace(plain(), OF_DEVICE, OF_HAND);
  const auto gap = [&](double device) { return workspace.map(state_of(Vec3(0), Mat3(1), device)).gap; };
  EXPECT_EQ(gap(OF_DEVICE[0]), OF_HAND[0]);
  EXPECT_NEAR(gap(OF_DEVICE[1]), OF_HAND[1], CORNER_ROUNDING);
  EXPECT_LE(gap(OF_DEVICE[1]), OF_HAND[1]);
  EXPECT_NEAR(gap(0.5 * (OF_DEVICE[0] + OF_DEVICE[1])), 0.5 * (OF_HAND[0] + OF_HAND[1]), CORNER_ROUNDING);
  EXPECT_EQ(gap(-1), OF_HAND[0]);
  EXPECT_NEAR(gap(1), OF_HAND[1], CORNER_ROUNDING);
  EXPECT_NEAR(workspace.gap_slope(), (OF_HAND[1] - OF_HAND[0]) / (OF_DEVICE[1] - OF_DEVICE[0]), CORNER_ROUNDING * 10);
}

TEST(Workspace, TheScenesGapComesFirst) {
  Scene scene = plain();
  scene.device.gap = {0.01, 0.11};
  scene.device.has_gap = true;
  Workspace workspace(scene, {0, 0}, OF_HAND);  // the device reports none
  EXPECT_EQ(workspace.device_gap(), (std::array<double, 2>{0.01, 0.11}));
  EXPECT_EQ(workspace.map(state_of(Vec3(0), Mat3(1), 0.01)).gap, OF_HAND[0]);
}

TEST(Workspace, RefusesAGapThatIsNoRange) {
  for (const std::array<double, 2>& gap : {std::array<double, 2>{0, 0}, {0.02, 0.01}, {0, Tick::NONE}}) {
    EXPECT_THROW(Workspace(plain(), gap, OF_HAND), Error);
  }
}

// Axes of the device named in the world's: each of its axes lies along the named one, and a turn about it becomes a turn about that.
TEST(Workspace, FollowsTheAxesAndTheScale) {
  Scene scene = plain();
  scene.device.axes = {"-z", "x", "-y"};
  scene.device.origin = {0.1, 0.2, 0.3};
  scene.device.workspace_scale = 2.5;
  Workspace workspace(scene, OF_DEVICE, OF_HAND);
  const std::array<Vec3, 3> along{Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0)};
  for (int k = 0; k < 3; ++k) {
    Vec3 axis(0);
    axis[k] = 0.04;
    EXPECT_LT(glm::length(workspace.map(state_of(axis, Mat3(1), 0.02)).middle - (Vec3(0.1, 0.2, 0.3) + 0.1 * along[k])),
              CORNER_ROUNDING);
    // a force along an axis of the world is felt along the device's axis that lies there
    EXPECT_LT(glm::length(to_vec3(workspace.to_device(3.0 * along[k])) - 75.0 * axis), CORNER_ROUNDING * 10);
  }
  // the gripper's axes go where the device's frame takes them: its closing line, moved along itself, stays on itself
  const double c = std::cos(0.3), s = std::sin(0.3);
  const Mat3 about_x(1, 0, 0, 0, c, s, 0, -s, c), about_z(c, s, 0, -s, c, 0, 0, 0, 1);
  for (const Mat3& turn : {Mat3(1), about_x, about_z, about_x * about_z}) {
    const HandPose here = workspace.map(state_of(Vec3(0), turn, 0.02)), there = workspace.map(state_of(0.01 * turn[0], turn, 0.02));
    EXPECT_LT(glm::length((there.middle - here.middle) / 0.025 - here.rotation[0]), 1e-12);
    for (int k = 0; k < 3; ++k) {
      const Vec3 expected = turn[k].x * along[0] + turn[k].y * along[1] + turn[k].z * along[2];
      EXPECT_LT(glm::length(here.rotation[k] - expected), CORNER_ROUNDING);
    }
  }
}

// Power at the device is power at the hand, but for the workspace's scale: the way back is the transpose of the way there.
TEST(Workspace, ForcesDoTheSameWork) {
  for (const Handedness side : {Handedness::right, Handedness::left}) {
    Scene scene = plain();
    scene.hand.handedness = side;
    scene.device.axes = {"y", "-z", "-x"};
    scene.device.workspace_scale = 3;
    Workspace workspace(scene, OF_DEVICE, OF_HAND);
    Random random(5);
    for (int k = 0; k < 30; ++k) {
      const Vec3 a(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
          b(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
          force(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Vec3 moved = workspace.map(state_of(a, Mat3(1), 0.02)).middle - workspace.map(state_of(b, Mat3(1), 0.02)).middle;
      EXPECT_NEAR(3 * glm::dot(to_vec3(workspace.to_device(force)), a - b), glm::dot(force, moved), CORNER_ROUNDING * 30);
    }
  }
}

// The hand stays where it is while the button is pressed, and goes on from there, as often as one likes; its turn and gap are free.
TEST(Workspace, TheClutchHoldsTheHand) {
  Scene scene = plain();
  scene.device.clutch_button = 2;
  scene.device.workspace_scale = 2;
  Workspace workspace(scene, OF_DEVICE, OF_HAND);
  Random random(6);
  Vec3 device(0), hand = workspace.map(state_of(device, Mat3(1), 0.02)).middle;
  for (int n = 0; n < 300; ++n) {
    const bool pressed = n % 30 >= 20;
    const Vec3 step(random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3));
    // the tick at which it is pressed still goes along; that at which it is let go does not jump
    if (!pressed || n % 30 == 20) hand += 2.0 * step;
    device += step;
    const HandPose pose = workspace.map(state_of(device, Mat3(1), n % 2 ? 0.02 : 0.01, pressed));
    EXPECT_EQ(workspace.is_clutched(), pressed);
    EXPECT_LT(glm::length(pose.middle - hand), CORNER_ROUNDING * 1000) << n;
    EXPECT_NE(pose.gap, workspace.map(state_of(device, Mat3(1), n % 2 ? 0.01 : 0.02, pressed)).gap);
  }
}

TEST(Workspace, WithoutAClutchNoButtonCounts) {
  Workspace workspace(plain(), OF_DEVICE, OF_HAND);
  GripperState state = state_of(Vec3(0), Mat3(1), 0.02);
  state.buttons = 0xFFFFFFFFu;
  workspace.map(state);
  EXPECT_FALSE(workspace.is_clutched());
}

// A left hand is moved as the right hand of the mirrored world: mirrored places and turns give the right hand's.
TEST(Workspace, ALeftHandIsTheRightHandOfTheMirroredWorld) {
  Scene left = plain();
  left.hand.handedness = Handedness::left;
  left.device.origin = {-0.1, 0.2, 0.3};
  Scene right = plain();
  right.device.origin = {0.1, 0.2, 0.3};
  Workspace a(left, OF_DEVICE, OF_HAND), b(right, OF_DEVICE, OF_HAND);
  const Mat3 mirror(-1, 0, 0, 0, 1, 0, 0, 0, 1);
  Random random(7);
  for (int k = 0; k < 30; ++k) {
    const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Mat3 m = turn(random);
    const HandPose of_left = a.map(state_of(mirror * p, mirror * m * mirror, 0.02)), of_right = b.map(state_of(p, m, 0.02));
    EXPECT_LT(glm::length(of_left.middle - of_right.middle), CORNER_ROUNDING);
    EXPECT_LT(difference(of_left.rotation, of_right.rotation), CORNER_ROUNDING);
    EXPECT_LT(glm::length(to_vec3(a.to_device(p)) - mirror * to_vec3(b.to_device(p))), CORNER_ROUNDING);
    EXPECT_EQ(a.mirror()(a.mirror()(p)), p);
    EXPECT_LT(difference(a.mirror()(a.mirror()(m)), m), CORNER_ROUNDING);
  }
}

TEST(CouplingSlope, IsTheLargerOfArmAndGap) {
  EXPECT_EQ(coupling_slope(1, 1), 2);
  EXPECT_EQ(coupling_slope(0.5, 4.5), 4.5);
}

}  // namespace
}  // namespace wholehand::device
