// SPDX-License-Identifier: MIT
// wholehand live --advise as it is typed: what it says, that it changes nothing of the session, that a user who follows it
// repeats, and how it ends.
// sanitizers: none (it runs the program)
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "base/text/error.h"
#include "device/recordings/recording.h"
#include "tests/support/advised_session.h"
#include "tests/support/files.h"
#include "tests/support/patient_board.h"
#include "tests/support/program.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

class LiveAdvised : public testing::Test {
 protected:
  Outcome live(const std::string& arguments) const { return run("PROGRAM live " + arguments + " 2>&1"); }
  device::Recording recorded(const std::string& name, const std::string& more) const {
    const std::string file = folder / (name + ".nc");
    const Outcome outcome = live("--no-clock --seconds 12 --record " + file + " " + more);
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    return device::read_recording(file);
  }
  TemporaryFolder folder;
};

void expect_same_forces(const device::Recording& a, const device::Recording& b) {
  ASSERT_EQ(a.ticks.size(), b.ticks.size());
  for (std::size_t k = 0; k < a.ticks.size(); ++k) {
    ASSERT_EQ(a.ticks[k].device.position, b.ticks[k].device.position) << k;
    ASSERT_EQ(a.ticks[k].written.grip, b.ticks[k].written.grip) << k;
    ASSERT_EQ(a.ticks[k].written.arm, b.ticks[k].written.arm) << k;
  }
}

TEST_F(LiveAdvised, ChangesNothingOfASessionThatDoesNotFollow) {
  expect_same_forces(recorded("without", ""), recorded("with", "--advise --advise-on core"));
}

// Lavapipe's name has the width of its vectors, which the program sets for every command alike.
TEST_F(LiveAdvised, ComputesOnTheDeviceThatDevicesNames) {
  const std::string wide = "env -u LP_NATIVE_VECTOR_WIDTH ";
  const Outcome session = run(wide + "PROGRAM live --no-clock --seconds 1 --advise --advise-on vulkan 2>&1");
  ASSERT_EQ(session.code, 0) << session.output;
  const std::string before = "advice is computed on vulkan, ";
  const std::size_t at = session.output.find(before);
  ASSERT_NE(at, std::string::npos) << session.output;
  const std::size_t from = at + before.size();
  const std::string device = session.output.substr(from, session.output.find('\n', from) - from);
  EXPECT_NE(run(wide + "PROGRAM devices 2>&1").output.find(device), std::string::npos) << device;
}

TEST_F(LiveAdvised, WhoFollowsTakesAnotherGripAndRepeats) {
  const device::Recording without = recorded("without", ""), one = recorded("one", "--advise --advise-on core --follow-advice"),
                          two = recorded("two", "--advise --advise-on core --follow-advice");
  expect_same_forces(one, two);
  const auto grasp = [](const device::Recording& recording) {
    for (const device::Tick& tick : recording.ticks)
      if (tick.grasps == 2) return tick.grasp_height;
    return 0.0;
  };
  ASSERT_GT(grasp(without), 0);
  ASSERT_GT(grasp(one), 0);
  EXPECT_GT(std::abs(grasp(one) - grasp(without)), 2e-3);
}

TEST_F(LiveAdvised, SaysWhatItComputesOnAndReports) {
  const Outcome outcome = live(patient_board(folder) + " --advise --advise-on core --seconds 4");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  for (const char* part :
       {"wholehand: live: advice is computed on core, ", "advice, tutorial: ", "effort", "  advice     computed on core, "})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << outcome.output << "lacks " << part;
  const Outcome json = run("PROGRAM live " + patient_board(folder) + " --advise --advise-on core --seconds 4 --json 2>/dev/null");
  ASSERT_EQ(json.code, 0);
  const auto advice = parse_json(json.output)["advice"];
  EXPECT_GT(advice["updates"], 0);
  EXPECT_GT(advice["grips"].get<int>(), advice["updates"].get<int>());
  EXPECT_TRUE(advice["on"].get<std::string>().starts_with("core, "));
}

TEST_F(LiveAdvised, ASignalEndsItCleanly) {
  const Outcome outcome = run("PROGRAM live " + patient_board(folder) + " --advise --advise-on core >" + (folder / "out") +
                              " 2>&1 & PID=$!; while ! grep -q 'is held' " + (folder / "out") +
                              " && kill -0 $PID; do sleep 0.05; done; kill -INT $PID; wait $PID");
  EXPECT_EQ(outcome.code, 130) << file_text(folder / "out");
  EXPECT_NE(file_text(folder / "out").find("ended by a signal"), std::string::npos);
}

TEST_F(LiveAdvised, RefusesWhatDoesNotGoTogether) {
  expect_error("live --advise-on core", 2, "add --advise");
  expect_error("live --follow-advice", 2, "add --advise");
  expect_error("live --advise --follow-advice --device view --view", 2, "--device sim");
  expect_error("live --advise --advise-on 'no such device'", 2, "no such device");
  setenv("VK_DRIVER_FILES", "/nonexistent", 1);
  expect_error("live --advise --advise-on vulkan", 3, "use --advise-on core");
  unsetenv("VK_DRIVER_FILES");
  expect_error("live --advise --advise-on ''", 2, "--advise-on");
  const std::string weak = folder / "weak.toml";
  write_file(weak,
             "[scene]\nname = \"weak\"\n[[vessel]]\nname = \"cup\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = "
             "110\nwall_mm = 2\n[strength]\nefforts = false\n");
  expect_error("live " + weak + " --advise --advise-on core", 2, "leave efforts = false out");
}

}  // namespace
}  // namespace wholehand

#endif
