// SPDX-License-Identifier: MIT
#include "sweeps/result/result_contents.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/text/error.h"
#include "tests/support/fake_backend.h"
#include "tests/support/files.h"
#include "tests/support/result_reader.h"

namespace wholehand::sweeps {
namespace {

// A defined file with nothing of the grips in it.
class ResultContentsTest : public testing::Test {
 protected:
  std::string define(const Scene& scene, Precision precision = Precision::full, std::size_t best = 4) {
    const auto variables = choose_variables(scene);
    const Plan plan(scene, keeps_vectors(variables));
    FakeBackend backend(scene, make_field_set(variable_fields(variables), scene), precision, 100);
    const ResultContents contents{scene,          plan,    variables, vessel_facts(scene, backend, FakeEvaluator(scene)),
                                  backend.info(), "1.2.3", best};
    const std::string path = folder / ("file" + std::to_string(++files) + ".nc");
    define_result_file(path, contents);
    return path;
  }

  TemporaryFolder folder;
  int files = 0;
};

std::string dump(const std::string& path) {
  FILE* pipe = popen(("ncdump -h " + path + " 2>&1").c_str(), "r");
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  EXPECT_EQ(pclose(pipe), 0) << text;
  return text;
}

TEST_F(ResultContentsTest, EveryVariableHasUnitsNameAndFill) {
  const std::string path = define(fake_scene());
  const std::string text = dump(path);
  for (const std::string& name : variable_names(path)) {
    EXPECT_NE(text.find("\t\t" + name + ":long_name = "), std::string::npos) << name;
    if (text.find("\tstring " + name + "(") != std::string::npos) continue;
    EXPECT_NE(text.find("\t\t" + name + ":units = "), std::string::npos) << name;
    const bool is_real = text.find("\tdouble " + name + "(") != std::string::npos;
    if (is_real) {
      EXPECT_NE(text.find("\t\t" + name + ":_FillValue = "), std::string::npos) << name;
    }
  }
}

TEST_F(ResultContentsTest, DimensionsAreTheScenesAxes) {
  const std::string path = define(fake_scene());
  EXPECT_EQ(dimension_names(path, "score"),
            (std::vector<std::string>{"vessel", "azimuth", "obliquity", "roll", "offset", "hand_scale", "height_fraction"}));
  EXPECT_EQ(
      dimension_names(path, "peak_feedback_force"),
      (std::vector<std::string>{"vessel", "fill", "azimuth", "obliquity", "roll", "offset", "hand_scale", "height_fraction"}));
  EXPECT_EQ(dimension_names(path, "poured_volume"), (std::vector<std::string>{"vessel", "fill", "tilt"}));
  EXPECT_EQ(read_values(path, "roll"), fake_scene().grips.roll.values);
  EXPECT_EQ(read_values(path, "tilt"), fake_scene().tilts);
  EXPECT_EQ(read_values(path, "azimuth").size(), 3u) << "all of them, though one is evaluated";
  EXPECT_EQ(read_text(path, "roll", "units"), "rad");

  Scene scene = fake_scene();
  scene.output.keep = {{"proxies", "hold_force"}};
  scene.grips.height_is_fraction = false;
  const std::string vectors = define(scene);
  EXPECT_EQ(dimension_names(vectors, "proxies"),
            (std::vector<std::string>{"vessel", "joint", "xyz", "azimuth", "obliquity", "roll", "offset", "hand_scale", "height"}));
  EXPECT_EQ(dimension_names(vectors, "hold_force")[2], "tilt");
  EXPECT_EQ(read_text(vectors, "height", "units"), "m");
}

TEST_F(ResultContentsTest, AttributesSayWhereItCameFrom) {
  const std::string path = define(fake_scene());
  EXPECT_EQ(read_text(path, "", "scene"), fake_scene().text);
  EXPECT_EQ(read_text(path, "", "title"), "grips of fake");
  EXPECT_EQ(read_text(path, "", "version"), "1.2.3");
  EXPECT_EQ(read_text(path, "", "device"), "fake device");
  EXPECT_EQ(read_text(path, "", "driver"), "fake driver 1");
  EXPECT_EQ(read_text(path, "", "precision"), "double");
  EXPECT_EQ(read_text(path, "", "Conventions"), "CF-1.8");
  EXPECT_EQ(read_text(path, "reason", "flag_meanings"), "none degenerate not_converged misses too_wide too_narrow on_mouth");
  EXPECT_NE(read_text(path, "score_depth", "comment").find("10 mm"), std::string::npos);
  const std::string rules = "\n" + read_text(path, "", "rules") + "\n";
  for (const char* rule : {"hand: right, 187.2 x 83.2 mm, scale 1", "strength: none", "gate: none", "robust settings: none",
                           "weights: fingers 0.02, contacts 0.02, depth 0.69, posture 0.02, force 0.13, hold 0.12"})
    EXPECT_NE(rules.find(std::string("\n") + rule + "\n"), std::string::npos) << rule << " is not in" << rules;
  const std::string text = dump(path);
  EXPECT_NE(text.find(":seed = 0ULL"), std::string::npos);
  EXPECT_NE(text.find(":wall_time_s = NaN"), std::string::npos);
  EXPECT_NE(text.find("score:score_weights = 0.02, 0.02, 0.69, 0.02, 0.13, 0.12"), std::string::npos);
}

TEST_F(ResultContentsTest, RealsAreAsPreciseAsTheBackend) {
  EXPECT_NE(dump(define(fake_scene(), Precision::single)).find("float score("), std::string::npos);
  const std::string text = dump(define(fake_scene(), Precision::full));
  EXPECT_NE(text.find("double score("), std::string::npos);
  EXPECT_NE(text.find("byte reason("), std::string::npos);
  EXPECT_NE(text.find("int touch_mask("), std::string::npos);
}

TEST_F(ResultContentsTest, FactsOfTheVessels) {
  const std::string path = define(fake_scene());
  EXPECT_EQ(read_values(path, "vessel_height"), (std::vector<double>{0.11, 0.14}));
  EXPECT_EQ(read_values(path, "capacity"), (std::vector<double>{1e-4, 2e-4}));
  EXPECT_EQ(read_values(path, "empty_center_of_mass"), (std::vector<double>{0, 0.05, 0, 0, 0.1, 0}));
  const auto pouring = read_values(path, "pouring_tilt");
  EXPECT_TRUE(std::isnan(pouring[0]));
  EXPECT_EQ(pouring[3], 0.75);
  const FakeEvaluator evaluator(fake_scene());
  const auto poured = read_values(path, "poured_volume");
  ASSERT_EQ(poured.size(), 2u * 2 * 4);
  EXPECT_EQ(poured[(1 * 2 + 1) * 4 + 2], evaluator.liquid(1, 0.5, radians(60)).poured);
}

TEST_F(ResultContentsTest, WhatTheSceneLacksIsNotThere) {
  Scene scene = fake_scene();
  scene.tilts.clear();
  scene.liquid.reset();
  std::string text = dump(define(scene));
  for (const char* name : {"fill", "tilt", "liquid_volume", "pouring_tilt", "peak_feedback_force"}) {
    EXPECT_EQ(text.find(std::string(" ") + name), std::string::npos) << name;
  }
  scene.output.keep = std::vector<std::string>{};
  text = dump(define(scene, Precision::full, 0));
  for (const char* name : {"score", "rank", "best_grip"}) EXPECT_EQ(text.find(std::string(" ") + name), std::string::npos) << name;
  EXPECT_NE(text.find("double roll(roll)"), std::string::npos) << "grips are still counted along it";
  scene = fake_scene();
  scene.liquid.reset();
  EXPECT_EQ(read_values(define(scene), "fill"), std::vector<double>{0}) << "forces of the empty vessel";
}

TEST_F(ResultContentsTest, SobolPointsHaveTheirAxesAsCoordinates) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 33;
  const std::string path = define(scene);
  EXPECT_EQ(dimension_names(path, "score"), (std::vector<std::string>{"vessel", "point"}));
  EXPECT_EQ(dimension_names(path, "roll"), (std::vector<std::string>{"point"}));
  EXPECT_EQ(read_text(path, "score", "coordinates"), "azimuth obliquity roll offset hand_scale height_fraction height");
}

TEST_F(ResultContentsTest, HeightsRanksAndRadiiAreAlwaysThere) {
  Scene scene = fake_scene();
  scene.hand.scale = 2;
  scene.output.keep = std::vector<std::string>{};
  const std::string path = define(scene);
  EXPECT_EQ(dimension_names(path, "height"), (std::vector<std::string>{"vessel", "height_fraction"}));
  const auto fractions = read_values(path, "height_fraction"), heights = read_values(path, "height");
  ASSERT_EQ(heights.size(), 2 * fractions.size());
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    EXPECT_EQ(heights[i], 0.11 * fractions[i]);
    EXPECT_EQ(heights[fractions.size() + i], 0.14 * fractions[i]);
  }
  EXPECT_EQ(read_values(path, "rank"), (std::vector<double>{1, 2, 3, 4}));
  const auto radii = read_values(path, "joint_radius");
  ASSERT_EQ(radii.size(), static_cast<std::size_t>(JOINT_COUNT));
  EXPECT_EQ(radii[0], 2 * scene.hand.fingers[0].radii[0]);
  EXPECT_EQ(radii[4], 2 * scene.hand.fingers[1].radii[0]);
  EXPECT_EQ(radii[23], 2 * scene.hand.fingers[4].radii[4]);
  EXPECT_EQ(read_text(path, "", "coordinates"), "joint_radius height fill_fraction fill_volume");
}

TEST_F(ResultContentsTest, FillsAreLabelledByFractionAndVolume) {
  Scene scene = fake_scene();
  std::string path = define(scene);
  EXPECT_EQ(read_text(path, "fill", "units"), "1");
  EXPECT_EQ(read_values(path, "fill_volume"), (std::vector<double>{0, 0.5e-4, 0, 1e-4}));
  scene.liquid->fills.clear();
  scene.liquid->volumes = {0, 3e-5};
  scene.vessels[0].fills = {0, 0.3};
  scene.vessels[1].fills = {0, 0.15};
  path = define(scene);
  EXPECT_EQ(read_text(path, "fill", "units"), "m3");
  EXPECT_EQ(read_values(path, "fill"), (std::vector<double>{0, 3e-5}));
  EXPECT_EQ(read_values(path, "fill_fraction"), (std::vector<double>{0, 0.3, 0, 0.15}));
  EXPECT_EQ(read_text(path, "peak_feedback_force", "coordinates"), "height fill_fraction fill_volume");
}

TEST_F(ResultContentsTest, MasksNameTheirBitsAndLackNothing) {
  const std::string path = define(fake_scene()), text = dump(path);
  EXPECT_EQ(text.find("touch_mask:_FillValue"), std::string::npos);
  EXPECT_EQ(text.find("reason:_FillValue"), std::string::npos);
  EXPECT_NE(text.find("fingers_used:_FillValue = -1b"), std::string::npos);
  EXPECT_NE(text.find("used_mask:flag_masks = 1b, 2b, 4b, 8b, 16b"), std::string::npos);
  EXPECT_EQ(read_text(path, "used_mask", "flag_meanings"), "thumb index middle ring little");
  EXPECT_EQ(read_text(path, "touch_mask", "flag_meanings").substr(0, 28), "thumb_cmc thumb_mcp thumb_ip");
  EXPECT_NE(text.find("touch_mask:flag_masks = 1, 2, 4, 8, "), std::string::npos);
}

TEST_F(ResultContentsTest, LongSceneTextIsKeptWhole) {
  Scene scene = fake_scene();
  scene.text.assign(1 << 20, '#');
  EXPECT_EQ(read_text(define(scene), "", "scene"), scene.text);
  scene.text.clear();
  EXPECT_EQ(read_text(define(scene), "", "scene"), "");
}

// Beforehand, when nothing is known of the vessels or of what computes.
TEST_F(ResultContentsTest, TheSizeThatIsAskedForIsThatOfTheFile) {
  Scene usual = fake_scene();
  const auto changed = [&usual](auto change) {
    Scene scene = usual;
    change(scene);
    return scene;
  };
  const std::pair<const char*, Scene> scenes[] = {
      {"usual", usual},
      {"sobol", changed([](Scene& scene) {
         scene.grips.sampling = Sampling::sobol;
         scene.grips.count = 5000;
       })},
      {"few points", changed([](Scene& scene) {
         scene.grips.sampling = Sampling::sobol;
         scene.grips.count = 10;
       })},
      {"hands", changed([](Scene& scene) {
         scene.grips.hand_scale.values = {1.1, 0.9, 1};
       })},
      {"one grip", changed([](Scene& scene) { scene.grips = GripsData(); })},
      {"long", changed([](Scene& scene) { scene.text.assign(300000, '#'); })},
      {"rather long", changed([](Scene& scene) { scene.text.assign(40000, '#'); })},
      {"vessels", changed([](Scene& scene) {
         for (int k = 0; k < 5; ++k) scene.vessels.insert(scene.vessels.end(), scene.vessels.begin(), scene.vessels.begin() + 2);
       })},
      {"robust", changed([](Scene& scene) { scene.robust.emplace(); })},
      {"best alone", changed([](Scene& scene) { scene.output.keep.emplace(); })},
      {"all", changed([](Scene& scene) {
         scene.table.emplace();
         scene.arm.emplace();
         scene.strength.emplace();
         scene.output.keep.emplace();
         for (const Variable& variable : variable_catalogue()) scene.output.keep->push_back(variable.name);
       })},
  };
  for (const auto& [name, scene] : scenes)
    for (const Precision precision : {Precision::single, Precision::full})
      for (const std::size_t best : {0, 50}) {
        const auto variables = choose_variables(scene);
        const Plan plan(scene, keeps_vectors(variables));
        FakeBackend backend(scene, make_field_set(variable_fields(variables), scene), precision, 100);
        ResultContents contents{scene, plan, variables, {}, {}, "1", best};
        contents.info.precision = precision;
        const double asked = static_cast<double>(result_size(contents));
        contents.info = backend.info();
        contents.facts = vessel_facts(scene, backend, FakeEvaluator(scene));
        const std::string path = folder / fmt::format("{} {} {}.nc", name, static_cast<int>(precision), best);
        define_result_file(path, contents);
        const auto size = static_cast<double>(std::filesystem::file_size(path));
        EXPECT_LE(size, asked) << path;
        EXPECT_LE(asked, 1.25 * size + 12e3) << path;
      }
}

TEST_F(ResultContentsTest, FileThatCannotBeMadeIsAnError) {
  const Scene scene = fake_scene();
  const Plan plan(scene, false);
  FakeBackend backend(scene, make_field_set({}, scene), Precision::full, 100);
  const ResultContents contents{scene, plan, {}, vessel_facts(scene, backend, FakeEvaluator(scene)), backend.info(), "1", 4};
  testing::internal::CaptureStderr();
  EXPECT_THROW(define_result_file(folder / "missing/a.nc", contents), Error);
  EXPECT_THROW(define_result_file(folder.path(), contents), Error);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the library's own stack of errors";
}

}  // namespace
}  // namespace wholehand::sweeps
