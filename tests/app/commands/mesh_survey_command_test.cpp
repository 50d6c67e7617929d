// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// `wholehand mesh` writes a scene that sweeps as it is, and refuses in one line without writing anything.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "base/files/json.h"
#include "core/capacity.h"
#include "core/reader/reader.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/program.h"
#include "tests/support/vessel_models.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

class MeshSurveyCommand : public testing::Test {
 protected:
  MeshSurveyCommand() {
    write_file(folder_ / "cup.stl", stl_text(in_unit(z_up(vessel_model("tapered_cup").mesh), 0.001)));
    write_file(folder_ / "pair.obj", obj_text(vessel_model("cup_and_saucer").mesh));
  }
  Outcome run_in(const std::string& command) const {
    return run("cd " + folder_.path() + " && XDG_CACHE_HOME=" + folder_.path() + "/cache PROGRAM " + command + " 2>&1");
  }
  void expect_refused(const std::string& arguments, const std::string& words) const {
    const Outcome refused = run_in(arguments);
    EXPECT_EQ(refused.code, 2) << arguments;
    EXPECT_TRUE(has(refused.output, words)) << arguments << ": " << refused.output;
    EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
  }

  TemporaryFolder folder_;
};

TEST_F(MeshSurveyCommand, WritesASceneThatSweepsAndItsPicture) {
  const Outcome said = run_in("mesh cup.stl -o scene.toml");
  ASSERT_EQ(said.code, 0) << said.output;
  EXPECT_TRUE(has(said.output, "mesh_scale = 0.001: millimeters")) << said.output;
  EXPECT_TRUE(has(said.output, "up: +z")) << said.output;
  const Scene scene = read_scene_file(folder_ / "scene.toml");
  const double capacity = vessel_model("tapered_cup").capacity;
  EXPECT_NEAR(capacity_of(scene.vessels[0]), capacity, 0.01 * capacity);
  EXPECT_TRUE(has(file_text(folder_ / "scene.svg"), "Section through the axis"));
  const Outcome swept = run_in("sweep scene.toml --on core --no-refine -o scene.nc");
  EXPECT_EQ(swept.code, 0) << swept.output;
  EXPECT_FALSE(has(swept.output, "not judged")) << swept.output;
  // what is there stays
  expect_refused("mesh cup.stl -o scene.toml", "scene.toml");
}

TEST_F(MeshSurveyCommand, SaysWhatReadmeShows) {
  write_file(folder_ / "mug.stl", stl_text(in_unit(z_up(vessel_model("mug_with_handle").mesh), 0.001)));
  const Outcome said = run_in("mesh mug.stl -o mug.toml");
  ASSERT_EQ(said.code, 0) << said.output;
  std::istringstream readme(file_text(WHOLEHAND_SOURCE_DIR "/README.md"));
  std::string line;
  while (std::getline(readme, line) && !has(line, "wholehand mesh mug.stl")) continue;
  int lines = 0;
  for (; std::getline(readme, line) && line.starts_with("    "); ++lines) {
    if (line == "    ..") continue;  // lines that README leaves out
    EXPECT_TRUE(has(said.output, line.substr(4) + "\n")) << line << "\n" << said.output;
  }
  EXPECT_GE(lines, 5);
}

TEST_F(MeshSurveyCommand, NewTakesTheSameKeysAndOverrulesThem) {
  ASSERT_EQ(run_in("mesh cup.stl -o first.toml").code, 0);
  ASSERT_EQ(run_in("new second --mesh cup.stl --fill-ml 100 --density-kg-m3 1050").code, 0);
  const Scene first = read_scene_file(folder_ / "first.toml"), second = read_scene_file(folder_ / "second.toml");
  EXPECT_EQ(capacity_of(first.vessels[0]), capacity_of(second.vessels[0]));
  EXPECT_EQ(second.vessels[0].density, 1050);
  EXPECT_EQ(second.liquid->volumes.back(), 100e-6);
}

TEST_F(MeshSurveyCommand, PrintsJsonAndObeysOptions) {
  const Outcome said = run_in("mesh pair.obj --part 2 --scale 1 --up y --json");
  ASSERT_EQ(said.code, 0) << said.output;
  const nlohmann::json json = parse_json(said.output);
  EXPECT_EQ(json["keys"]["part"], "2");
  EXPECT_EQ(json["keys"]["up"], "\"y\"");
  EXPECT_EQ(json["reasons"]["mesh_scale"], "");
}

TEST_F(MeshSurveyCommand, RefusesInOneLineAndWritesNothing) {
  expect_refused("mesh none.stl", "none.stl");
  expect_refused("mesh cup.stl --up w", "--up 'w'; allowed: y or z");
  expect_refused("mesh cup.stl --scale 0", "--scale '0'; allowed");
  expect_refused("mesh cup.stl --part 3", "part = 3: it has 1 part");
  expect_refused("mesh pair.obj --thickness-mm 2", "thickness_mm: no edge is open");
  expect_refused("mesh cup.stl -o scene.txt", "a name that ends in .toml");
  expect_refused("mesh cup.stl -o '9 cups.toml'", "'9 cups'");
  expect_refused("mesh cup.stl -o no/folder/cup.toml", "no/folder");
  EXPECT_EQ(run("ls " + folder_.path() + " | grep -v cache | wc -l").output, "2\n");
}

}  // namespace
}  // namespace wholehand

#endif
