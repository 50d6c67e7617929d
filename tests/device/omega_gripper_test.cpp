// SPDX-License-Identifier: MIT
// omega.7 and sigma.7 against a stand-in for Force Dimension's SDK, and what is said where there is none.
#include "device/omega_gripper.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "core/error.h"
#include "device/dhd_library.h"
#include "tests/support/files.h"
#include "tests/support/stand_in_dhd.h"

namespace wholehand {
namespace {

constexpr double OMEGA_WATCHDOG = 10e-3;  // s
constexpr int OMEGA_RIGHT = 35, OMEGA_LEFT = 37, SIGMA_RIGHT = 104, SIGMA_LEFT = 105;

// What `function` throws: one line, with `code`.
template <class Function>
std::string refusal(const Function& function, ExitCode code = ExitCode::failure) {
  try {
    function();
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_EQ(error.code, code) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
  return "";
}

void expect_has(const std::string& line, const std::string& gist) {
  EXPECT_NE(line.find(gist), std::string::npos) << "'" << line << "' lacks '" << gist << "'";
}

struct OmegaGripperTest : testing::Test {
  StandIn sdk{STAND_IN_DHD};

  std::unique_ptr<Gripper> open(int type = OMEGA_RIGHT) const {
    sdk->types = {type};
    return open_omega(STAND_IN_DHD, OMEGA_WATCHDOG);
  }
  std::string refused() const {
    return refusal([] { open_omega(STAND_IN_DHD, OMEGA_WATCHDOG); });
  }
  // Where `call` stands among those that were made; past them if it was not.
  std::size_t place(const std::string& call) const {
    return static_cast<std::size_t>(std::find(sdk->calls.begin(), sdk->calls.end(), call) - sdk->calls.begin());
  }
  bool was_called(const std::string& call) const { return place(call) < sdk->calls.size(); }
};

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
  EXPECT_STREQ(gripper->trouble(), "no force before the first good read");
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
    EXPECT_STREQ(gripper->trouble(), "") << code;
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
    EXPECT_STREQ(gripper->trouble(), words);
    EXPECT_EQ(state.gap, 0.5) << "left alone";
    EXPECT_EQ(state.sequence, 1u);
  }
  // the words stay, whatever becomes of the SDK's
  const std::string before = gripper->trouble();
  sdk->error = std::string(1000, 'x');
  EXPECT_EQ(gripper->trouble(), before);
  EXPECT_EQ(gripper->read(state, 2), ReadOutcome::error);
  EXPECT_EQ(std::string(gripper->trouble()).size(), 159u);
}

TEST_F(OmegaGripperTest, WriteErrorsCarryTheSdksWords) {
  const auto gripper = open();
  GripperState state;
  ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
  sdk->error = "no power";
  sdk->codes = {{"dhdEnableForce", -1}};
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_STREQ(gripper->trouble(), "force cannot be enabled: no power");
  EXPECT_TRUE(sdk->forces.empty());
  sdk->codes = {{"dhdSetForceAndTorqueAndGripperForce", -1}};
  EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
  EXPECT_STREQ(gripper->trouble(), "force not taken: no power");
}

// It may be half switched on: zero is written, and what is told is what the device answered.
TEST_F(OmegaGripperTest, AForceThatCannotBeEnabledIsTakenAway) {
  for (const bool is_taken : {false, true}) {
    const auto gripper = open();
    GripperState state;
    ASSERT_EQ(gripper->read(state, 0), ReadOutcome::value);
    EXPECT_EQ(gripper->let_go(), LetGo::nothing);
    sdk->forces.clear();
    sdk->codes = {{"dhdEnableForce", -1}};
    EXPECT_FALSE(gripper->write({{1, 0, 0}, 0}));
    EXPECT_TRUE(sdk->forces.empty());
    EXPECT_EQ(gripper->panic(), LetGo::not_asked);
    if (!is_taken) sdk->codes["dhdSetForceAndTorqueAndGripperForce"] = -1;
    EXPECT_EQ(gripper->let_go(), is_taken ? LetGo::written : LetGo::not_taken);
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
  EXPECT_STREQ(gripper->trouble(), "a force that is not a number");
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

TEST_F(OmegaGripperTest, WatchdogIsKeptToItsRange) {
  const auto watchdog = [&](double seconds) {
    open_omega(STAND_IN_DHD, seconds);
    return sdk->watchdog;
  };
  testing::internal::CaptureStderr();
  EXPECT_EQ(watchdog(1e-6), 1);  // never 0, which would be none
  EXPECT_EQ(watchdog(5e-3), 40);
  EXPECT_EQ(watchdog(31.875e-3), 255);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  testing::internal::CaptureStderr();
  EXPECT_EQ(watchdog(50e-3), 255);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "wholehand: omega: the watchdog is set to 31.875 ms, the longest of the device, instead of 50 ms\n");
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    expect_has(refusal([&] { watchdog(wrong); }, ExitCode::usage), "the watchdog must be longer than 0 s");
  }
}

TEST_F(OmegaGripperTest, RefusesADeviceWithoutAWatchdog) {
  sdk->codes["dhdSetWatchdog"] = -1;
  sdk->error = "not available";
  expect_has(refusal([&] { open(); }, ExitCode::failure),
             "omega: the device takes no watchdog (not available), and is not used without one");
}

TEST_F(OmegaGripperTest, RefusesADeviceWithoutMaximumForces) {
  for (const char* function : {"dhdSetMaxForce", "dhdSetMaxGripperForce"}) {
    sdk->codes = {{function, -1}};
    sdk->error = "not available";
    expect_has(refused(), "does not take its maximum forces of 12 N and 8 N: not available");
  }
  EXPECT_EQ(sdk->closed.size(), 2u);
  EXPECT_FALSE(was_called("dhdEnableForce 1"));
}

TEST_F(OmegaGripperTest, SaysWhenItCannotOpen) {
  sdk->codes["dhdOpenID"] = -1;
  sdk->error = "device\nin use";
  const std::string line = refused();
  expect_has(line, "omega: cannot open device 0: device in use; likely another program has it open");
  expect_has(line, "device/udev/60-wholehand.rules");
  EXPECT_TRUE(sdk->closed.empty());
  sdk->codes.clear();
  EXPECT_NE(open(), nullptr) << "nothing was left locked";
}

TEST_F(OmegaGripperTest, SaysWhenThereIsNoDevice) {
  sdk->types.clear();
  expect_has(refused(), "Force Dimension's SDK finds no device; is one attached and switched on");
  sdk->types = {OMEGA_RIGHT};
  expect_has(refusal([] { open_omega(STAND_IN_DHD, OMEGA_WATCHDOG, 1); }),
             "there is no device 1; Force Dimension's SDK counts 1, from 0");
  EXPECT_TRUE(sdk->opened.empty());
}

TEST_F(OmegaGripperTest, OpensTheDeviceOfThatNumber) {
  sdk->types = {OMEGA_RIGHT, SIGMA_LEFT};
  const auto first = open_omega(STAND_IN_DHD, OMEGA_WATCHDOG);
  const auto second = open_omega(STAND_IN_DHD, OMEGA_WATCHDOG, 1);
  EXPECT_EQ(second->limits().address, "omega:1");
  EXPECT_TRUE(second->limits().is_left_handed);
  EXPECT_EQ(sdk->opened, (std::vector<int>{0, 1}));
}

TEST_F(OmegaGripperTest, RefusesOtherModelsByName) {
  sdk->types = {33};
  sdk->name = "omega.3";
  expect_has(refused(), "omega: omega.3 (type 33) is not supported; supported are omega.7 and sigma.7");
  EXPECT_EQ(sdk->closed.size(), 1u);
}

TEST_F(OmegaGripperTest, OneSessionADevice) {
  auto first = open();
  const std::string line = refused();
  expect_has(line, "in use by another session of wholehand");
  expect_has(line, sdk.runtime_directory() / "wholehand-omega-0.lock");
  EXPECT_EQ(sdk->opened.size(), 1u) << "the device was not touched";
  first.reset();
  EXPECT_NE(open(), nullptr);
}

TEST_F(OmegaGripperTest, ALockThatCannotBeMadeIsAnError) {
  const std::string nowhere = sdk.runtime_directory() / "not_there";
  const ScopedVariable folder("WHOLEHAND_LOCK_DIR", nowhere.c_str());
  expect_has(refused(), "cannot make the lock file " + nowhere + "/wholehand-omega-0.lock: No such file or directory");
}

// Another user's session may have made the file; it can still be locked.
TEST_F(OmegaGripperTest, LocksAFileThatItMayOnlyRead) {
  open().reset();
  ASSERT_EQ(chmod((sdk.runtime_directory() / "wholehand-omega-0.lock").c_str(), 0444), 0);
  EXPECT_NE(open(), nullptr);
}

TEST_F(OmegaGripperTest, FindsEveryDevice) {
  sdk->types = {OMEGA_LEFT, 33};
  const auto found = find_omega_grippers(STAND_IN_DHD);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].address, "omega");
  EXPECT_EQ(found[0].name, "omega.7, left hand");
  EXPECT_EQ(found[0].summary, "up to 12 N, gripper 8 N, gap 0 to 25 mm, up to 4000 Hz; SDK 3.17.6 (" STAND_IN_DHD ")");
  EXPECT_EQ(found[0].missing, "");
  EXPECT_EQ(found[1].address, "");
  expect_has(found[1].missing, "(type 33) is not supported");
  EXPECT_EQ(sdk->closed, (std::vector<int>{0, 1}));
  EXPECT_TRUE(sdk->forces.empty());

  sdk->types = {OMEGA_LEFT};
  const auto held = open(OMEGA_LEFT);
  const auto used = find_omega_grippers(STAND_IN_DHD);
  ASSERT_EQ(used.size(), 1u);
  EXPECT_EQ(used[0].address, "");
  expect_has(used[0].missing, "in use by another session");

  sdk->types.clear();
  const auto none = find_omega_grippers(STAND_IN_DHD);
  ASSERT_EQ(none.size(), 1u);
  EXPECT_EQ(none[0].address, "");
  expect_has(none[0].missing, "finds no device");
}

TEST_F(OmegaGripperTest, FindingSaysWhatIsMissing) {
  const auto found = find_omega_grippers("/not/there/libdhd.so");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].address, "");
  EXPECT_EQ(found[0].name, "omega");
  expect_has(found[0].missing, "/not/there/libdhd.so");
}

TEST(DhdLibrary, SaysWhereToGetIt) {
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", nullptr);
  const std::string line = refusal([] { load_dhd_library("", {"libnone_dhd.so.3", "libnone_dhd.so"}); });
  expect_has(line, "Force Dimension's SDK is not there (looked for libnone_dhd.so.3, libnone_dhd.so)");
  expect_has(line, "https://www.forcedimension.com/software/sdk");
  expect_has(line, "--dhd-library, [device] library of the scene, or the environment variable WHOLEHAND_DHD_LIBRARY");
}

TEST(DhdLibrary, TakesTheFirstThatIsThere) {
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", nullptr);
  EXPECT_EQ(load_dhd_library("", {"libnone_dhd.so.3", STAND_IN_DHD, "libnone_dhd.so"}).path, STAND_IN_DHD);
  EXPECT_EQ(DHD_LIBRARY_NAMES, (std::vector<std::string>{"libdhd.so.3", "libdhd.so", "libdrd.so.3", "libdrd.so"}));
}

TEST(DhdLibrary, SaysWhyOneThatIsThereDoesNotLoad) {
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", nullptr);
  const TemporaryFolder folder;
  const std::string text = folder / "libdhd.so";
  { std::ofstream(text) << "no library"; }
  const std::string line = refusal([&] { load_dhd_library("", {text, "libnone_dhd.so"}); });
  expect_has(line, "cannot load Force Dimension's SDK: " + text + ":");
}

// The loader would wait without end for somebody to write to it.
TEST(DhdLibrary, APipeIsNotWaitedFor) {
  const TemporaryFolder folder;
  const std::string path = folder / "libdhd.so";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  expect_has(refusal([&] { load_dhd_library(path); }), path + ": is no file but a folder, device or pipe; get it from ");
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", path.c_str());
  expect_has(refusal([] { load_dhd_library(""); }), "(named by WHOLEHAND_DHD_LIBRARY): " + path + ": is no file");
}

TEST(DhdLibrary, WhatIsNamedIsNotReplaced) {
  const std::vector<std::string> names{STAND_IN_DHD};
  {
    const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", STAND_IN_DHD);
    const std::string line = refusal([&] { load_dhd_library("/not/there/libdhd.so", names); });
    expect_has(line, "cannot load Force Dimension's SDK: /not/there/libdhd.so: cannot open shared object file");
    EXPECT_EQ(load_dhd_library("", {}).path, STAND_IN_DHD);
  }
  const ScopedVariable variable("WHOLEHAND_DHD_LIBRARY", "/not/here/libdhd.so");
  const std::string line = refusal([&] { load_dhd_library("", names); });
  expect_has(line, "cannot load Force Dimension's SDK (named by WHOLEHAND_DHD_LIBRARY): /not/here/libdhd.so:");
  EXPECT_EQ(load_dhd_library(STAND_IN_DHD, {}).path, STAND_IN_DHD);
  const ScopedVariable empty("WHOLEHAND_DHD_LIBRARY", "");
  EXPECT_EQ(load_dhd_library("", names).path, STAND_IN_DHD) << "empty is unset";
}

TEST(DhdLibrary, NamesTheMissingFunction) {
  const std::string line = refusal([] { load_dhd_library(STAND_IN_DHD_OLD); });
  expect_has(line, STAND_IN_DHD_OLD " lacks the function dhdSetWatchdog");
}

}  // namespace
}  // namespace wholehand
