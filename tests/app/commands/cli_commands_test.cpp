// SPDX-License-Identifier: MIT
// The built program: what its commands print and write, end to end.
// sanitizers: none (it runs the program, for its words)
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "core/reader/shipped.h"
#include "device/recordings/recording.h"
#include "tests/support/files.h"
#include "tests/support/program.h"

#ifdef WHOLEHAND_PROGRAM

namespace {

using wholehand::expect_error;
using wholehand::Outcome;
using wholehand::parse_json;
using wholehand::run;
using wholehand::SMALL_GRIP;

// A vessel lifted for a second.
std::string small_recording(const std::string& folder) {
  using namespace wholehand;
  device::RecordingInfo info;
  info.scene_name = "bench";
  info.device.name = "omega.7";
  info.vessels = {{"one", "water", 2}};
  std::vector<device::Tick> ticks(1500);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    ticks[k].number = static_cast<std::int64_t>(k);
    ticks[k].state = k < 500 ? device::SessionState::free : device::SessionState::lift;
    ticks[k].vessel = k < 500 ? -1 : 0;
    ticks[k].user_force = 3;
  }
  const std::string path = folder + "/session.nc";
  device::RecordingWriter writer(path, info);
  writer.append(ticks);
  writer.finish({});
  return path;
}

TEST(CommandLine, ReportsASession) {
  const wholehand::TemporaryFolder temporary;
  const std::string& folder = temporary.path();
  const std::string path = small_recording(folder);
  const Outcome table = run("PROGRAM session " + path + " 2>&1");
  EXPECT_EQ(table.code, 0) << table.output;
  EXPECT_EQ(table.output.find("Session of 1.500 s in bench, on omega.7, 1,000 Hz"), 0u) << table.output;
  const Outcome json = run("PROGRAM session " + path + " --json -o " + folder + "/out 2>&1");
  EXPECT_EQ(json.code, 0) << json.output;
  const auto report = parse_json(json.output);
  EXPECT_EQ(report["grasps"][0]["vessel"], "one");
  EXPECT_EQ(report["grasps"][0]["duration_s"]["lift"], 1);
  EXPECT_EQ(report["grasps"][0]["grip_before_N"]["mean"], 3);
  for (const char* name : {"session.csv", "states.csv", "session.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder + "/out/" + name)) << name;
  // over its own files, and over nobody else's
  EXPECT_EQ(run("PROGRAM session " + path + " -o " + folder + "/out 2>&1").code, 0);
  for (const char* name : {"session.csv", "states.csv", "session.svg"}) {
    const std::string other = folder + "/other_" + name;
    std::filesystem::create_directory(other);
    std::ofstream(other + "/" + name) << "mine";
    expect_error("session " + path + " -o " + other, 2, std::string(name) + ": is there and is no ");
    EXPECT_EQ(std::filesystem::file_size(other + "/" + name), 4u);
  }
  // cut off in its last records: a note, and what is there
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1000);
  const Outcome cut = run("PROGRAM session " + path + " 2>&1 >/dev/null");
  EXPECT_EQ(cut.code, 0);
  EXPECT_EQ(cut.output, "wholehand: " + path + " is cut off: 1,498 of 1,500 ticks are there\n");
  std::filesystem::resize_file(path, 3000);
  expect_error("session " + path, 2, path + ": its header is cut off or damaged");
  expect_error("session " + path + " --json -o " + folder + "/out", 2, path + ": its header is cut off or damaged");
}

TEST(CommandLine, WritesAPageForASweep) {
  const wholehand::TemporaryFolder temporary;
  const std::string& folder = temporary.path();
  const std::string result = folder + "/s.nc", page = folder + "/s.html";
  ASSERT_EQ(run("PROGRAM sweep small --on core -o " + result + " 2>&1").code, 0);
  const Outcome named = run("PROGRAM report " + result);
  EXPECT_EQ(named.code, 0) << named.output;
  EXPECT_EQ(named.output.find("wrote " + page + " ("), 0u) << named.output;
  EXPECT_EQ(named.output.find('\n'), named.output.size() - 1) << named.output;
  EXPECT_GT(std::filesystem::file_size(page), 10000u);
  // over an earlier page, and over nothing else
  EXPECT_EQ(run("PROGRAM report " + result + " -o " + page + " 2>&1").code, 0);
  const auto size = std::filesystem::file_size(result);
  expect_error("report " + result + " -o " + result, 2, "this is the result file itself");
  expect_error("report " + result + " -o " + folder + "/s.best.csv", 2, "is no page of wholehand's");
  expect_error("report " + result + " -o " + folder, 2, "is a directory; name a file");
  expect_error("report " + result + " -o /nonexistent/a.html", 2, "/nonexistent is not a directory");
  EXPECT_EQ(std::filesystem::file_size(result), size);
  // what was cut off, what is no sweep's, what was not finished
  std::filesystem::remove(page);
  expect_error("report " + small_recording(folder), 2, "wholehand session");
  std::filesystem::copy_file(result, folder + "/t.nc");
  std::filesystem::resize_file(folder + "/t.nc", size / 2);
  expect_error("report " + folder + "/t.nc", 2, "is damaged");
  std::filesystem::rename(result, result + ".partial");
  expect_error("report " + result, 2, "was not finished; finish it with wholehand sweep --resume");
  EXPECT_FALSE(std::filesystem::exists(page));
}

TEST(CommandLine, StiffestWallOfADevice) {
  const Outcome json =
      run("PROGRAM stability wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000 --encoder-um 20 --coulomb-N 0.015 --json");
  EXPECT_EQ(json.code, 0) << json.output;
  const auto limits = parse_json(json.output);
  EXPECT_EQ(limits.size(), 4u);
  EXPECT_NEAR(limits["passive_K_Npm"].get<double>(), 2000, 1e-6);
  EXPECT_NEAR(limits["linear_K_Npm"].get<double>(), 2003.3, 0.1);
  EXPECT_NEAR(limits["coulomb_K_Npm"].get<double>(), 1500, 1e-6);
  EXPECT_GT(limits["largest_stable_K_Npm"].get<double>(), 1500);
  const Outcome table = run("PROGRAM stability wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000 --wall-damping-Nspm 0.5");
  EXPECT_NE(table.output.find("2,990.1"), std::string::npos) << table.output;
}

TEST(CommandLine, EvaluatesOneGrip) {
  const Outcome table = run("PROGRAM " + std::string(SMALL_GRIP) + " --fill 0.3 0.6 --tilt-deg 0 10 20 2>&1");
  EXPECT_EQ(table.code, 0) << table.output;
  EXPECT_NE(table.output.find("Grip of tumbler in small, on core, double"), std::string::npos) << table.output;
  EXPECT_NE(table.output.find("feasible       yes"), std::string::npos) << table.output;

  const Outcome json = run("PROGRAM " + std::string(SMALL_GRIP) + " --fill 0.3 0.6 --tilt-deg 0 10 20 --json 2>&1");
  EXPECT_EQ(json.code, 0) << json.output;
  const auto grip = parse_json(json.output);
  ASSERT_EQ(grip["states"].size(), 6u);
  EXPECT_EQ(grip["states"][1]["fill"], 0.3);
  EXPECT_EQ(grip["states"][5]["fill"], 0.6);
  const Outcome in_ml = run("PROGRAM " + std::string(SMALL_GRIP) + " --fill-ml 100 --tilt-deg 0 --json 2>&1");
  EXPECT_NEAR(parse_json(in_ml.output)["states"][0]["liquid_volume_m3"].get<double>(), 100e-6, 1e-15);
  EXPECT_DOUBLE_EQ(grip["states"][4]["tilt_rad"].get<double>(), 10 * 3.14159265358979323846 / 180);

  // a grip that is not feasible is an answer, and the answer is no
  const Outcome wide = run("PROGRAM " + std::string(SMALL_GRIP) + " --hand-scale 0.2 --json 2>&1");
  EXPECT_EQ(wide.code, 1);
  EXPECT_EQ(parse_json(wide.output)["reason"], "too_wide");
  EXPECT_EQ(run("PROGRAM " + std::string(SMALL_GRIP) + " --hand-scale 0.2").code, 1);

  // but there is no hand to draw: nothing is written
  const wholehand::TemporaryFolder folder;
  const std::string drawing = folder / "drawing";
  for (const char* option : {"--glb", "--svg"}) {
    expect_error(std::string(SMALL_GRIP) + " --hand-scale 0.2 " + option + " " + drawing, 2, "not feasible (too_wide)");
    EXPECT_FALSE(std::filesystem::exists(drawing)) << option;
  }

  // a device that computes says which it is, without disturbing what reads the object
  const Outcome device = run("PROGRAM " + std::string(SMALL_GRIP) + " --on vulkan --json 2>&1 >/dev/null");
  EXPECT_EQ(device.code, 0);
  EXPECT_EQ(device.output.rfind("wholehand: on ", 0), 0u) << device.output;

  // two points of the same line
  const Outcome direct =
      run("PROGRAM grip three_beakers --vessel beaker1 --height-mm 50 --azimuth-deg 90 --roll-deg -45 --tilt-deg 30 --json");
  const Outcome points =
      run("PROGRAM grip three_beakers --vessel beaker1 --thumb-mm 0,50,40 --index-mm 0,50,-40 --roll-deg -45 --tilt-deg 30 --json");
  EXPECT_EQ(parse_json(direct.output), parse_json(points.output));
}

// A copy of the program with shipped scenes of its own, whatever a package has installed. None of these scenes has places.
TEST(CommandLine, NamesNoScenesWithPlacesWhereThereAreNone) {
  const wholehand::TemporaryFolder folder;
  const std::string text = wholehand::file_text(wholehand::find_scene("three_beakers")), program = folder / "bin/wholehand";
  std::filesystem::create_directories(folder / "bin");
  std::filesystem::create_directories(folder / "share/wholehand/scenes");
  std::filesystem::copy_file(WHOLEHAND_PROGRAM, program);
  wholehand::write_file(folder / "share/wholehand/scenes/three_beakers.toml", text);
  wholehand::write_file(folder / "two.toml", text);
  EXPECT_TRUE(run(program + " scenes 2>&1").output.starts_with("three_beakers")) << "another program's scenes";
  const Outcome outcome = run(program + " live " + (folder / "two.toml") + " 2>&1");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(outcome.output.ends_with("a live session needs place_mm for each\n")) << outcome.output;
}

TEST(CommandLine, DrawsAGrip) {
  const wholehand::TemporaryFolder temporary;
  const std::string& folder = temporary.path();
  const auto head_of = [](const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string head(4, ' ');
    file.read(head.data(), 4);
    return head;
  };
  const std::string plain = run("PROGRAM " + std::string(SMALL_GRIP) + " --json").output;
  const Outcome drawn =
      run("PROGRAM " + std::string(SMALL_GRIP) + " --json --glb " + folder + "/a.glb --svg " + folder + "/a.svg 2>&1");
  EXPECT_EQ(drawn.code, 0);
  EXPECT_EQ(drawn.output, plain);
  EXPECT_EQ(head_of(folder + "/a.glb"), "glTF");
  EXPECT_EQ(head_of(folder + "/a.svg"), "<svg");
  const std::string scene = folder + "/scene.toml";
  std::ofstream(scene) << "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 100\nwall_mm = 2\n";
  expect_error("grip " + scene + " --vessel v --height-mm 50 --glb " + folder + "/../" + folder.substr(folder.rfind('/') + 1) +
                   "/scene.toml",
               2, "this is the scene file itself");
  // what is there stays, unless it is a drawing
  const std::string notes = folder + "/notes";
  std::ofstream(notes) << "not to be lost";
  expect_error(std::string(SMALL_GRIP) + " --svg " + notes, 2, "is there and is no drawing of wholehand's");
  expect_error(std::string(SMALL_GRIP) + " --glb " + notes, 2, "is there and is no glTF binary of wholehand's");
  std::ofstream(notes) << "<svg><title>not to be lost</title></svg>";
  expect_error(std::string(SMALL_GRIP) + " --svg " + notes, 2, "is there and is no drawing of wholehand's");
  EXPECT_EQ(head_of(notes), "<svg");
  const Outcome again = run("PROGRAM " + std::string(SMALL_GRIP) + " --svg " + folder + "/a.svg 2>&1");
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_NE(again.output.find("wrote " + folder + "/a.svg\n"), std::string::npos) << again.output;
  const Outcome sweep = run("PROGRAM sweep small --on core --best 3 --glb 2 -o " + folder + "/s.nc 2>&1");
  EXPECT_EQ(sweep.code, 0) << sweep.output;
  EXPECT_NE(sweep.output.find("s.tumbler.1.glb .. "), std::string::npos) << sweep.output;
  EXPECT_EQ(head_of(folder + "/s.tumbler.2.glb"), "glTF");
  EXPECT_FALSE(std::filesystem::exists(folder + "/s.tumbler.3.glb"));
}

// Where liquid would stand in a solid stem, every command says so that evaluates the scene.
TEST(CommandLine, ACavityThatReachesIntoAStemIsNoted) {
  const wholehand::TemporaryFolder temporary;
  const std::string& folder = temporary.path();
  const std::string scene = folder + "/wine.toml";
  std::ofstream(scene)
      << "[liquid]\nfills_ml = [0, 120]\n[[vessel]]\nname = \"wine\"\noutline = [{ line = [35, 0] }, { line = [35, 3] }, { line = "
         "[5, 6] }, { line = [5, 80] }, { arc_through = [39, 110], to = [34, 140] }, { line = [0, 140] }]\nwall_mm = 2\n";
  for (const std::string& command :
       {"grip " + scene + " --vessel wine --height-mm 110", "sweep " + scene + " --on core -o " + folder + "/w.nc",
        "check " + scene, "live " + scene + " --no-clock --seconds 0.01"}) {
    const Outcome outcome = run("PROGRAM " + command + " 2>&1 >" + folder + "/out.txt");
    const std::string note = "note: vessel 'wine': its cavity narrows to a radius of 3 mm at ";
    EXPECT_NE(outcome.output.find(note), std::string::npos) << command << ": " << outcome.output;
    EXPECT_EQ(outcome.output.find(note), outcome.output.rfind(note)) << "once";
  }
}

}  // namespace

#endif
