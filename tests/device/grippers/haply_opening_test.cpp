// SPDX-License-Identifier: MIT
// What keeps a session with Haply's devices from starting: each in one line, with what to do.
// sanitizers: thread
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/text/error.h"
#include "device/grippers/find_grippers.h"
#include "device/grippers/haply_service.h"
#include "tests/support/haply_rig.h"

namespace wholehand::device {
namespace {

using stand_in::HaplyOptions;
using stand_in::HaplyService;

HaplyOptions with(const std::vector<std::string>& sides, bool has_grip = false) {
  HaplyOptions options;
  options.sides = sides;
  options.has_grip = has_grip;
  return options;
}

// PLACE stands for the address of the service.
void expect_refused(const HaplyOptions& options, const std::string& wanted, const std::array<std::string, 2>& arms = {},
                    const HaplyCalibration& calibration = QUICK_CALIBRATION) {
  HaplyService service(options);
  const std::string place = "haply:" + std::to_string(service.port());
  std::string line = wanted;
  for (std::size_t at = 0; (at = line.find("PLACE")) != std::string::npos;) line.replace(at, 5, place);
  try {
    open_haply(
        {{"127.0.0.1", service.port()}, arms}, live_scene(), LONG_WATCHDOG, [](const std::string&) {}, calibration);
    ADD_FAILURE() << "no error where this was due: " << line;
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_EQ(std::string(error.what()), line);
  }
  EXPECT_TRUE(service.wait([&] { return service.clients() == 0; }));
}

int closed_port() {
  const HaplyService service{HaplyOptions{}};
  return service.port();
}

TEST(HaplyOpening, NoServiceIsReportedAtOnceWithHowToStartIt) {
  const int port = closed_port();
  try {
    open_haply({{"127.0.0.1", port}, {}}, live_scene(), LONG_WATCHDOG, [](const std::string&) {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::failure);
    EXPECT_EQ(error.what(),
              "haply:" + std::to_string(port) +
                  ": no Inverse Service answers there (Connection refused); start it (in the Haply Hub, or `systemctl start "
                  "haply-inverse-service`)");
  }
  const auto found = find_haply_grippers({"127.0.0.1", port});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].address, "");
  EXPECT_EQ(found[0].missing.rfind("no Inverse Service answers there (Connection refused); start it", 0), 0u) << found[0].missing;
}

TEST(HaplyOpening, AnOldServiceHasToBeUpdated) {
  HaplyOptions old;
  old.is_old = true;
  expect_refused(
      old,
      "PLACE: this port speaks the old format 3.0; give the port of format 3.1 (10001 by default), or, if the service has "
      "none, update it in the Haply Hub to 3.1 or later");
  HaplyOptions before = with({"left", "right"});
  before.version = "3.0.7.0";
  expect_refused(before, "PLACE: the service is 3.0: update it in the Haply Hub to 3.1 or later");
  before.version = "";
  expect_refused(before,
                 "PLACE: the service does not report its version (GET /version): update it in the Haply Hub to 3.1 or later");
}

TEST(HaplyOpening, TheDevicesMustBeThere) {
  expect_refused(with({}), "PLACE: the service has no Inverse3; attach two, or one and a VerseGrip");
  expect_refused(with({"left"}), "PLACE: there is one Inverse3 (0A01) and no VerseGrip; attach a second Inverse3, or a VerseGrip");
  expect_refused(with({"left", "right"}), "PLACE: no Inverse3 is '0A07'; attached are: 0A01 (left), 0A02 (right)",
                 {"0A01", "0A07"});
  expect_refused(with({"left", "right"}), "PLACE: both tips cannot be the Inverse3 '0A01'", {"0A01", "0A01"});
  expect_refused(with({"left", "right"}),
                 "PLACE: there is one Inverse3 (0A02) and no VerseGrip; attach a second Inverse3, or a VerseGrip", {"0A02", ""});
  expect_refused(with({}), "PLACE: no Inverse3 is '0A01'; attached are: none", {"0A01", "0A02"});
}

TEST(HaplyOpening, TwoDevicesOfOneSideMustBeNamed) {
  expect_refused(
      with({"right", "right"}),
      "PLACE: the sides of the two Inverse3 are not left and right: 0A01 (right), 0A02 (right); name both in the address, the "
      "left one first: PLACE/0A01,0A02 or PLACE/0A02,0A01");
  expect_refused(
      with({"left", ""}),
      "PLACE: the sides of the two Inverse3 are not left and right: 0A01 (left), 0A02 (no side); name both in the address, "
      "the left one first: PLACE/0A01,0A02 or PLACE/0A02,0A01");
  expect_refused(with({"left", "right", "left"}),
                 "PLACE: the service has 3 Inverse3: 0A01 (left), 0A02 (right), 0A03 (left); name two in the address, the left one "
                 "first: PLACE/0A01,0A02");
}

// The address that a refusal offers.
TEST(HaplyOpening, TwoDevicesOfOneSideAreOpenedByName) {
  HaplyRig rig(with({"right", "right"}), LONG_WATCHDOG, live_scene(), {"0A02", "0A01"});
  EXPECT_EQ(rig.gripper->limits().address, rig.place() + "/0A02,0A01");
  // the left one is the second in the service's list: 30 mm to the left
  rig.service.rest_at(haply_moved({0, 0, 0}, {-0.03, 0, 0}));
  EXPECT_TRUE(rig.reads_until([&] { return std::abs(rig.state.gap - 0.03) < 1e-12; }));
  EXPECT_NEAR(rig.state.position[0], -0.015, 1e-12);
}

TEST(HaplyOpening, OneServiceServesOneSession) {
  const HaplyRig rig;
  for (const char* const host : {"127.0.0.1", "localhost"}) {
    try {
      open_haply(
          {{host, rig.service.port()}, {}}, rig.scene, LONG_WATCHDOG, [](const std::string&) {}, QUICK_CALIBRATION);
      ADD_FAILURE() << host;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::failure);
      EXPECT_NE(std::string(error.what()).find("haply-127.0.0.1-" + std::to_string(rig.service.port())), std::string::npos)
          << error.what();
    }
  }
}

TEST(HaplyOpening, AnIPv6HostHasBrackets) {
  EXPECT_EQ(authority({"::1", 10001}), "[::1]:10001") << "as the Host of a request needs it";
  EXPECT_EQ(haply_place({"::1", 10001}), "haply:[::1]:10001") << "as --device takes it";
  EXPECT_EQ(authority({"10.0.0.7", 80}), "10.0.0.7:80");
}

TEST(HaplyOpening, NamesAreChosenBeforeSides) {
  const haply::Inventory all{{{"A", "right"}, {"B", "left"}, {"C", "left"}}, {"G"}, false};
  const auto arms_of = [&](const std::array<std::string, 2>& arms) { return choose_haply_devices(all, {{}, arms}).arms; };
  EXPECT_EQ(arms_of({"A", "C"}), (std::array<std::string, 2>{"A", "C"})) << "as the address has them";
  EXPECT_EQ(choose_haply_devices(all, {{}, {"C", ""}}).grip, "G");
  const haply::Inventory two{{{"A", "right"}, {"B", "left"}}, {"G"}, false};
  EXPECT_EQ(choose_haply_devices(two, {}).arms, (std::array<std::string, 2>{"B", "A"})) << "left first";
  EXPECT_EQ(choose_haply_devices(two, {}).grip, "") << "two tips need none";
}

TEST(HaplyOpening, WhatIsNoServiceIsReported) {
  HaplyOptions mute;
  mute.says_nothing = true;
  expect_refused(mute, "PLACE: what answers there names no devices; give the port of the Inverse Service");
}

// Devices that lie still were not shown to anybody; and those that never rest have no origin.
TEST(HaplyOpening, AWorkspaceThatIsNotShownIsRefused) {
  HaplyCalibration calibration = QUICK_CALIBRATION;
  calibration.patience = 0.1;
  expect_refused(with({"left", "right"}),
                 "PLACE/0A01,0A02: not calibrated within 0.1 s: move the devices first, and then keep them still", {}, calibration);
}

TEST(HaplyOpening, DevicesListsWhatTheServiceHas) {
  const HaplyService two(with({"right", "left"}));
  auto found = find_haply_grippers({"127.0.0.1", two.port()});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].missing, "");
  EXPECT_EQ(found[0].address, "haply:" + std::to_string(two.port()));
  EXPECT_EQ(found[0].name, "two Inverse3: 0A01 (right), 0A02 (left)");
  EXPECT_EQ(found[0].summary, "Inverse Service 3.5; up to 10 N at each tip, up to 4,000 Hz");
  const HaplyService grip(with({"right"}, true));
  found = find_haply_grippers({"127.0.0.1", grip.port()});
  EXPECT_EQ(found[0].name, "Inverse3 0A01 (right) with VerseGrip 0B01");
  const HaplyService one(with({"right"}));
  found = find_haply_grippers({"127.0.0.1", one.port()});
  EXPECT_EQ(found[0].address, "");
  EXPECT_EQ(found[0].missing, "there is one Inverse3 (0A01) and no VerseGrip; attach a second Inverse3, or a VerseGrip");
}

}  // namespace
}  // namespace wholehand::device
