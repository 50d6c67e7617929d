// SPDX-License-Identifier: MIT
// omega.7 and sigma.7 against a stand-in for Force Dimension's SDK: limits, forces, what is read and what cannot be.
#include "device/grippers/omega_gripper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/omega_fixture.h"

namespace wholehand::device {
namespace {

TEST(DhdFrames, AxesChangeNamesOnly) {
  // towards the person, to the right, up
  EXPECT_EQ(from_dhd({1, 0, 0}), (Triple{0, 0, 1}));
  EXPECT_EQ(from_dhd({0, 1, 0}), (Triple{1, 0, 0}));
  EXPECT_EQ(from_dhd({0, 0, 1}), (Triple{0, 1, 0}));
  EXPECT_EQ(to_dhd(from_dhd({1, 2, 3})), (Triple{1, 2, 3}));
  const double straight[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(rotation_from_dhd(straight), NO_ROTATION);
  // a quarter turn about up, counter-clockwise from above: what pointed to the right then points away from the person
  const double turned[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
  const Rotation rotation = rotation_from_dhd(turned);
  EXPECT_EQ((Triple{rotation[0], rotation[3], rotation[6]}), (Triple{0, 0, -1}));
  EXPECT_EQ((Triple{rotation[1], rotation[4], rotation[7]}), (Triple{0, 1, 0}));
  EXPECT_EQ((Triple{rotation[2], rotation[5], rotation[8]}), (Triple{1, 0, 0}));
}

TEST_F(OmegaGripperTest, LimitsAreTheModels) {
  for (const int type : {OMEGA_RIGHT, OMEGA_LEFT, SIGMA_RIGHT, SIGMA_LEFT}) {
    sdk->name = type < 100 ? "omega.7" : "sigma.7";
    const auto gripper = open(type);
    const GripperLimits& limits = gripper->limits();
    EXPECT_EQ(limits.name, sdk->name);
    EXPECT_EQ(limits.address, "omega");
    EXPECT_EQ(limits.force, 12);
    EXPECT_EQ(limits.grip, 8);
    EXPECT_EQ(limits.gap, (std::array<double, 2>{0, 25e-3}));
    EXPECT_EQ(limits.rate, 4000);
    EXPECT_TRUE(limits.has_rotation);
    EXPECT_EQ(limits.is_left_handed, type == OMEGA_LEFT || type == SIGMA_LEFT) << type;
  }
}

TEST_F(OmegaGripperTest, WatchdogAndMaximaComeBeforeForce) {
  const auto gripper = open();
  GripperState state;
  ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
  ASSERT_TRUE(gripper->write({{1, 0, 0}, 1}));
  EXPECT_EQ(sdk->watchdog, 80);  // of 125 us
  EXPECT_EQ(sdk->max_force, gripper->limits().force);
  EXPECT_EQ(sdk->max_gripper_force, gripper->limits().grip);
  const std::vector<std::string> order{
      "dhdOpenID",      "dhdEnableExpertMode",   "dhdEnableForce 0", "dhdSetWatchdog",
      "dhdSetMaxForce", "dhdSetMaxGripperForce", "dhdEnableForce 1", "dhdSetForceAndTorqueAndGripperForce"};
  EXPECT_EQ(sdk->calls, order);
}

TEST_F(OmegaGripperTest, NoForceBeforeTheFirstGoodRead) {
  const auto gripper = open();
  GripperState state;
  EXPECT_TRUE(gripper->write({}));
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_STREQ(gripper->last_error(), "no force before the first good read");
  EXPECT_FALSE(gripper->write({{}, 1}));

  sdk->codes["dhdGetGripperGap"] = -1;
  EXPECT_EQ(gripper->read(state, 0), ReadOutcome::error);
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  sdk->codes.clear();
  sdk->motion = {{{NAN, 0, 0}}};
  EXPECT_EQ(gripper->read(state, 1), ReadOutcome::value);
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_FALSE(was_called("dhdEnableForce 1"));
  EXPECT_TRUE(sdk->forces.empty());

  sdk->motion.clear();
  EXPECT_EQ(gripper->read(state, 2), ReadOutcome::value);
  EXPECT_FALSE(was_called("dhdEnableForce 1")) << "the read alone enables nothing";
  EXPECT_TRUE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_TRUE(gripper->write({{2, 0, 0}, 0}));
  EXPECT_EQ(std::count(sdk->calls.begin(), sdk->calls.end(), "dhdEnableForce 1"), 1);
  EXPECT_EQ(sdk->forces.size(), 2u);
}

TEST_F(OmegaGripperTest, ForcesArriveInTheSdksAxesAndSign) {
  for (const int type : {OMEGA_RIGHT, SIGMA_RIGHT, OMEGA_LEFT, SIGMA_LEFT}) {
    const auto gripper = open(type);
    GripperState state;
    ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
    ASSERT_TRUE(gripper->write({{1, 2, 3}, 4}));  // to the right, up, towards the person, opening
    const double opening = type == OMEGA_LEFT || type == SIGMA_LEFT ? -4 : 4;
    EXPECT_EQ(sdk->forces.back(), (std::array<double, 7>{3, 1, 2, 0, 0, 0, opening})) << type;
  }
}

TEST_F(OmegaGripperTest, ReadsInTheDeviceFrame) {
  StandInPose pose;
  pose.position = {0.01, 0.02, 0.03};
  pose.thumb = {0.01, 0.01, 0.03};
  pose.finger = {0.03, 0.05, 0.04};
  pose.frame = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
  pose.gap = 0.015;
  sdk->motion = {pose};
  sdk->buttons = 5;
  const auto gripper = open();
  GripperState state;
  ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
  // the middle of the tracked points, to rounding of one sum
  EXPECT_NEAR(state.position[0], 0.03, 1e-15);
  EXPECT_NEAR(state.position[1], 0.035, 1e-15);
  EXPECT_NEAR(state.position[2], 0.02, 1e-15);
  EXPECT_EQ(state.rotation, (Rotation{0, 0, 1, 0, 1, 0, -1, 0, 0}));
  EXPECT_EQ(state.gap, 0.015);
  EXPECT_EQ(state.buttons, 5u);
  EXPECT_EQ(state.time, 1e-3);
}

TEST_F(OmegaGripperTest, EachReadHasItsNumber) {
  sdk->motion.resize(3);
  for (std::size_t k = 0; k < 3; ++k) sdk->motion[k].gap = 1e-3 * static_cast<double>(k);
  const auto gripper = open();
  GripperState state;
  for (std::uint32_t k = 0; k < 5; ++k) {
    ASSERT_EQ(gripper->read(state, k), ReadOutcome::value);
    EXPECT_EQ(state.sequence, k + 1);
    EXPECT_EQ(state.gap, 1e-3 * std::min(k, 2u));
  }
}

TEST_F(OmegaGripperTest, LeftHandGapIsPositive) {
  for (const double gap : {0.01, -0.01}) {
    sdk->motion = {{}};
    sdk->motion[0].gap = gap;
    sdk->reads = 0;
    const auto gripper = open(SIGMA_LEFT);
    GripperState state;
    ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
    EXPECT_EQ(state.gap, 0.01);
  }
}

TEST_F(OmegaGripperTest, PositiveCodesAreNoErrors) {
  for (const int code : {1, 2}) {
    for (const char* function : {"dhdGetPositionAndOrientationFrame", "dhdGetGripperGap", "dhdGetGripperThumbPos",
                                 "dhdGetGripperFingerPos", "dhdSetForceAndTorqueAndGripperForce", "dhdEnableForce",
                                 "dhdSetWatchdog", "dhdSetMaxForce", "dhdSetMaxGripperForce", "dhdEnableExpertMode"}) {
      sdk->codes[function] = code;
    }
    const auto gripper = open();
    GripperState state;
    EXPECT_EQ(gripper->read(state, 0), ReadOutcome::value) << code;
    EXPECT_TRUE(gripper->write({{1, 0, 0}, 1})) << code;
    EXPECT_STREQ(gripper->last_error(), "") << code;
  }
}

TEST_F(OmegaGripperTest, ReadErrorsCarryTheSdksWords) {
  const auto gripper = open();
  GripperState state;
  ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
  state.gap = 0.5;
  sdk->error = "device\nunplugged";
  for (const auto& [function, words] : {std::pair{"dhdGetPositionAndOrientationFrame", "pose not read: device unplugged"},
                                        std::pair{"dhdGetGripperGap", "gap not read: device unplugged"},
                                        std::pair{"dhdGetGripperThumbPos", "thumb not read: device unplugged"},
                                        std::pair{"dhdGetGripperFingerPos", "finger not read: device unplugged"}}) {
    sdk->codes = {{function, -1}};
    EXPECT_EQ(gripper->read(state, 1), ReadOutcome::error);
    EXPECT_STREQ(gripper->last_error(), words);
    EXPECT_EQ(state.gap, 0.5) << "left alone";
    EXPECT_EQ(state.sequence, 1u);
  }
  // our copy of the error text stays, whatever the SDK does to its own
  const std::string before = gripper->last_error();
  sdk->error = std::string(1000, 'x');
  EXPECT_EQ(gripper->last_error(), before);
  EXPECT_EQ(gripper->read(state, 2), ReadOutcome::error);
  EXPECT_EQ(std::string(gripper->last_error()).size(), 159u);
}

TEST_F(OmegaGripperTest, WriteErrorsCarryTheSdksWords) {
  const auto gripper = open();
  GripperState state;
  ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
  sdk->error = "no power";
  sdk->codes = {{"dhdEnableForce", -1}};
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_STREQ(gripper->last_error(), "force cannot be enabled: no power");
  EXPECT_TRUE(sdk->forces.empty());
  sdk->codes = {{"dhdSetForceAndTorqueAndGripperForce", -1}};
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_STREQ(gripper->last_error(), "force not taken: no power");
}

// The force may be half switched on: zero is written, and the report has the device's answer.
TEST_F(OmegaGripperTest, AForceThatCannotBeEnabledIsTakenAway) {
  for (const bool is_taken : {false, true}) {
    const auto gripper = open();
    GripperState state;
    ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
    EXPECT_EQ(gripper->release(), ReleaseResult::no_force);
    sdk->forces.clear();
    sdk->codes = {{"dhdEnableForce", -1}};
    EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
    EXPECT_TRUE(sdk->forces.empty());
    EXPECT_EQ(gripper->panic(), ReleaseResult::not_attempted);
    if (!is_taken) sdk->codes["dhdSetForceAndTorqueAndGripperForce"] = -1;
    EXPECT_EQ(gripper->release(), is_taken ? ReleaseResult::written : ReleaseResult::refused);
    if (is_taken) {
      ASSERT_EQ(sdk->forces.size(), 1u);
      EXPECT_EQ(sdk->forces[0], (std::array<double, 7>{}));
    }
    sdk->codes.clear();
  }
}

TEST_F(OmegaGripperTest, NotANumberIsHandedOnWhenRead) {
  const auto gripper = open();
  GripperState state;
  sdk->motion.resize(1);
  const auto read_gives = [&](const StandInPose& pose) {
    sdk->motion = {pose};
    EXPECT_EQ(gripper->read(state, 0), ReadOutcome::value);
    const double sum = state.position[0] + state.position[1] + state.position[2] + state.rotation[1] + state.gap;
    return std::isfinite(sum);
  };
  EXPECT_TRUE(read_gives({}));
  StandInPose pose;
  pose.position[1] = NAN;
  EXPECT_FALSE(read_gives(pose));
  pose = {};
  pose.thumb[2] = INFINITY;
  EXPECT_FALSE(read_gives(pose));
  pose = {};
  pose.gap = NAN;
  EXPECT_FALSE(read_gives(pose));
  pose = {};
  pose.frame[2][0] = NAN;  // the SDK's up and towards: the device frame's second row, third column
  sdk->motion = {pose};
  EXPECT_EQ(gripper->read(state, 0), ReadOutcome::value);
  EXPECT_TRUE(std::isnan(state.rotation[5]));
}

TEST_F(OmegaGripperTest, NotANumberIsNeverWritten) {
  const auto gripper = open();
  GripperState state;
  ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
  ASSERT_TRUE(gripper->write({{1, 0, 0}, 1}));
  EXPECT_FALSE(gripper->write({{0, NAN, 0}, 0}));
  EXPECT_EQ(sdk->forces.back(), (std::array<double, 7>{}));
  EXPECT_FALSE(gripper->write({{}, INFINITY}));
  EXPECT_STREQ(gripper->last_error(), "a force that is not a number");
  EXPECT_EQ(sdk->forces.size(), 3u);
}

TEST_F(OmegaGripperTest, LeavesNoForceBehind) {
  const std::vector<std::string> end{"dhdSetForceAndTorqueAndGripperForce", "dhdStop", "dhdClose"};
  for (const bool fails : {false, true}) {
    GripperState state;
    auto gripper = open();
    ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
    ASSERT_TRUE(gripper->write({{5, 0, 0}, 5}));
    if (fails) {
      sdk->codes["dhdGetGripperGap"] = -1;
      ASSERT_EQ(gripper->read(state, 1), ReadOutcome::error);
    }
    ASSERT_NE(sdk->forces.back(), (std::array<double, 7>{}));
    gripper.reset();
    EXPECT_EQ(sdk->forces.back(), (std::array<double, 7>{}));
    ASSERT_GT(sdk->calls.size(), end.size());
    EXPECT_TRUE(std::equal(end.rbegin(), end.rend(), sdk->calls.rbegin()));
    EXPECT_EQ(sdk->closed.size(), fails ? 2u : 1u);
  }
  // no force to take away where none was enabled
  open().reset();
  EXPECT_EQ(sdk->forces.size(), 4u);
  EXPECT_EQ(sdk->closed.size(), 3u);
}

}  // namespace
}  // namespace wholehand::device
