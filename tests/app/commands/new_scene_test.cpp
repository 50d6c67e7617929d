// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// A new scene sweeps as it is, its numbers are those that were given, and nothing is overwritten.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/capacity.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "sweeps/plan/idle_notes.h"
#include "sweeps/plan/plan.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/program.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

Outcome run_in(const TemporaryFolder& folder, const std::string& command) {
  return run("cd " + folder.path() + " && PROGRAM " + command + " 2>&1");
}

void expect_refused(const TemporaryFolder& folder, const std::string& arguments, const std::string& words) {
  const Outcome refused = run_in(folder, arguments);
  EXPECT_EQ(refused.code, 2) << arguments;
  EXPECT_NE(refused.output.find(words), std::string::npos) << arguments << ": " << refused.output;
}

TEST(NewScene, HasWhatWasGivenAndLeavesNothingUnjudged) {
  const TemporaryFolder folder;
  const Outcome written = run_in(folder, "new cup --diameter-mm 70 --height-mm 120 --wall-mm 2 --fill-ml 250");
  EXPECT_EQ(written.code, 0) << written.output;
  const Scene scene = read_scene_file(folder / "cup.toml");
  ASSERT_EQ(scene.vessels.size(), 1u);
  EXPECT_EQ(scene.name, "cup");
  EXPECT_EQ(scene.vessels[0].name, "cup");
  ASSERT_EQ(scene.liquid->volumes.size(), 2u);
  EXPECT_DOUBLE_EQ(scene.liquid->volumes[1], 250e-6);
  const double within = M_PI * 0.033 * 0.033 * 0.118;  // of the wall and the floor, m3
  EXPECT_NEAR(capacity_of(scene.vessels[0]), within, 1e-6 * within);
  EXPECT_NE(written.output.find("a vessel that holds 404 mL"), std::string::npos) << written.output;
  EXPECT_TRUE(sweeps::idle_notes(scene, sweeps::Plan(scene, false), static_cast<std::size_t>(scene.output.best)).empty());
  ASSERT_EQ(run_in(folder, "new empty --diameter-mm 70 --height-mm 120 --fill-ml 0").code, 0);
  EXPECT_EQ(read_scene_file(folder / "empty.toml").liquid->volumes, std::vector<double>{0});
}

TEST(NewScene, EveryShapeAndAMeshSweep) {
  const TemporaryFolder folder;
  write_file(folder / "bar.stl", stl_text(turned_mesh(read_scene_file(find_scene("three_beakers")).vessels[0], 48, 1e-3)));
  for (const std::string& made :
       {std::string("--diameter-mm 70 --height-mm 120"), std::string("--shape flask --diameter-mm 85 --neck-mm 34 --height-mm 140"),
        std::string("--shape conical --diameter-mm 85 --upright-mm 4 --neck-mm 34 --shoulder-mm 105 --height-mm 145"),
        std::string("--mesh bar.stl --mass-kg 0.2")}) {
    const Outcome written = run_in(folder, "new cup " + made);
    EXPECT_EQ(written.code, 0) << made << written.output;
    const Outcome swept = run_in(folder, "sweep cup.toml --on core --no-refine -o cup.nc");
    EXPECT_EQ(swept.code, 0) << made << swept.output;
    EXPECT_EQ(swept.output.find("not judged"), std::string::npos) << swept.output;
    run("rm " + folder.path() + "/cup.*");
  }
}

TEST(NewScene, RefusesInOneLineAndWritesNothing) {
  const TemporaryFolder folder;
  expect_refused(folder, "new cup --diameter-mm 70", "lacks 'height_mm'");
  expect_refused(folder, "new cup --diameter-mm 70 --height-mm 120 --fill-ml 5000", "new: ");
  expect_refused(folder, "new cup --diameter-mm 0 --height-mm 120", "--diameter-mm '0'; allowed: a number, 1 to 10000");
  expect_refused(folder, "new cup --diameter-mm 70 --height-mm 120 --shape vase", "shape");
  expect_refused(folder, "new cup --shape flask --diameter-mm 70 --neck-mm 80 --height-mm 120", "neck_mm");
  expect_refused(folder, "new '9 cups' --diameter-mm 70 --height-mm 120", "'9 cups'");
  expect_refused(folder, "new cup --mesh none.ply", "none.ply");
  expect_refused(folder, "new no/folder/cup --diameter-mm 70 --height-mm 120", "no/folder");
  EXPECT_EQ(run("ls " + folder.path() + " | wc -l").output, "0\n");
}

TEST(NewScene, NothingIsOverwritten) {
  const TemporaryFolder folder;
  write_file(folder / "cup.toml", "mine");
  write_file(folder / "small.toml", "mine");
  expect_refused(folder, "new cup --diameter-mm 70 --height-mm 120", "cup.toml: the file exists and is not overwritten");
  expect_refused(folder, "scenes --copy small", "small.toml: the file exists and is not overwritten");
  EXPECT_EQ(file_text(folder / "cup.toml"), "mine");
  EXPECT_EQ(file_text(folder / "small.toml"), "mine");
}

TEST(NewScene, ACopyIsTheShippedScene) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_in(folder, "scenes --copy three_beakers").code, 0);
  EXPECT_EQ(read_scene_file(folder / "three_beakers.toml").text, read_scene_file(find_scene("three_beakers")).text);
  expect_refused(folder, "scenes --copy nosuch", "shipped scenes: ");
}

}  // namespace
}  // namespace wholehand

#endif
