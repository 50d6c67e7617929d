// SPDX-License-Identifier: MIT
// What most likely is not meant in a mesh, and that following the remedy helps.
#include "core/meshes/hints.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/evaluator.h"
#include "core/meshes/mesh.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/scenes.h"

namespace wholehand {
namespace {

TEST(MeshHints, UnitsAreThoseInWhichAHandCanHoldIt) {
  struct Case {
    Triple numbers;
    std::string units;
  };
  const std::vector<Case> cases{
      {{0.08, 0.1, 0.08}, "meters"},  // a cup
      {{8, 10, 8}, "centimeters"},    // 203 mm of inches are wider than a hand spans
      {{80, 100, 80}, "millimeters"},
      {{3, 4, 3}, "inches centimeters"},          // 101.6 mm, or 40 mm
      {{9, 35.6, 9}, "centimeters millimeters"},  // a bottle of 356 mm, or one of 35.6
      {{2, 2, 2}, "inches centimeters"},          // what an editor begins with
      {{0.4, 0.1, 0.4}, "meters"},                // a plate
      {{0.45, 0.1, 0.45}, ""},                    // too large, and too small in any other
      {{0.2, 0.2, 0.2}, ""},                      // no side that a hand spans
      {{4277, 2600, 2600}, ""},                   // in thousandths of an inch
      {{0.9, 0.9, 0.9}, "inches"},
      {{380, 380, 30}, "millimeters"},
      {{80e-6, 80e-6, 80e-6}, ""},
  };
  for (const Case& each : cases) {
    std::string units;
    for (const LengthUnit& unit : graspable_units(each.numbers)) units += (units.empty() ? "" : " ") + std::string(unit.name);
    EXPECT_EQ(units, each.units) << each.numbers[0] << " " << each.numbers[1];
  }
}

TEST(MeshHints, SizesThatNoHandHoldsGetTheLikelyScales) {
  EXPECT_EQ(mesh_size_hint({0.08, 0.1, 0.08}).text, "");
  EXPECT_EQ(mesh_size_hint({0.03, 0.02, 0.03}).text, "");
  EXPECT_EQ(
      mesh_size_hint({9, 35.6, 9}).text,
      "it is 35.6 m large, which a hand hardly holds: its numbers are taken as meters; the likely scale is one of mesh_scale = "
      "0.01 (centimeters: 356 mm), 0.001 (millimeters: 35.6 mm)");
  EXPECT_EQ(mesh_size_hint({0.08, 0.12, 0.08}, 1).text, "");
  EXPECT_EQ(mesh_size_hint({80, 120, 80}).text,
            "it is 120 m large, which a hand hardly holds: its numbers are taken as meters; the likely scale is mesh_scale = 0.001 "
            "(millimeters: 120 mm)");
  // beside a scale that was given: that of the file's own numbers
  EXPECT_EQ(mesh_size_hint({80e-6, 120e-6, 80e-6}, 0.001).text,
            "it is 0.12 mm large, which a hand hardly holds: its numbers times 0.001 are taken as meters; the likely scale is "
            "mesh_scale = 1 (meters: 120 mm)");
  EXPECT_TRUE(
      has(mesh_size_hint({4277, 2600, 2600}).text, "it would fit in no usual unit, and mesh_scale = 4.676e-06 to 5.769e-05"));
  EXPECT_TRUE(has(mesh_size_hint({80e-6, 80e-6, 80e-6}).text, "mesh_scale = 250 to 1875 makes it fit"));
  // a vase may be meant
  EXPECT_FALSE(mesh_size_hint({0.2, 0.6, 0.2}).text.empty());
  EXPECT_FALSE(mesh_size_hint({0.2, 0.6, 0.2}).is_other_unit);
  EXPECT_TRUE(mesh_size_hint({2, 2, 2}).is_other_unit && mesh_size_hint({1e-4, 1e-4, 1e-4}).is_other_unit);
}

// Every size from a tenth of a millimeter to a hundred meters is held, or gets a hint whose scales are held.
TEST(MeshHints, FollowingASizeHintHelps) {
  for (double size = 1e-4; size < 100; size *= 1.07) {
    const Triple numbers{size, 0.8 * size, 0.3 * size};
    const std::string text = mesh_size_hint(numbers).text;
    if (text.empty()) {
      EXPECT_TRUE(size > 0.0199 && size < 0.401) << size;
      continue;
    }
    const std::size_t at = text.find("mesh_scale = ");
    ASSERT_NE(at, std::string::npos) << text;
    // inside of a range whose ends were rounded to four digits
    const double scale = std::stod(text.substr(at + 13)) * (has(text, "makes it fit") ? 1.001 : 1);
    EXPECT_EQ(mesh_size_hint({scale * numbers[0], scale * numbers[1], scale * numbers[2]}, scale).text, "") << text;
  }
}

// A box of 60 x 100 x 60 mm without the face on one side.
TriangleMesh open_box(const Triple& turn) {
  TriangleMesh box = box_mesh({-0.03, -0.05, -0.03}, {0.03, 0.05, 0.03});
  std::erase_if(box.triangles, [&](const Corners& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t corner) { return box.vertices[corner][1] > 0; });
  });
  return placed_mesh(box, turn, {});
}

// Loads a scene with that mesh as an OBJ and with these keys of its vessel; returns what that says.
struct LoadedMesh {
  Scene scene;
  std::string said;
};

LoadedMesh load(const TemporaryFolder& folder, const TriangleMesh& mesh, const std::string& keys, const char* name = "cup.obj") {
  write_file(folder / name, name == std::string("cup.obj") ? obj_text(mesh) : glb_text(mesh));
  LoadedMesh loaded;
  loaded.scene =
      parse_scene(fmt::format("[[vessel]]\nname = \"v\"\nmesh = \"{}\"\ngrid_mm = 5\n{}\n", name, keys), folder / "scene.toml");
  MeshOptions options;
  options.cache_folder = folder.path();
  options.say = [&](const std::string& line) { loaded.said += line + "\n"; };
  load_meshes(loaded.scene, options);
  return loaded;
}

TEST(MeshHints, AnOpenSideThatIsNotUpIsNamedWithTheKeyThatRaisesIt) {
  const TemporaryFolder folder;
  struct Case {
    Triple turn;  // the direction that then faces the open side, which is up
    const char* side;
  };
  for (const Case& each : {Case{{radians(90), 0, 0}, "+z"}, Case{{radians(-90), 0, 0}, "-z"}, Case{{0, 0, radians(-90)}, "+x"},
                           Case{{0, 0, radians(90)}, "-x"}, Case{{radians(180), 0, 0}, "-y"}}) {
    const std::string said = load(folder, open_box(each.turn), "").said;
    EXPECT_TRUE(has(said, fmt::format("its open side faces {}, and +y is up: if it lies on its side, ", each.side))) << said;
    const std::size_t begin = said.find("on its side, ") + 13;
    const LoadedMesh raised = load(folder, open_box(each.turn), said.substr(begin, said.find(" stands it up") - begin));
    EXPECT_FALSE(has(raised.said, "stands it up")) << raised.said;
    const MeshBody& body = *raised.scene.vessels[0].mesh->body;
    EXPECT_EQ(open_side({body.vertices, body.triangles}, body.facts), Side::up) << each.side;
  }
  EXPECT_FALSE(has(load(folder, open_box({}), "").said, "stands it up"));
  // the scene says which way is up, or glTF does
  EXPECT_FALSE(has(load(folder, open_box({radians(90), 0, 0}), "up = \"y\"").said, "stands it up"));
  EXPECT_FALSE(has(load(folder, open_box({radians(90), 0, 0}), "", "cup.glb").said, "stands it up"));
}

TEST(MeshHints, ACupWithAWallIsOpenWhereItsMouthIs) {
  VesselData shell;
  shell.outline = {line_to(40, 0), line_to(40, 110), line_to(38.5, 110), line_to(38.5, 1.5), line_to(0, 1.5)};
  const auto side_of = [](const TriangleMesh& mesh) {
    const CheckedMesh checked = check_mesh(mesh, "cup");
    return open_side(checked.mesh, checked.facts);
  };
  const TriangleMesh cup = turned_mesh(shell, 64, 2e-3);
  EXPECT_EQ(side_of(cup), Side::up);
  EXPECT_EQ(side_of(placed_mesh(cup, {radians(90), 0, 0}, {})), Side::front);
  EXPECT_EQ(side_of(joined(cup, box_mesh({0.039, 0.03, -0.005}, {0.07, 0.08, 0.005}))), Side::up) << "with a handle";
  EXPECT_EQ(side_of(icosphere(0.05, 3)), std::nullopt);
  EXPECT_EQ(side_of(torus(0.05, 0.01, 40, 20)), std::nullopt) << "open upward and downward";
}

TEST(MeshHints, AClosedBodyThatIsLongestAcrossIsNamed) {
  const auto hint = [](const Triple& size) {
    const CheckedMesh checked = check_mesh(box_mesh({0, 0, 0}, size), "box");
    return posture_hint(checked.mesh, checked.facts);
  };
  EXPECT_EQ(hint({0.08, 0.08, 0.3}), "it is longest along z, and y is up: if it lies on its side, up = \"z\" stands it up");
  EXPECT_TRUE(has(hint({0.3, 0.08, 0.08}), "longest along x, and y is up: if it lies on its side, rotate_deg = [0, 0, 90] stands"));
  EXPECT_EQ(hint({0.08, 0.3, 0.08}), "");
  EXPECT_EQ(hint({0.25, 0.03, 0.25}), "") << "a plate";
  const TemporaryFolder folder;
  const TriangleMesh lying = box_mesh({0, 0, 0}, {0.3, 0.08, 0.08});
  EXPECT_TRUE(has(load(folder, lying, "").said, "longest along x"));
  const LoadedMesh raised = load(folder, lying, "rotate_deg = [0, 0, 90]");
  EXPECT_FALSE(has(raised.said, "longest"));
  EXPECT_NEAR(raised.scene.vessels[0].height, 0.3, 1e-6);
}

TEST(MeshHints, AnInnerOutlineInAnotherUnitIsNamed) {
  const TemporaryFolder folder;
  const TriangleMesh hull = box_mesh({-0.04, 0, -0.04}, {0.04, 0.1, 0.04});
  const auto said = [&](double unit) {
    return load(folder, hull,
                fmt::format("inner_outline = [{{ line = [0, {}] }}, {{ line = [{}, {}] }}, {{ line = [{}, {}] }}]", 2 * unit,
                            38 * unit, 2 * unit, 38 * unit, 100 * unit))
        .said;
  };
  EXPECT_FALSE(has(said(1), "inner outline is"));
  EXPECT_TRUE(has(said(0.001),
                  "the inner outline is 0.098 mm high and 0.076 mm wide, far smaller than the mesh of 100 and 80 mm; it is "
                  "read as millimeters, and its numbers look like meters: multiply them by 1000"))
      << said(0.001);
  EXPECT_TRUE(has(said(0.1), "its numbers look like centimeters: multiply them by 10")) << said(0.1);
  EXPECT_EQ(inner_outline_hint(0.05, 0.03, 0.18, 0.04), "") << "a glass with a stem";
  EXPECT_EQ(inner_outline_hint(0.015, 0.005, 0.1, 0.04),
            "the inner outline is 15 mm high and 10 mm wide, far smaller than the mesh of 100 and 80 mm");
}

TEST(MeshHints, ASmallInnerOutlineIsRefusedForWhatItDoes) {
  const TemporaryFolder folder;
  VesselData cup;
  cup.outline = {line_to(40, 0), line_to(40, 100), line_to(37, 100), line_to(37, 6), line_to(0, 6)};
  const auto refusal = [&](double floor) {
    const std::string keys =
        fmt::format("inner_outline = [{{ line = [0, {0}] }}, {{ line = [5, {0}] }}, {{ line = [5, {1}] }}]", floor, floor + 15);
    return refusal_line([&] { load(folder, turned_mesh(cup, 64, 2e-3), keys); });
  };
  const std::string small = "; the inner outline is 15 mm high and 10 mm wide, far smaller than the mesh of 100 and 80 mm";
  EXPECT_TRUE(has(refusal(0), "the inner outline passes through the mesh")) << refusal(0);
  EXPECT_TRUE(has(refusal(0), "move it where the mesh is hollow, or make the mesh its hull" + small)) << refusal(0);
  EXPECT_TRUE(has(refusal(90), "reaches beyond the mesh")) << refusal(90);
  EXPECT_TRUE(has(refusal(90), "give it in the vessel's frame" + small)) << refusal(90);
}

TEST(MeshHints, NumbersTooLargeForSinglePrecisionAreNoFlatSheet) {
  const TemporaryFolder folder;
  const TriangleMesh box = box_mesh({0, 0, 0}, {0.08, 0.1, 0.06});
  for (const char* name : {"cup.obj", "cup.glb"}) {
    const std::string line = refusal_line([&] { load(folder, placed_mesh(box, {}, {3e6, 0, 3e6}), "", name); });
    EXPECT_TRUE(has(line, "lies so far from its origin that single precision moves its points by up to 0.18")) << line;
    EXPECT_TRUE(has(line, "move it to the origin where it was made")) << line;
    EXPECT_EQ(refusal_line([&] { load(folder, placed_mesh(box, {}, {30, 0, 30}), "", name); }), "");
  }
}

TEST(MeshHints, AMeshMayBeGivenItsMassAlone) {
  const TemporaryFolder folder;
  const TriangleMesh two = joined(box_mesh({0, 0, 0}, {0.06, 0.1, 0.06}), box_mesh({0.01, 0.06, 0.005}, {0.05, 0.12, 0.055}));
  const LoadedMesh plain = load(folder, two, ""), weighed = load(folder, two, "mass_kg = 0.2");
  EXPECT_TRUE(has(plain.said, "or give mass_kg")) << plain.said;
  const auto a = make_core_evaluator(plain.scene), b = make_core_evaluator(weighed.scene);
  EXPECT_EQ(b->empty_mass(0), 0.2);
  EXPECT_EQ(b->empty_center_of_mass(0), a->empty_center_of_mass(0));
  // less the cavity, which is not glass
  const TriangleMesh hull = box_mesh({-0.04, 0, -0.04}, {0.04, 0.1, 0.04});
  const std::string cavity = "inner_outline = [{ line = [0, 40] }, { line = [38, 40] }, { line = [38, 100] }]\n";
  const auto hollow = make_core_evaluator(load(folder, hull, cavity).scene),
             light = make_core_evaluator(load(folder, hull, cavity + "mass_kg = 0.2").scene);
  EXPECT_EQ(light->empty_mass(0), 0.2);
  EXPECT_EQ(light->empty_center_of_mass(0), hollow->empty_center_of_mass(0));
  EXPECT_LT(light->empty_center_of_mass(0)[1], 0.045);
}

// What a line says to do about a mesh, done: the file or the keys as they were, what the line says, and as they are then.
TEST(MeshHints, FollowingARemedyHelps) {
  struct Case {
    TriangleMesh mesh;
    std::string keys, remedy;
    TriangleMesh mended_mesh;
    std::string mended_keys;
  };
  const TriangleMesh box = box_mesh({-0.03, 0, -0.03}, {0.03, 0.1, 0.03}), wavy = wavy_bowl(0.04, 3, 0.01);
  TriangleMesh walled = box, finned = box, flat = box, one_sided = box, holed = icosphere(0.05, 4);
  walled.triangles.push_back({0, 2, 5});
  finned.vertices.push_back({0.05, 0.12, 0.05});
  finned.triangles.push_back({0, 1, 8});
  for (Triple& vertex : flat.vertices) vertex[1] = 0;
  // a strip of five triangles in a ring
  one_sided.triangles.clear();
  for (std::uint32_t k = 0; k < 5; ++k) one_sided.triangles.push_back({k, (k + 1) % 5, (k + 2) % 5});
  holed.triangles.pop_back();
  const std::string far_off = "inner_outline = [{ line = [0, 2] }, { line = [90, 2] }, { line = [90, 98] }]",
                    within = "inner_outline = [{ line = [0, 2] }, { line = [28, 2] }, { line = [28, 98] }]";
  VesselData profile;
  profile.outline = {line_to(40, 0), line_to(40, 100), line_to(37, 100), line_to(37, 6), line_to(0, 6)};
  const TriangleMesh cup = turned_mesh(profile, 64, 2e-3);
  const std::string through = "inner_outline = [{ line = [0, 0] }, { line = [5, 0] }, { line = [5, 15] }]",
                    hollow = "inner_outline = [{ line = [0, 6] }, { line = [37, 6] }, { line = [37, 100] }]";
  const std::vector<Case> cases{
      {cup, through, "move it where the mesh is hollow", cup, hollow},
      {cup, through, "or make the mesh its hull", box_mesh({-0.04, 0, -0.04}, {0.04, 0.1, 0.04}), through},
      {wavy, "", "close them for a sure answer", box, ""},
      {joined(box, placed_mesh(one_sided, {}, {0.1, 0, 0})), "", "meet at edges: make one body of it", box, ""},
      {one_sided, "", "make one closed body of it", box, ""},
      {one_sided, "", "or give mass_kg", one_sided, "mass_kg = 0.1"},
      {holed, "close_holes = true\nmass_kg = 0.1\ndensity_kg_m3 = 2000", "allowed: one of the two", holed,
       "close_holes = true\nmass_kg = 0.1"},
      {wavy, "close_holes = true", "or leave out close_holes", wavy, ""},
      {finned, "close_holes = true", "form no loop, as a surface meets others there: remove it", box, "close_holes = true"},
      {box, "close_holes = true", "close_holes closes nothing", box, ""},
      {holed, "", "which close_holes = true closes", holed, "close_holes = true"},
      {walled, "", "remove it", box, ""},
      {joined(box, box_mesh({-0.02, 0.03, -0.02}, {0.02, 0.15, 0.02})), "", "its bodies overlap", box, ""},
      {flat, "", "give it a thickness", box, ""},
      {box, far_off, "give it in the vessel's frame", box, within},
      {box, "wall_mm = 2", "'inner_outline' gives its cavity", box, within},
      {box, "center_of_mass_mm = [0, 40, 0]", "center_of_mass_mm without mass_kg; allowed: both", box,
       "center_of_mass_mm = [0, 40, 0]\nmass_kg = 0.1"},
  };
  const TemporaryFolder folder;
  for (const Case& each : cases) {
    const auto outcome = [&](const TriangleMesh& mesh, const std::string& keys) {
      std::string said;
      const std::string refused = refusal_line([&] { said = load(folder, mesh, keys).said; });
      return refused + said;
    };
    EXPECT_TRUE(has(outcome(each.mesh, each.keys), each.remedy)) << each.remedy << "\n" << outcome(each.mesh, each.keys);
    EXPECT_FALSE(has(outcome(each.mended_mesh, each.mended_keys), each.remedy)) << each.remedy;
    EXPECT_EQ(refusal_line([&] { load(folder, each.mended_mesh, each.mended_keys); }), "") << each.remedy;
  }
}

}  // namespace
}  // namespace wholehand
