// SPDX-License-Identifier: MIT
// A session of the program with Haply's devices, on the stand-in for their service.
// sanitizers: none
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/stand_in/haply_service.h"
#include "tests/support/files.h"
#include "tests/support/haply_rig.h"
#include "tests/support/program.h"

namespace wholehand {
namespace {

// Comes and rests for long enough to be calibrated, again and again; the way is never still.
stand_in::HaplyMotion come_and_rest(double time) {
  constexpr double WAY = 0.5, CYCLE = 3, SPEED = 1;  // s, s, m/s
  const double left = SPEED * std::max(WAY - std::fmod(time, CYCLE), 0.0);
  return haply_moved({left, 0, 0}, {0, left, 0});
}

// A machine that is busy may keep the service silent for more than 10 ms, which has to end the session, or leaves zero force without an answer; nothing
// else may, and not five times in a row.
TEST(LiveHaply, ASessionIsCalibratedRunsAndLeavesNoForce) {
  const TemporaryFolder folder;
  stand_in::HaplyService service{{}};
  service.move(come_and_rest);
  const std::string place = "haply:" + std::to_string(service.port());
  int code = 1;
  for (int k = 0; k < 5 && code != 0; ++k) {
    const Outcome outcome = run("WHOLEHAND_LOCK_DIR=" + folder.path() + " PROGRAM live --json --seconds 0.2 --device " + place +
                                " 2>" + (folder / "err"));
    const std::string said = file_text(folder / "err");
    EXPECT_NE(said.find(place + "/0A01,0A02: move, touch the tips together"), std::string::npos) << said;
    ASSERT_NE(said.find(place + "/0A01,0A02: calibrated; grip by thumb and index finger"), std::string::npos) << said;
    const auto report = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(report["device"]["name"], "two Inverse3");
    EXPECT_EQ(report["device"]["address"], place + "/0A01,0A02");
    const bool was_silent = said.find("timeout (no new state of the service") != std::string::npos ||
                            said.find("the service does not answer zero force") != std::string::npos;
    EXPECT_TRUE(outcome.code == 0 || was_silent) << said;
    EXPECT_TRUE(service.wait([&] { return service.clients() == 0; }));
    EXPECT_FALSE(service.has_force());
    code = outcome.code;
  }
  EXPECT_EQ(code, 0);
}

TEST(LiveHaply, TheFirstWrongPartOfAnAddressIsReported) {
  const auto line_of = [](const std::string& device) {
    return run("PROGRAM live --seconds 0.1 --device '" + device + "' 2>&1").output;
  };
  EXPECT_NE(line_of("haply:0/a,b,c").find("'haply:0/a,b,c': its port is not a whole number"), std::string::npos);
  EXPECT_NE(line_of("haply/a,b,c").find("'haply/a,b,c': behind the / it needs one or two ids; allowed: "), std::string::npos);
}

}  // namespace
}  // namespace wholehand
