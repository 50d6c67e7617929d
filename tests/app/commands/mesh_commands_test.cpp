// SPDX-License-Identifier: MIT
// The built program on scenes with meshes: what each command says and does, and what it refuses.
// sanitizers: address
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/program.h"
#include "tests/support/result_reader.h"
#include "tests/support/scenes.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

class MeshCommands : public testing::Test {
 protected:
  MeshCommands() : cache_("XDG_CACHE_HOME", (folder_ / "cache").c_str()) {
    write("cup.glb", glb_text(turned_mesh(beaker3(), 64, 2e-3)));
    write("cup.toml", SCENE);
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name, std::ios::binary) << text; }
  std::string path(const std::string& name) const { return folder_ / name; }

  static constexpr const char* SCENE = R"(
[[vessel]]
name = "cup"
mesh = "cup.glb"
grid_mm = 2
inner_outline = [{ line = [0, 2] }, { line = [38, 2] }, { line = [15, 104] }, { line = [15, 145] }]
[liquid]
fills = [0, 0.5]
[grips]
azimuth_deg = [0, 90]
height_mm = { from = 30, to = 60, count = 4 }
[tilts]
deg = [0, 30, 60]
)";

  TemporaryFolder folder_;
  ScopedVariable cache_;
};

TEST_F(MeshCommands, GripSaysWhatTheMeshIsAndAnswers) {
  const std::string grip = "grip " + path("cup.toml") + " --vessel cup --height-mm 40 --json";
  const Outcome said = run("PROGRAM " + grip + " 2>&1 >/dev/null");
  EXPECT_EQ(said.code, 0) << said.output;
  for (const char* part :
       {"vessel 'cup': cup.glb: ", " triangles, ", "closed", "lattice of 2 mm", "less the cavity", "holds liquid"})
    EXPECT_NE(said.output.find(part), std::string::npos) << part << " in\n" << said.output;
  const auto core = parse_json(run("PROGRAM " + grip + " 2>/dev/null").output),
             device = parse_json(run("PROGRAM " + grip + " --on vulkan 2>/dev/null").output);
  EXPECT_TRUE(core["feasible"]);
  // the conical flask at 40 mm: 85 mm at the base, 34 mm at 105 mm, from 4 mm on
  const double diameter = 0.085 - (0.085 - 0.034) * (40.0 - 4) / (105 - 4);
  EXPECT_NEAR(core["gap_m"].get<double>(), diameter + 0.018, 3e-3) << "and the pads, aslant";
  EXPECT_NEAR(device["gap_m"].get<double>(), core["gap_m"].get<double>(), 10e-6);
  EXPECT_EQ(core["states"].size(), 6u);
  EXPECT_GT(core["states"][3]["liquid_volume_m3"], 50e-6);
}

TEST_F(MeshCommands, ADrawingNeverTakesTheMeshsPlace) {
  const auto size = std::filesystem::file_size(path("cup.glb"));
  expect_error("grip " + path("cup.toml") + " --vessel cup --height-mm 40 --glb " + path("cup.glb"), 2,
               "this is the mesh of vessel 'cup'");
  EXPECT_EQ(std::filesystem::file_size(path("cup.glb")), size);
}

TEST_F(MeshCommands, SweepAndCheckRunOnTheLattice) {
  const std::string result = path("cup.nc");
  const Outcome swept = run("PROGRAM sweep " + path("cup.toml") + " -o " + result + " --wide 2>&1");
  EXPECT_EQ(swept.code, 0) << swept.output;
  EXPECT_NE(swept.output.find("8 of 8 grips feasible"), std::string::npos) << swept.output;
  EXPECT_NE(read_text(result, "", "meshes").find("vessel 'cup': lattice of 2 mm"), std::string::npos);
  EXPECT_EQ(read_text(result, "", "mesh_keys").size(), 32u);
  EXPECT_EQ(read_text(result, "", "scene_file"), std::filesystem::absolute(path("cup.toml")).lexically_normal());
  const Outcome checked = run("PROGRAM check " + path("cup.toml") + " 2>&1");
  EXPECT_EQ(checked.code, 0) << checked.output;
}

TEST_F(MeshCommands, WithoutItsMeshAResultIsRankedHoweverNearTheGripsAre) {
  const std::string result = path("cup.nc");
  ASSERT_EQ(run("PROGRAM sweep " + path("cup.toml") + " --on core -o " + result + " >/dev/null 2>&1").code, 0);
  EXPECT_EQ(run("PROGRAM rank " + result + " >/dev/null").code, 0);
  std::filesystem::remove(path("cup.glb"));
  expect_error("rank " + result, 2, "--apart-mm 0 lists grips without it, however near they are to each other");
  const Outcome near = run("PROGRAM rank " + result + " --apart-mm 0 2>&1");
  EXPECT_EQ(near.code, 0) << near.output;
  EXPECT_NE(near.output.find("\n  8 grips are feasible and plausible\n"), std::string::npos) << near.output;
  EXPECT_NE(near.output.find(
                "cup.glb: there is no such file; tips_worst_effort, push, friction_needed and the hold force are left empty"),
            std::string::npos)
      << near.output;
}

TEST_F(MeshCommands, AResultThatMovedWithItsMeshIsReadAsBefore) {
  const std::string session =
      "live " + path("cup.toml") + " --device sim --no-clock --seconds 1 --record " + path("cup.session.nc");
  ASSERT_EQ(run("PROGRAM sweep " + path("cup.toml") + " --on core -o " + path("cup.nc") + " >/dev/null 2>&1").code, 0);
  ASSERT_EQ(run("PROGRAM " + session + " >/dev/null 2>&1").code, 0);
  std::filesystem::create_directory(path("moved"));
  for (const char* file : {"cup.nc", "cup.toml", "cup.glb", "cup.session.nc"})
    std::filesystem::rename(path(file), path(std::string("moved/") + file));
  const std::string result = path("moved/cup.nc");
  const auto expect_done = [this](const std::string& arguments) {
    const Outcome outcome = run("PROGRAM " + arguments + " 2>&1");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
  };
  expect_done("rank " + result);
  expect_done("grip " + result + " --vessel cup --rank 1");
  expect_done("live --device replay:" + path("moved/cup.session.nc") + " --no-clock");
  expect_done("report " + result);
  EXPECT_EQ(file_text(path("moved/cup.html")).find("This part is left out: "), std::string::npos);
  expect_error("rank " + result + " -o " + path("moved/cup.toml"), 2, "moved/cup.toml");
}

TEST_F(MeshCommands, AResultOfAnotherMeshIsNotComplete) {
  const std::string sweep = "sweep " + path("cup.toml") + " --on core --resume -o " + path("cup.nc");
  ASSERT_EQ(run("PROGRAM " + sweep + " >/dev/null 2>&1").code, 0);
  const Outcome again = run("PROGRAM " + sweep + " 2>&1");
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_NE(again.output.find("is complete, so nothing is left to do"), std::string::npos) << again.output;
  write("cup.glb", glb_text(turned_mesh(beaker3(), 48, 2e-3)));
  expect_error(sweep, 2,
               "--resume: " + path("cup.nc") +
                   " is complete, but the mesh files are not what they were when the sweep ran; name another file, or start again "
                   "without --resume");
  std::filesystem::remove(path("cup.glb"));
  expect_error(sweep, 2, "cup.glb");
}

TEST_F(MeshCommands, ASessionHoldsAMesh) {
  const Outcome live = run("PROGRAM live " + path("cup.toml") + " --device sim --no-clock --seconds 10 2>&1");
  EXPECT_EQ(live.code, 0) << live.output;
  EXPECT_NE(live.output.find("cup is held at"), std::string::npos) << live.output;
}

TEST_F(MeshCommands, RefusesBadFilesInOneLineAndWritesNothing) {
  const std::string good = glb_text(turned_mesh(beaker3(), 64, 2e-3));
  std::string version = good;
  version[4] = 3;
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "empty"},
      {good.substr(0, good.size() / 2), "cup.glb"},
      {"not a mesh at all", "cup.glb"},
      {version, "version"},
      {glb_text(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}}), "triangles"}};
  for (const auto& [text, gist] : cases) {
    write("cup.glb", text);
    for (const std::string& command : {"grip " + path("cup.toml") + " --vessel cup --height-mm 40 --glb " + path("out.glb"),
                                       "sweep " + path("cup.toml") + " -o " + path("out.nc")}) {
      expect_error(command, 2, path("cup.toml") + ":4:8: ");
      expect_error(command, 2, gist);
    }
  }
  EXPECT_FALSE(file_exists(path("out.glb")) || file_exists(path("out.nc")) || file_exists(path("out.nc.partial")));
  std::filesystem::remove(path("cup.glb"));
  expect_error("check " + path("cup.toml"), 2, "cup.glb");
  expect_error("sweep " + path("cup.toml") + " -o /nonexistent/out.nc", 2, "/nonexistent");
}

}  // namespace
}  // namespace wholehand

#endif
