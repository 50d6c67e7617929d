// SPDX-License-Identifier: MIT
// The best grips of a sweep as glTF: which files there are, and what is in them.
// sanitizers: address
#include "sweeps/result/best_glb.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <tiny_gltf.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "sweeps/result/output_names.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace wholehand::sweeps {
namespace {

namespace fs = std::filesystem;

class BestGlbTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "wholehand_best_glb_XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder = name;
  }
  void TearDown() override { fs::remove_all(folder); }

  std::vector<std::string> there() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  fs::path folder;
};

// The height in the file's extras, m.
double height_in(const fs::path& path) {
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, path)) << error;
  for (const tinygltf::Node& node : model.nodes) {
    if (node.name == "grip") return node.extras.Get("grip").Get("height_m").GetNumberAsDouble();
  }
  return 0;
}

BestGrip at_height(double height, std::size_t rank = 1) {
  BestGrip best;
  best.rank = rank;
  best.grip = {height, 0, 0, 0, 0, 1};
  return best;
}

TEST_F(BestGlbTest, AFileForEachVesselAndRank) {
  Scene scene = three_beakers();
  scene.vessels.resize(2);
  scene.vessels[0].name = scene.vessels[1].name = "a b";
  const auto names = output_names(folder / "out.nc");
  const BestGlb written = write_best_glb(scene, Plan(scene, false), make_core_evaluator(scene),
                                         {{at_height(0.05), at_height(0.06, 2), at_height(0.07, 3)}, {at_height(0.055)}}, 2, names);
  EXPECT_EQ(there(), (std::vector<std::string>{"out.a_b.1.glb", "out.a_b.2.glb", "out.a_b_2.1.glb"}));
  EXPECT_EQ(height_in(folder / "out.a_b.1.glb"), 0.05);
  EXPECT_EQ(height_in(folder / "out.a_b.2.glb"), 0.06);
  EXPECT_EQ(height_in(folder / "out.a_b_2.1.glb"), 0.055);
  EXPECT_EQ(written.files,
            (std::vector<std::string>{(folder / "out.a_b.1.glb").string() + " .. " + (folder / "out.a_b.2.glb").string(),
                                      folder / "out.a_b_2.1.glb"}));
  EXPECT_TRUE(written.notes.empty());
}

TEST_F(BestGlbTest, AFileForEachHandScale) {
  Scene scene = three_beakers();
  scene.vessels.resize(1);
  scene.grips.hand_scale.values = {1, 0.9};
  const BestGlb written = write_best_glb(scene, Plan(scene, false), make_core_evaluator(scene),
                                         {{at_height(0.05)}, {at_height(0.06)}}, 2, output_names(folder / "out.nc"));
  EXPECT_EQ(there(), (std::vector<std::string>{"out.beaker1.hand0.9.1.glb", "out.beaker1.hand1.1.glb"}));
  EXPECT_EQ(height_in(folder / "out.beaker1.hand0.9.1.glb"), 0.06);
  EXPECT_TRUE(written.notes.empty());
}

TEST_F(BestGlbTest, MeshVesselsToo) {
  const Scene scene = scene_of({vessel_of_mesh("mesh", turned_mesh(beaker1(), 48, 4e-3), 4e-3)});
  const BestGlb written = write_best_glb(scene, Plan(scene, false), make_core_evaluator(scene), {{at_height(0.05)}}, 5,
                                         output_names(folder / "out.nc"));
  EXPECT_EQ(there(), (std::vector<std::string>{"out.mesh.1.glb"}));
  EXPECT_EQ(height_in(folder / "out.mesh.1.glb"), 0.05);
  EXPECT_TRUE(written.notes.empty());
}

TEST_F(BestGlbTest, WhatOnlyTheSweepsPrecisionHoldsIsLeftOut) {
  Scene scene = three_beakers();
  scene.vessels.resize(1);
  const BestGlb written = write_best_glb(scene, Plan(scene, false), make_core_evaluator(scene),
                                         {{at_height(0.3), at_height(0.05, 2)}}, 5, output_names(folder / "out.nc"));
  EXPECT_EQ(there(), (std::vector<std::string>{"out.beaker1.2.glb"}));
  ASSERT_EQ(written.notes.size(), 1u);
  EXPECT_NE(written.notes[0].find("out.beaker1.1.glb is not written: the core finds that the grip is not feasible (misses)"),
            std::string::npos);
}

}  // namespace
}  // namespace wholehand::sweeps
