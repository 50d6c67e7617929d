// SPDX-License-Identifier: MIT
// The built program with names that would steer a terminal, turn a page's words round or compute in a spreadsheet.
// sanitizers: address
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files/csv.h"
#include "base/files/json.h"
#include "base/text/printable.h"
#include "device/recordings/recording.h"
#include "tests/support/files.h"
#include "tests/support/program.h"

#ifdef WHOLEHAND_PROGRAM

namespace {

using namespace wholehand;

// Escape, carriage return, a control character of two bytes, an override of the direction and a byte of no encoding.
const std::string HOSTILE = "=a\x1b[31m\r\xc2\x9b\x31m\xe2\x80\xae\x9b";
const std::string IN_SCENE = "=a\\u009b1m\\u202eb";  // as TOML writes it

std::string quoted(const std::string& text) { return "'" + text + "'"; }

void expect_steers_nothing(const std::string& text, const std::string& what) { EXPECT_EQ(printable_lines(text), text) << what; }

// A scene under a hostile name, with a hostile name of its own.
std::string hostile_scene(const TemporaryFolder& folder) {
  const std::string path = folder / (HOSTILE + ".toml");
  write_file(path, "[scene]\nname = \"" + IN_SCENE +
                       "\"\n[[vessel]]\nname = \"cup\"\nshape = \"cylinder\"\ndiameter_mm = 70\nheight_mm = 95\nwall_mm = 2\n"
                       "[grips]\nheight_mm = [50, 60]\nroll_deg = [0, -20]\n[tilts]\ndeg = [0, 60]\n[liquid]\nfills = [0.5]\n"
                       "[strength]\n");
  return path;
}

TEST(HostileNames, SteerNothingThatACommandPrints) {
  const TemporaryFolder folder;
  hostile_scene(folder);
  const std::string list = folder / ("=list" + HOSTILE + ".csv"), in = "cd " + quoted(folder.path()) + " && PROGRAM ";
  const std::string name = quoted(HOSTILE + ".nc"), from_here = quoted(HOSTILE + ".toml");
  const std::string recording = quoted("live" + HOSTILE + ".nc");
  const std::vector<std::string> commands{
      "sweep " + from_here + " --on core -o " + name + " --glb 1",
      "rank " + name + " -o " + quoted(list),
      "rank " + name,
      "report " + name + " --list " + quoted(list) + " -o " + quoted("=" + HOSTILE + ".html"),
      "grip " + name + " --vessel cup --rank 1 --svg " + quoted(HOSTILE + ".svg") + " --glb " + quoted(HOSTILE + ".glb"),
      "grip " + from_here + " --vessel cup --height-mm 50 --json",
      "live " + from_here + " --no-clock --seconds 1 --record " + recording,
      "live " + from_here + " --no-clock --seconds 1 --json",
      "session " + recording + " -o " + quoted("out" + HOSTILE),
  };
  for (const std::string& command : commands) {
    const Outcome outcome = run(in + command + " 2>&1");
    EXPECT_EQ(outcome.code, 0) << command << "\n" << outcome.output;
    EXPECT_FALSE(outcome.output.empty()) << command;
    expect_steers_nothing(outcome.output, command);
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    const std::string ending = entry.path().extension();
    if (ending != ".csv" && ending != ".svg" && ending != ".html") continue;
    ++files;
    const std::string text = file_text(entry.path());
    expect_steers_nothing(text, ending);
    if (ending == ".csv") {
      EXPECT_EQ(text.find(",="), std::string::npos) << "a formula in " << text;
    }
  }
  EXPECT_GE(files, 6u);
}

TEST(HostileNames, SteerNothingInErrorLines) {
  const TemporaryFolder folder;
  const std::string scene = quoted(hostile_scene(folder)), key = folder / "key.toml";
  write_file(key, "[scene]\n\"" + IN_SCENE + "\" = 1\n");
  for (const char* ending : {"obj", "stl", "ply", "gltf"})
    write_file(folder / ("m." + std::string(ending)),
               ending == std::string("gltf")  ? R"({"asset":{"version":"2.0"},"extensionsRequired":["A\u009b31m\u202e\u001b"]})"
               : ending == std::string("obj") ? "v 0 0 " + HOSTILE + "\n"
               : ending == std::string("stl") ? "solid x\n" + HOSTILE + " normal\n"
                                              : "ply\nformat " + HOSTILE + " 1.0\n");
  std::vector<std::string> commands{"sweep " + quoted(folder / HOSTILE),
                                    "sweep " + quoted(key),
                                    "grip " + scene + " --vessel " + quoted(HOSTILE) + " --height-mm 50",
                                    "live " + scene + " --device " + quoted(HOSTILE),
                                    "session " + scene,
                                    "rank " + scene,
                                    "compare " + scene + " " + quoted(HOSTILE),
                                    "report " + scene,
                                    "merge " + scene,
                                    "view " + quoted(folder / HOSTILE),
                                    "sweep " + scene + " --" + quoted(HOSTILE) + " 1",
                                    quoted(HOSTILE)};
  for (const char* ending : {"obj", "stl", "ply", "gltf"}) {
    const std::string path = folder / (std::string(ending) + ".toml");
    write_file(path, "[[vessel]]\nname = \"m\"\nmesh = \"m." + std::string(ending) + "\"\n");
    commands.push_back("sweep " + quoted(path) + " --on core");
  }
  for (const std::string& command : commands) {
    const Outcome outcome = run("PROGRAM " + command + " 2>&1 >/dev/null");
    EXPECT_EQ(outcome.code, 2) << command << "\n" << outcome.output;
    EXPECT_EQ(outcome.output.rfind("wholehand: ", 0), 0u) << outcome.output;
    EXPECT_EQ(outcome.output.find('\n'), outcome.output.size() - 1) << outcome.output;
    expect_steers_nothing(outcome.output, command);
  }
}

// A recording says who felt it in words of its own.
TEST(HostileNames, SteerNothingFromARecording) {
  const TemporaryFolder folder;
  device::RecordingInfo info;
  info.scene_name = info.device.name = info.start = HOSTILE;
  info.vessels = {{HOSTILE, "=water", 2}};
  std::vector<device::Tick> ticks(1500);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    ticks[k].number = static_cast<std::int64_t>(k);
    ticks[k].state = k < 500 ? device::SessionState::free : device::SessionState::lift;
    ticks[k].vessel = k < 500 ? -1 : 0;
  }
  const std::string path = folder / "session.nc";
  device::RecordingWriter writer(path, info);
  writer.append(ticks);
  writer.finish({});
  const Outcome table = run("PROGRAM session " + path + " -o " + folder.path() + "/out 2>&1");
  EXPECT_EQ(table.code, 0) << table.output;
  EXPECT_NE(table.output.find("=a\\x1b[31m\\x0d\\u009b1m\\u202e"), std::string::npos) << table.output;
  expect_steers_nothing(table.output, "session");
  for (const char* name : {"session.csv", "states.csv", "session.svg"})
    expect_steers_nothing(file_text(folder.path() + "/out/" + name), name);
  const auto rows = parse_csv(file_text(folder.path() + "/out/session.csv"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].cells[1][0], '=');
  EXPECT_NE(file_text(folder.path() + "/out/session.csv").find("1,'=a"), std::string::npos);
  const Outcome json = run("PROGRAM session " + path + " --json");
  expect_steers_nothing(json.output, "session --json");
  EXPECT_FALSE(try_json(json.output).is_discarded()) << json.output;
}

}  // namespace

#endif
