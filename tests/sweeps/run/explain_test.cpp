// SPDX-License-Identifier: MIT
// What a sweep says it leaves out: each part that a scene lacks has its line, with bytes that are what the fields take, and no line
// is there for what the scene has.
// sanitizers: none
#include "sweeps/run/explain.h"

#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "core/counted_tilts.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "evidence/check/compare.h"
#include "sweeps/plan/variables.h"
#include "tests/support/vulkan_listener.h"

namespace wholehand::sweeps {
namespace {

constexpr std::size_t TEST_GRIPS = 768;  // few, since each test times a dozen variants; the efforts of 64 of them are searched

struct Row {
  std::string what, variant;
  double microseconds = 0;
  long long bytes = 0;
};

struct Explained {
  std::string text;
  double microseconds = 0;
  long long bytes = 0;
  std::vector<Row> rows;
  const Row* find(const std::string& part) const {
    for (const Row& row : rows)
      if (row.what.find(part) != std::string::npos || row.variant.find(part) != std::string::npos) return &row;
    return nullptr;
  }
};

double number(std::string text) {
  std::erase(text, ',');
  return std::stod(text);
}

Explained explain(const Scene& scene, const std::string& on, Precision precision = Precision::single) {
  const auto variables = choose_variables(scene);
  const Plan plan(scene, keeps_vectors(variables));
  const FieldSet fields = make_field_set(variable_fields(variables), scene);
  Explained explained;
  explained.text = explain_sweep(scene, plan, fields, {on, precision, 1, static_cast<std::size_t>(scene.output.best), TEST_GRIPS});
  std::istringstream lines(explained.text);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, match, std::regex("this sweep: ([0-9.,]+) us, ([0-9,]+) B\\)$"))) {
      explained.microseconds = number(match[1]);
      explained.bytes = static_cast<long long>(number(match[2]));
    } else if (std::regex_match(line, match, std::regex("  (.*?) +(-?[0-9.,]+) us +(-?[0-9,]+) B  (.+)"))) {
      explained.rows.push_back({match[1], match[4], number(match[2]), static_cast<long long>(number(match[3]))});
    }
  }
  return explained;
}

// The shipped scene with few grips, and without efforts: those take most of the time.
Scene three_beakers() {
  Scene scene = read_scene_file(find_scene("three_beakers"));
  scene.strength.reset();
  scene.grips.height.values = {0.03, 0.05, 0.07};
  scene.grips.obliquity.values = {radians(-20), 0, radians(20)};
  return scene;
}

TEST(Explain, WholeSceneLeavesOutPlanesAndTheInnerWall) {
  const Scene scene = three_beakers();
  const Explained explained = explain(scene, "vulkan");
  EXPECT_GT(explained.microseconds, 0);
  ASSERT_TRUE(explained.find("from a buffer")) << explained.text;
  ASSERT_TRUE(explained.find("result planes not computed")) << explained.text;
  const FieldSet every = all_fields(scene);
  const long long whole = (GRIP_AXES + every.real_planes + PLACED_STRIDE) * 4LL + every.uint_planes * 4LL;
  EXPECT_EQ(explained.find("result planes not computed")->bytes, whole - explained.bytes) << explained.text;
  EXPECT_TRUE(explained.find("inner wall")) << explained.text;
  EXPECT_TRUE(explained.find("the scene has no strengths")) << explained.text;
  EXPECT_EQ(explained.text.find("until_poured"), std::string::npos) << explained.text;
  for (const char* had : {"projection", "force kernel", "the liquid", "azimuth"})
    EXPECT_FALSE(explained.find(had)) << explained.text;
}

TEST(Explain, BareSceneHasALineForEachPartThatItLacks) {
  Scene scene = three_beakers();
  scene.pose = Pose::rigged;
  scene.table.reset();
  scene.arm.reset();
  scene.hand.between = 0;
  scene.liquid.reset();
  scene.tilts.clear();
  scene.grips.azimuth.values = {0, 0.5, 1};
  for (const char* on : {"core", "vulkan"}) {
    const Explained explained = explain(scene, on, Precision::full);
    for (const char* lacked : {"projection", "force kernel", "the liquid", "above a table", "what the wrist has to do",
                               "2 of 3 azimuths", "inner wall", "spheres between the joints"})
      EXPECT_TRUE(explained.find(lacked)) << lacked << "\n" << explained.text;
    EXPECT_EQ(explained.find("from a buffer") != nullptr, std::string(on) == "vulkan") << explained.text;
    // two of three azimuths are two grips more for each that is computed
    ASSERT_TRUE(explained.find("azimuths"));
    EXPECT_EQ(explained.find("azimuths")->bytes, 2 * explained.bytes) << explained.text;
    EXPECT_GT(explained.find("azimuths")->microseconds, 0) << explained.text;
    // tilts bring the force and hold terms, peak, its tilt, largest hold and safe tilt
    ASSERT_TRUE(explained.find("force kernel"));
    EXPECT_GT(explained.find("force kernel")->bytes, 0) << explained.text;
  }
}

TEST(Explain, SaysWhatSpheresBetweenJointsCostAndLeaveOpen) {
  Scene scene = three_beakers();
  scene.vessels.resize(1);
  scene.hand.between = 2;
  scene.output.also = {"self_depth"};
  const Explained explained = explain(scene, "core");
  EXPECT_FALSE(explained.find("spheres between the joints")) << explained.text;
  EXPECT_TRUE(std::regex_search(
      explained.text,
      std::regex("not left out: 2 spheres on each bone, which cost -?[0-9.]+ us and 8 B per grip \\([0-9.]+ x without")))
      << explained.text;
  // the default hand: h = 53.77 / 3 mm and r = 9.61 mm of the little finger's metacarpal bone, r - sqrt(r^2 - h^2 / 4) = 6.14 mm; those
  // of the three other fingers are longer than six times their radius
  EXPECT_NE(explained.text.find("up to 6.14 mm outside of both (a bone of 53.8 mm); on 3 of 19 bones the spheres do not meet"),
            std::string::npos)
      << explained.text;
  scene.hand.between = 8;
  EXPECT_NE(explain(scene, "core").text.find("up to 0.78 mm outside of both (a bone of 68.2 mm)\n"), std::string::npos)
      << explain(scene, "core").text;
}

// A part that the scene has costs one plane, on the core a double, and is not among what is left out.
void expect_cost(const Scene& scene, const std::string& part, const std::string& lacked) {
  const Explained explained = explain(scene, "core");
  EXPECT_FALSE(explained.find(lacked)) << explained.text;
  EXPECT_TRUE(std::regex_search(explained.text, std::regex("not left out: " + part +
                                                           ", which costs -?[0-9.]+ us and 8 B per grip( \\(within the noise of "
                                                           "these runs\\))?\n")))
      << explained.text;
}

TEST(Explain, SaysWhatATableCosts) {
  Scene scene = three_beakers();
  scene.table.emplace();
  scene.output.also = {"table_depth"};
  expect_cost(scene, "the table", "above a table");
}

TEST(Explain, SaysWhatAnArmCosts) {
  Scene scene = three_beakers();
  scene.arm.emplace();
  expect_cost(scene, "the arm", "what the wrist has to do");
}

TEST(Explain, SaysWhatEffortsCost) {
  Scene scene = three_beakers();
  scene.tilts = {0, radians(60)};
  scene.liquid.reset();
  scene.vessels.resize(1);
  scene.table.reset();
  scene.strength.emplace();
  const Explained explained = explain(scene, "core");
  EXPECT_FALSE(explained.find("the scene has no strengths")) << explained.text;
  std::smatch match;
  ASSERT_TRUE(
      std::regex_search(explained.text, match, std::regex("not left out: the efforts, which cost ([0-9.]+) us and ([0-9]+) B")))
      << explained.text;
  EXPECT_GT(std::stod(match[1]), 0);
  // worst effort, its fill and tilt, less the largest hold force: two doubles more
  EXPECT_EQ(std::stoi(match[2]), 2 * 8) << explained.text;
  ASSERT_TRUE(std::regex_search(explained.text, match,
                                std::regex("of ([0-9]+) plausible grips .* takes ([0-9.]+) pivots a state; ([0-9]+) %")))
      << explained.text;
  EXPECT_GT(std::stoi(match[1]), 10);
  EXPECT_GT(std::stod(match[2]), 0);
  EXPECT_LE(std::stoi(match[3]), 100);
  const int searched = std::stoi(match[1]);
  ASSERT_TRUE(std::regex_search(explained.text, match, std::regex("the gate .*: ([0-9]+) of these grips are not held")))
      << explained.text;
  EXPECT_GE(std::stoi(match[1]), 0);
  EXPECT_LT(std::stoi(match[1]), searched);
}

TEST(Explain, SaysWhatRobustScoresCost) {
  Scene scene = three_beakers();
  scene.vessels.resize(2);
  scene.output.best = 7;
  scene.robust.reset();
  EXPECT_EQ(explain(scene, "core").text.find("robust"), std::string::npos);
  scene.robust.emplace();
  scene.robust->count = 24;
  scene.robust->friction = 0.1;
  const std::string text = explain(scene, "core").text;
  std::smatch match;
  ASSERT_TRUE(std::regex_search(
      text, match,
      std::regex("not left out: the robust scores by the core, ([0-9.]+) us for each deviation. An eighth of 24 "
                 "deviations of 320 candidates and the rest for the 14 listed cost about ([0-9.e-]+) s of processor "
                 "time a sweep; all would cost ([0-9.e-]+) s\n")))
      << text;
  // to the printed digits
  const double each = 1e-6 * std::stod(match[1]), least = std::stod(match[2]), all = std::stod(match[3]);
  EXPECT_GT(each, 0);
  EXPECT_NEAR(least, (3 * 320 + 21 * 14) * each, 0.01 * least) << text;
  EXPECT_NEAR(all, 24 * 320 * each, 0.01 * all) << text;
  scene.output.best = 0;
  EXPECT_EQ(explain(scene, "core").text.find("robust"), std::string::npos) << "nothing is listed";
}

TEST(Explain, CountsTheStatesThatAreLeftOut) {
  Scene scene = three_beakers();
  scene.until_poured = 0.5;
  const std::string text = explain(scene, "core").text;
  for (std::size_t v = 0; v < scene.vessels.size(); ++v) {
    std::size_t left_out = 0;
    for (const std::size_t counted : counted_tilts(scene, v)) left_out += scene.tilts.size() - counted;
    ASSERT_GT(left_out, 0u);
    const std::string line = "  " + std::to_string(left_out) + " of 155 states of " + scene.vessels[v].name + ": ";
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  }
}

TEST(Explain, SaysWhereNothingCanBeSaved) {
  Scene scene = three_beakers();
  scene.liquid.reset();
  VesselData& vessel = scene.vessels[0];
  vessel.wall = 0;
  vessel.mass = 0.1;
  vessel.outline.clear();
  constexpr int PIECES = 40;
  for (int i = 0; i <= PIECES; ++i) vessel.outline.push_back({false, {0.02 + 0.0005 * i, 0.1 * i / PIECES}, {}, 0, 0});
  vessel.outline.push_back({false, {0, 0.1}, {}, 0, 0});
  vessel.height = 0.1;
  scene.vessels.resize(1);
  const Explained explained = explain(scene, "vulkan");
  EXPECT_NE(explained.text.find("more than 32 elements"), std::string::npos) << explained.text;
  EXPECT_NE(explained.text.find("a vessel without a wall and a mesh without an inner outline hold no liquid"), std::string::npos)
      << explained.text;
  EXPECT_FALSE(explained.find("inner wall")) << explained.text;
}

}  // namespace
}  // namespace wholehand::sweeps
