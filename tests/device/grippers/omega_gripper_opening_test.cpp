// SPDX-License-Identifier: MIT
// omega.7 and sigma.7 against a stand-in for Force Dimension's SDK: which device is opened, and which is refused.
#include "device/grippers/omega_gripper.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "base/text/error.h"
#include "tests/support/files.h"
#include "tests/support/omega_fixture.h"

namespace wholehand::device {
namespace {

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
    expect_has(omega_refusal([&] { watchdog(wrong); }, ExitCode::usage), "the watchdog must be longer than 0 s");
  }
}

TEST_F(OmegaGripperTest, RefusesADeviceWithoutAWatchdog) {
  sdk->codes["dhdSetWatchdog"] = -1;
  sdk->error = "not available";
  expect_has(omega_refusal([&] { open(); }, ExitCode::failure),
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
  expect_has(omega_refusal([] { open_omega(STAND_IN_DHD, OMEGA_WATCHDOG, 1); }),
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

TEST_F(OmegaGripperTest, OpensTheDeviceOfThatSerialNumber) {
  sdk->types = {OMEGA_RIGHT, SIGMA_LEFT, OMEGA_RIGHT};
  const auto second = open_omega(STAND_IN_DHD, OMEGA_WATCHDOG, 4002);
  EXPECT_EQ(second->limits().address, "omega:4002");
  EXPECT_TRUE(second->limits().is_left_handed);
  EXPECT_EQ(sdk->opened, (std::vector<int>{0, 1, 1}));
  EXPECT_EQ(sdk->closed, (std::vector<int>{0, 1})) << "opened briefly, for their serial numbers";
  EXPECT_TRUE(sdk->forces.empty());
  const auto refusal = [](int which) { return omega_refusal([which] { open_omega(STAND_IN_DHD, OMEGA_WATCHDOG, which); }); };
  expect_has(refusal(1), "in use by another session of wholehand");
  expect_has(refusal(4002), "no free device has the serial number 4002; device 0 has 4001; device 1: ");
  expect_has(refusal(4002), "; device 2 gives none");
  sdk->calls.clear();
  expect_has(refusal(4003), "no free device has the serial number 4003");
  EXPECT_EQ(sdk->calls, (std::vector<std::string>{"dhdOpenID", "dhdClose", "dhdOpenID", "dhdClose"})) << "nothing is enabled";
  EXPECT_EQ(sdk->opened.size(), 9u) << "the device of the other session was not touched";
  EXPECT_EQ(open_omega(STAND_IN_DHD, OMEGA_WATCHDOG, 4001)->limits().address, "omega:4001");
}

// Between the search and the opening somebody replugs: the number is now another device's.
TEST_F(OmegaGripperTest, ADeviceThatTookTheNumberGetsNoForce) {
  sdk->types = {OMEGA_RIGHT, OMEGA_LEFT};
  sdk->hooks["dhdOpenID"] = [this] {
    if (sdk->opened.size() == 2) sdk->serials = {4002, 4001};
  };
  expect_has(omega_refusal([] { open_omega(STAND_IN_DHD, OMEGA_WATCHDOG, 4002); }),
             "omega:4002: the devices changed while they were searched; start again");
  EXPECT_EQ(sdk->opened, (std::vector<int>{0, 1, 1}));
  EXPECT_EQ(sdk->closed, (std::vector<int>{0, 1, 1}));
  for (const std::string& call : sdk->calls) EXPECT_TRUE(call == "dhdOpenID" || call == "dhdClose" || call == "dhdStop") << call;
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
  EXPECT_EQ(found[0].name, "omega.7, left hand, serial 4001");
  EXPECT_EQ(found[0].summary, "up to 12 N, gripper 8 N, gap 0 to 25 mm, up to 4,000 Hz; SDK 3.17.6 (" STAND_IN_DHD ")");
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

}  // namespace
}  // namespace wholehand::device
