// SPDX-License-Identifier: MIT
// A survey of a mesh file finds unit, upward axis, parts, holes and cavity, and writes a scene that works as it is.
#include "core/meshes/survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files/json.h"
#include "core/capacity.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/vessel_models.h"

namespace wholehand {
namespace {

enum class Posture { upright, z_up, lying };

// How a model is written: the format's ending, the size of its unit in m, and which way it stands.
struct Form {
  std::string ending;
  double unit = 1;
  Posture posture = Posture::upright;
  bool is_inside_out = false, has_two_sides = false;
};

std::string text_of(const TriangleMesh& mesh, const Form& form) {
  if (form.ending == "glb") return glb_text(mesh);
  if (form.ending == "obj") return obj_text(mesh);
  if (form.ending == "ply") return ply_text(mesh, PlyWriting::little_endian);
  if (form.ending == "off") return off_text(mesh);
  if (form.ending == "dae") return collada_text(mesh);
  return stl_text(unjoined(mesh));
}

TriangleMesh formed(TriangleMesh mesh, const Form& form) {
  if (form.is_inside_out) mesh = inside_out(mesh);
  if (form.has_two_sides) mesh = two_sided(mesh);
  if (form.posture == Posture::z_up) mesh = z_up(mesh);
  if (form.posture == Posture::lying) mesh = lying(mesh);
  return in_unit(mesh, form.unit);
}

class Survey : public testing::Test {
 protected:
  MeshSurvey survey_of(const TriangleMesh& mesh, const Form& form = {"stl", 1}) {
    const std::string file = folder_ / ("cup." + form.ending);
    write_file(file, text_of(formed(mesh, form), form));
    return survey_mesh({file, {}, {}, {}, {}});
  }

  // The scene of a survey, with its meshes read; `keys`: further ones of its vessel.
  Scene scene_of(const MeshSurvey& survey) {
    NewScene wanted;
    wanted.name = "cup";
    wanted.mesh = survey.data.file;
    Scene scene = parse_scene(scene_of_mesh(wanted, survey), folder_ / "cup.toml");
    scene.vessels[0].mesh->lattice_spacing = 2e-3;  // soon sampled, and fine enough to see where the outline is
    MeshOptions options;
    options.is_quiet = true;
    options.cache_folder = folder_.path();
    options.say = [this](const std::string& line) { said_ += line + "\n"; };
    load_meshes(scene, options);
    return scene;
  }

  std::string value_of(const MeshSurvey& survey, const std::string& key) {
    for (const SceneKey& one : scene_keys(survey))
      if (one.key == key) return one.value;
    return "";
  }

  void expect_model(const VesselModel& model, const Form& form) {
    SCOPED_TRACE(model.name + " " + form.ending);
    const MeshSurvey survey = survey_of(model.mesh, form);
    EXPECT_DOUBLE_EQ(survey.data.scale, form.unit) << survey.reasons.unit;
    ASSERT_TRUE(survey.cavity.cavity.has_value()) << survey.cavity.refusal;
    EXPECT_NEAR(survey.cavity.cavity->capacity, model.capacity, 0.01 * model.capacity);
    double lowest = INFINITY;  // of the vessel, which may stand on a saucer
    for (std::size_t t = 0; t < model.vessel_triangles; ++t)
      for (const std::uint32_t corner : model.mesh.triangles[t]) lowest = std::min(lowest, model.mesh.vertices[corner][1]);
    EXPECT_NEAR(survey.cavity.cavity->brim - survey.mesh.facts.low[1], model.brim - lowest, 0.05e-3);
    const Scene scene = scene_of(survey);
    // the scene has radii to a micrometer: half of one changes the capacity of a tube of 7 mm by 1.43e-4
    EXPECT_NEAR(capacity_of(scene.vessels[0]), survey.cavity.cavity->outline.volume, 1.5e-4 * model.capacity);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(scene.vessels[0].mesh->body->facts.low[k], survey.mesh.facts.low[k], 2e-6);  // written to a micrometer
  }

  TemporaryFolder folder_;
  std::string said_;
};

TEST_F(Survey, FindsUnitAxisAndCavityInEveryFormat) {
  expect_model(vessel_model("straight_mug"), {"glb", 1});
  expect_model(vessel_model("mug_with_handle"), {"stl", 0.001, Posture::z_up});
  expect_model(vessel_model("bottle"), {"obj", 0.01, Posture::lying});
  expect_model(vessel_model("wine_glass"), {"ply", 0.0254, Posture::z_up, true});
  expect_model(vessel_model("test_tube"), {"off", 0.001, Posture::upright, false, true});
  expect_model(vessel_model("erlenmeyer_flask"), {"dae", 1});
}

// Every model, the forms going round: endings, units, postures and faults each in their own turn.
TEST_F(Survey, MakesAVesselOfEveryModel) {
  const std::vector<std::string> endings{"glb", "stl", "obj", "ply", "off", "dae"};
  const std::vector<double> units{0.001, 0.01, 0.0254, 1};
  for (std::size_t number = 0; number < vessel_models().size(); ++number) {
    const VesselModel& model = vessel_models()[number];
    const bool is_whole = check_mesh(model.mesh, model.name).facts.open_edges == 0;
    Form form{endings[number % 6]};
    const bool has_frame = form.ending == "glb" || form.ending == "dae";
    if (!has_frame) form.unit = units[number / 2 % 4];
    // what has no cavity does not show which way it stands
    if (!has_frame && model.refusal.empty()) form.posture = static_cast<Posture>(number / 6 % 3);
    form.is_inside_out = is_whole && number % 5 == 0;
    form.has_two_sides = is_whole && number % 7 == 0;
    SCOPED_TRACE(model.name + " " + form.ending);
    if (model.refusal.empty() && is_whole) {
      expect_model(model, form);
      continue;
    }
    const MeshSurvey survey = survey_of(model.mesh, form);
    if (model.name == "cup_upside_down") {
      EXPECT_TRUE(survey.cavity.cavity.has_value()) << "it is turned over";
    } else if (!model.refusal.empty()) {
      EXPECT_FALSE(survey.cavity.cavity.has_value());
      EXPECT_TRUE(has(survey.cavity.refusal, model.refusal)) << survey.cavity.refusal;
    } else {
      ASSERT_TRUE(survey.cavity.cavity.has_value()) << survey.cavity.refusal;
      EXPECT_NEAR(survey.cavity.cavity->capacity, model.capacity, 0.01 * model.capacity);
    }
  }
}

TEST_F(Survey, TakesTheCupWithoutItsSaucer) {
  const MeshSurvey survey = survey_of(vessel_model("cup_and_saucer").mesh);
  EXPECT_EQ(survey.parts.size(), 2u);
  ASSERT_EQ(survey.data.parts.size(), 1u);
  const MeshPart& cup = survey.parts[static_cast<std::size_t>(survey.data.parts[0] - 1)];
  EXPECT_EQ(cup.triangles, vessel_model("cup_and_saucer").vessel_triangles);
  const Scene scene = scene_of(survey);
  EXPECT_EQ(scene.vessels[0].mesh->body->triangles.size(), cup.triangles);
  EXPECT_NEAR(scene.vessels[0].mesh->body->volume, vessel_model("cup_and_saucer").mesh_volume, 1e-9);
}

TEST_F(Survey, TakesAHandleThatReachesIntoTheWall) {
  const MeshSurvey survey = survey_of(vessel_model("mug_with_handle").mesh);
  EXPECT_EQ(survey.parts.size(), 2u);
  EXPECT_TRUE(survey.data.parts.empty()) << survey.reasons.parts;
  EXPECT_TRUE(survey.data.origin || !survey.data.origin_at_base) << "its box's middle is off the cup's axis";
}

TEST_F(Survey, GivesASheetWalls) {
  for (const char* name : {"sheet_cup", "two_sided_sheet_cup"}) {
    const VesselModel& model = vessel_model(name);
    const MeshSurvey survey = survey_of(model.mesh, {"stl", 0.001});
    EXPECT_EQ(value_of(survey, "thickness_mm"), "2");
    ASSERT_TRUE(survey.cavity.cavity.has_value()) << survey.cavity.refusal;
    EXPECT_NEAR(survey.cavity.cavity->capacity, model.capacity, 0.01 * model.capacity);
    EXPECT_NEAR(survey.mesh.facts.volume, model.volume, 0.01 * model.volume);
    const Scene scene = scene_of(survey);
    EXPECT_NEAR(scene.vessels[0].mesh->body->volume, model.volume, 0.01 * model.volume);
  }
}

TEST_F(Survey, AWalledCupWithAHoleIsNoSheet) {
  for (const char* name : {"cup_with_a_hole_in_its_wall", "cup_with_a_broken_edge"}) {
    const MeshSurvey survey = survey_of(vessel_model(name).mesh);
    EXPECT_EQ(value_of(survey, "thickness_mm"), "") << name;
    EXPECT_TRUE(has(mesh_check_text(survey.mesh.facts), "neither flat nor small")) << mesh_check_text(survey.mesh.facts);
  }
}

TEST_F(Survey, ClosesWhatIsMissingOfWalls) {
  const VesselModel& model = vessel_model("cup_without_base");
  const MeshSurvey survey = survey_of(model.mesh);
  EXPECT_EQ(value_of(survey, "close_holes"), "true");
  EXPECT_NEAR(survey.mesh.facts.volume, model.volume, 0.01 * model.volume);
  EXPECT_NEAR(scene_of(survey).vessels[0].mesh->body->volume, model.volume, 0.01 * model.volume);
}

TEST_F(Survey, SaysWhatTheOutlineLeavesOut) {
  const auto lines_of = [&](const char* name) {
    std::string lines;
    for (const std::string& line : survey_lines(survey_of(vessel_model(name).mesh))) lines += line + "\n";
    return lines;
  };
  EXPECT_TRUE(has(lines_of("punted_bottle"), "mL lie lower than the floor on the axis"));
  EXPECT_TRUE(has(lines_of("square_cup"), "its radius varies by up to "));
  EXPECT_TRUE(has(lines_of("beaker_with_spout"), "liquid runs over 4 mm below the highest point"));
  EXPECT_TRUE(has(lines_of("solid_hull"), "no cavity: it has no hollow"));
  EXPECT_FALSE(has(lines_of("straight_mug"), "varies"));
}

TEST_F(Survey, AWrongOutlineIsOfferedTheRightOne) {
  const std::string file = folder_ / "cup.glb";
  write_file(file, glb_text(vessel_model("straight_mug").mesh));
  const auto load = [&](const std::string& outline) {
    const std::string text = "[[vessel]]\nname = \"cup\"\nmesh = \"cup.glb\"\ninner_outline = " + outline +
                             "\ngrid_mm = 1\n[grips]\nheight_mm = 40\n[tilts]\ndeg = [0]\n[liquid]\nfills = [1]\n";
    Scene scene = parse_scene(text, folder_ / "cup.toml");
    MeshOptions options;
    options.is_quiet = true;
    options.cache_folder = folder_.path();
    load_meshes(scene, options);
    return capacity_of(scene.vessels[0]);
  };
  const std::string refused = refusal_line([&] { load("[{ line = [0, 1] }, { line = [30, 1] }, { line = [30, 80] }]"); });
  EXPECT_TRUE(has(refused, " mm, at a height of ")) << refused;
  const std::string offer = "the mesh's own is inner_outline = ";
  const std::string in_wall = refusal_line([&] { load("[{ line = [0, 5] }, { line = [38, 5] }, { line = [38, 95] }]"); });
  EXPECT_TRUE(has(in_wall, "mm into the glass, at a height of ")) << in_wall;
  ASSERT_TRUE(has(refused, offer.c_str())) << refused;
  EXPECT_NEAR(load(refused.substr(refused.find(offer) + offer.size())), vessel_model("straight_mug").capacity,
              0.01 * vessel_model("straight_mug").capacity);
}

// Something solid that reaches 10 mm into the cavity narrows its outline, and the scene takes that outline.
TEST_F(Survey, ASpoutThatReachesInLeavesASceneThatLoads) {
  const TriangleMesh mug = joined(vessel_model("straight_mug").mesh, box_mesh({0.026, 0.05, -0.004}, {0.06, 0.058, 0.004}));
  const MeshSurvey survey = survey_of(mug);
  EXPECT_TRUE(survey.data.parts.empty()) << survey.reasons.parts;
  ASSERT_TRUE(survey.cavity.cavity.has_value()) << survey.cavity.refusal;
  EXPECT_GT(survey.cavity.cavity->off_round, 5e-3);
  EXPECT_NO_THROW(scene_of(survey));
}

TEST_F(Survey, LooseTrianglesAreLeftOut) {
  TriangleMesh mug = vessel_model("straight_mug").mesh;
  for (int k = 0; k < 20; ++k) {
    const double x = 0.1 + 0.001 * k;
    const auto first = static_cast<std::uint32_t>(mug.vertices.size());
    mug.vertices.insert(mug.vertices.end(), {{x, 0.1, 0}, {x + 0.0005, 0.1, 0}, {x, 0.1005, 0}});
    mug.triangles.push_back({first, first + 1, first + 2});
  }
  const MeshSurvey survey = survey_of(mug);
  EXPECT_EQ(survey.data.parts, std::vector<int>{1});
  EXPECT_FALSE(survey.data.close_holes);
  EXPECT_TRUE(has(survey.reasons.parts, "20 parts are left out")) << survey.reasons.parts;
}

TEST_F(Survey, OfTwoCupsOneIsTakenAndTheOtherNamed) {
  const TriangleMesh cup = vessel_model("tapered_cup").mesh;
  const MeshSurvey survey = survey_of(joined(cup, placed_mesh(cup, {}, {0.15, 0, 0})));
  EXPECT_EQ(survey.data.parts.size(), 1u);
  EXPECT_TRUE(has(survey.reasons.parts, "though it has a cavity too: part ")) << survey.reasons.parts;
}

TEST_F(Survey, IsTheSameAsJson) {
  const MeshSurvey survey = survey_of(vessel_model("straight_mug").mesh);
  const nlohmann::json json = parse_json(survey_json(survey));
  EXPECT_DOUBLE_EQ(json["cavity"]["capacity_ml"], 1e6 * survey.cavity.cavity->capacity);
  EXPECT_EQ(json["keys"]["inner_outline"], value_of(survey, "inner_outline"));
  EXPECT_EQ(json["triangles"], survey.mesh.facts.triangles);
  EXPECT_GT(json["lattice"]["samples"], 0);
}

TEST_F(Survey, RefusesWhatIsNotThere) {
  const std::string file = folder_ / "cup.stl";
  write_file(file, stl_text(vessel_model("straight_mug").mesh));
  EXPECT_TRUE(has(refusal_line([&] { survey_mesh({file, {}, {}, {2}, {}}); }), "part = 2: it has 1 part, numbered from 1"));
  EXPECT_TRUE(has(refusal_line([&] { survey_mesh({file, {}, {}, {}, 2e-3}); }), "thickness_mm: no edge is open"));
  EXPECT_TRUE(has(refusal_line([&] { survey_mesh({folder_ / "none.stl", {}, {}, {}, {}}); }), "none.stl"));
}

}  // namespace
}  // namespace wholehand
