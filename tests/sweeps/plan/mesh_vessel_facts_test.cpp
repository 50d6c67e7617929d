// SPDX-License-Identifier: MIT
// Vessels from mesh files: what is read, reported and refused.
// sanitizers: none (sampling its meshes would be most of a sanitized run; mesh_commands_test goes the same way)
#include "core/meshes/vessel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/text/error.h"
#include "core/meshes/lattice.h"
#include "host/open_backend.h"
#include "tests/support/environment.h"
#include "tests/support/mesh_vessel.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/support/whole_parity.h"

namespace wholehand::sweeps {
namespace {

TEST_F(MeshVessel, LongWorkIsSaidBeforeWithItsTime) {
  seconds_a_look_ = 1000;  // over LONG_WORK for all rows, however many threads share them
  loaded({of_file("ball", icosphere(0.03, 2), 3e-3)});
  const std::string said = said_;
  const std::size_t before = said.find("its lattice of 3 mm has "), after = said.find("lattice of 3 mm, ");
  ASSERT_NE(before, std::string::npos) << said;
  EXPECT_LT(before, after) << said;
  EXPECT_NE(said.find("samples, which take about "), std::string::npos) << said;
  EXPECT_NE(said.find("a larger grid_mm takes less"), std::string::npos) << said;
  loaded({of_file("ball", icosphere(0.03, 2), 3e-3)});
  EXPECT_EQ(said_.find("which take about"), std::string::npos) << "it is in the cache";
  seconds_a_look_ = 1e-9;
  loaded({of_file("other", icosphere(0.031, 2), 3e-3)});
  EXPECT_EQ(said_.find("which take about"), std::string::npos) << said_;
}

TEST_F(MeshVessel, WhatIsLongIsLessForAnOpenMesh) {
  EXPECT_FALSE(is_long(10, true));
  EXPECT_TRUE(is_long(10.1, true));
  EXPECT_FALSE(is_long(3, false));
  EXPECT_TRUE(is_long(3.1, false));
  LatticePlan plan;
  plan.lattice.spacing = 1e-3;
  plan.lattice.nx = 100;
  plan.lattice.ny = 200;
  plan.lattice.nz = 300;
  plan.seconds = 53.2;
  EXPECT_EQ(forecast_text(plan, false),
            "its lattice of 1 mm has 6,000,000 samples, which take about 54 s, as the mesh is open; a closed one, or a larger "
            "grid_mm, takes less");
  plan.seconds = 503;
  EXPECT_EQ(forecast_text(plan, true),
            "its lattice of 1 mm has 6,000,000 samples, which take about 8 min 23 s; a larger grid_mm takes less");
  plan.finer = plan.lattice;
  plan.finer_seconds = 503;
  plan.lattice.spacing = 2.11111e-3;
  plan.seconds = 53.2;
  EXPECT_EQ(forecast_text(plan, true),
            "its lattice of 1 mm has 6,000,000 samples, which take about 8 min 23 s; one of 2.111 mm, which takes about 54 s, is "
            "taken instead: grid_mm = 1 asks for the finer one");
}

// A lattice that is not asked for takes a minute at most, and a result that says its spacing gives the same one at leisure.
TEST_F(MeshVessel, OverAMinuteACoarserLatticeIsTaken) {
  // edges that cross the lattice's rows: they need a fine one
  const VesselData box = of_file("box", placed_mesh(box_mesh({-0.03, 0, -0.03}, {0.03, 0.06, 0.03}), {0.3, 0.2, 0.1}, {}), 0);
  seconds_a_look_ = 1000;
  const Scene quick = loaded({box});
  EXPECT_NE(said_.find("is taken instead: grid_mm = "), std::string::npos) << said_;
  const MeshBody& body = *quick.vessels[0].mesh->body;
  const PreparedLattice& taken = body.lattice;
  const Triple size = body.facts.size();
  EXPECT_DOUBLE_EQ(taken.spacing, *std::max_element(size.begin(), size.end()) / 24) << "the coarsest, by this clock";
  Scene again = quick;
  again.vessels[0].mesh->body.reset();
  EXPECT_EQ(reload_meshes(again, (folder_ / "result.nc").string(), mesh_keys(quick), mesh_lattices(quick), true), "");
  EXPECT_EQ(*again.vessels[0].mesh->body->lattice.words, *taken.words);
  seconds_a_look_ = 1e-9;
  VesselData asked = box;
  asked.mesh->lattice_spacing = 1e-3;
  EXPECT_EQ(loaded({asked}).vessels[0].mesh->body->lattice.spacing, 1e-3);
}

TEST_F(MeshVessel, ATinyMeshIsWarnedOfAndGetsASmallLattice) {
  TriangleMesh ball = icosphere(0.04e-3, 1);
  const Scene scene = loaded({of_file("tiny", ball, 0)});
  EXPECT_NE(said_.find("it is 0.08 mm large, which a hand hardly holds"), std::string::npos) << said_;
  EXPECT_LE(4 * scene.vessels[0].mesh->body->lattice.words->size(), 4u << 20) << "an answer soon";
}

TEST_F(MeshVessel, HolesAreClosedWhereTheSceneSaysSo) {
  TriangleMesh ball = icosphere(0.03, 4);
  ball.triangles.pop_back();
  VesselData vessel = of_file("ball", ball, 5e-3);
  loaded({vessel});
  EXPECT_NE(said_.find("which close_holes = true closes"), std::string::npos) << said_;
  vessel.mesh->close_holes = true;
  loaded({vessel});
  EXPECT_NE(said_.find(", closed;"), std::string::npos) << said_;
  EXPECT_NE(said_.find("1 hole was closed, up to "), std::string::npos) << said_;
  VesselData bowl = of_file("bowl", open_hemisphere(0.03, 3), 5e-3);
  bowl.mesh->close_holes = true;
  loaded({bowl});
  EXPECT_NE(said_.find("1 hole was closed, up to 84.85 mm across."), std::string::npos) << said_;
  bowl = of_file("bowl", wavy_bowl(0.03, 3, 0.01), 5e-3);
  bowl.mesh->close_holes = true;
  EXPECT_NE(refusal(bowl).find("scene.toml:3:8: bowl.glb: close_holes: 1 of 1 hole is "), std::string::npos) << refusal(bowl);
}

TEST_F(MeshVessel, WithoutAnInnerOutlineItIsSolidAndDry) {
  const Scene scene = loaded({of_file("ball", icosphere(0.03, 3), 1e-3)});
  const auto core = make_core_evaluator(scene);
  EXPECT_NE(said_.find("a solid object, without liquid"), std::string::npos) << said_;
  EXPECT_EQ(core->capacity(0), 0);
  EXPECT_EQ(core->liquid(0, 1, 0.3).mass, 0);
  EXPECT_TRUE(std::isnan(core->pouring_tilt(0, 1)));
  // the tessellation lacks less than (edge / 2 R)^2 of the ball, edges being 1.2 / 8 of R
  const double ball = 4.0 / 3 * PI * std::pow(0.03, 3) * 2230;
  EXPECT_LT(core->empty_mass(0), ball);
  EXPECT_GT(core->empty_mass(0), ball * (1 - std::pow(1.2 / 16, 2) * 2));
}

TEST_F(MeshVessel, AHollowMeshIsWeighedAsItIs) {
  // a beaker with its wall: the inner outline lies where the mesh is hollow
  VesselData shell;
  shell.outline = {line_to(40, 0), line_to(40, 110), line_to(38.5, 110), line_to(38.5, 1.5), line_to(0, 1.5)};
  VesselData vessel = of_file("hollow", turned_mesh(shell, 128, 1e-3), 0.7e-3);
  vessel.inner = inner_outline_of(beaker1());
  const auto core = make_core_evaluator(loaded({vessel}));
  const auto exact = make_core_evaluator(wet_scene({beaker1()}, Pose::articulated));
  // inner and outer wall shrink alike: 2 / 3 (pi / around)^2 of the glass
  EXPECT_NEAR(core->empty_mass(0), exact->empty_mass(0), 1e-3 * exact->empty_mass(0));
  EXPECT_EQ(core->capacity(0), exact->capacity(0));
}

TEST_F(MeshVessel, BodiesThatOverlapOrFaceInwardWeighWhatTheyHold) {
  const TriangleMesh large = box_mesh({0, 0, 0}, {0.06, 0.1, 0.06});
  VesselData overlap = of_file("overlap", joined(large, box_mesh({0.01, 0.06, 0.005}, {0.05, 0.12, 0.055})), 1e-3);
  // by lattices of 1 mm, see enclosed_volume's test
  EXPECT_NEAR(make_core_evaluator(loaded({overlap}))->empty_mass(0), 400e-6 * overlap.density, 0.003 * 400e-6 * overlap.density);
  EXPECT_NE(said_.find("its bodies overlap: inside it are "), std::string::npos) << said_;
  EXPECT_NE(said_.find("give mass_kg"), std::string::npos) << said_;
  // beside each other, and one of them inside out
  TriangleMesh inverted = box_mesh({0.1, 0, 0}, {0.14, 0.06, 0.05});
  for (auto& triangle : inverted.triangles) std::swap(triangle[1], triangle[2]);
  VesselData two = of_file("two", joined(large, inverted), 1e-3);
  EXPECT_NEAR(make_core_evaluator(loaded({two}))->empty_mass(0), 480e-6 * two.density, 1e-6) << "single precision, in the file";
  EXPECT_NE(said_.find("12 triangles faced inward and were turned outward."), std::string::npos) << said_;
  // a wall within: the lattice knows what is inside, and where its middle is
  TriangleMesh walled = large;
  walled.triangles.push_back({0, 2, 5});
  const auto core = make_core_evaluator(loaded({of_file("walled", walled, 1e-3)}));
  EXPECT_NE(said_.find("a wall or a fin ends on it: inside it are "), std::string::npos) << said_;
  EXPECT_NEAR(core->empty_mass(0), 360e-6 * two.density, 0.05 * 360e-6 * two.density);
  // walls that the lattice does not hold are no overlap
  VesselData shell;
  shell.outline = {line_to(40, 0), line_to(40, 110), line_to(39, 110), line_to(39, 1), line_to(0, 1)};
  loaded({of_file("thin", turned_mesh(shell, 64, 2e-3), 4e-3)});
  EXPECT_EQ(said_.find("overlap"), std::string::npos) << said_;
}

// A wall that is part of a wide circle, whose middle is above it.
TEST_F(MeshVessel, AnInnerOutlineIsAsWideAsItsArcsReach) {
  VesselData hull;
  hull.outline = {line_to(52, 0), line_to(52, 70)};
  VesselData vessel = of_file("bowl", turned_mesh(hull, 64, 2e-3), 2e-3);
  vessel.inner = {line_to(0, 5), line_to(30, 5), arc_to(50, 65, -350, 165)};
  EXPECT_EQ(refusal(vessel), "");
}

TEST_F(MeshVessel, HeightsCountFromTheLowestPoint) {
  VesselData vessel = of_file("ball", icosphere(0.03, 3), 1e-3);
  vessel.mesh->origin_at_base = false;
  const Scene scene = loaded({vessel});
  EXPECT_NEAR(scene.vessels[0].base, -0.03, 1e-8);
  EXPECT_NEAR(scene.vessels[0].height, 0.03, 1e-8);
  // the farther of base and top from the middle, where the center of mass is
  const VesselConstants constants = make_core_evaluator(scene)->constants(0);
  EXPECT_NEAR(constants.torque_reference, constants.mass * scene.gravity * 0.03, 1e-6);
}

TEST_F(MeshVessel, SaysWhatItIs) {
  loaded({of_file("ball", icosphere(0.03, 3), 1e-3)});
  for (const char* part :
       {"vessel 'ball': ball.glb: 1,280 triangles", "closed", "lattice of 1 mm", "of 32 bits", "at 4,096 points of the surface"})
    EXPECT_NE(said_.find(part), std::string::npos) << part << " in\n" << said_;
  loaded({of_file("huge", icosphere(30, 2), 0)});
  EXPECT_NE(said_.find("mesh_scale = 0.001"), std::string::npos) << said_;
}

TEST_F(MeshVessel, WhatCannotBeUsedIsRefusedInOneLine) {
  VesselData vessel = of_file("ball", icosphere(0.03, 3), 0.05e-3);
  vessel.mesh->lattice_spacing = 0.05e-3;
  EXPECT_NE(refusal(vessel).find("grid_mm: a lattice of 0.05 mm"), std::string::npos);
  vessel.mesh->lattice_spacing = 1e-3;
  EXPECT_EQ(refusal(vessel), "");
  vessel.mesh->file = "none.glb";
  EXPECT_EQ(refusal(vessel).rfind("scene.toml:3:8: ", 0), 0u) << refusal(vessel);

  VesselData beaker = of_file("beaker", turned_mesh(beaker1(), 64, 2e-3), 2e-3);
  const auto with_inner = [&](double floor, double radius, double mouth) {
    beaker.inner = {{false, {0, floor}, {}, 0, 0}, {false, {radius, floor}, {}, 0, 0}, {false, {radius, mouth}, {}, 0, 0}};
    return refusal(beaker);
  };
  EXPECT_EQ(with_inner(2e-3, 35e-3, 110e-3), "");
  EXPECT_NE(with_inner(-2e-3, 35e-3, 110e-3).find("reaches beyond the mesh"), std::string::npos);
  EXPECT_NE(with_inner(2e-3, 45e-3, 110e-3).find("reaches beyond the mesh"), std::string::npos);
  EXPECT_NE(with_inner(2e-3, 35e-3, 120e-3).find("reaches beyond the mesh"), std::string::npos);
  // the handle moves the middle of the box off the cup's axis
  VesselData shell;
  shell.outline = {line_to(40, 0), line_to(40, 110), line_to(38.5, 110), line_to(38.5, 1.5), line_to(0, 1.5)};
  VesselData cup = of_file("cup", joined(turned_mesh(shell, 64, 2e-3), box_mesh({0.039, 0.03, -0.005}, {0.07, 0.08, 0.005})), 1e-3);
  cup.inner = inner_outline_of(beaker1());
  EXPECT_NE(refusal(cup).find("unless origin = \"as_is\""), std::string::npos) << refusal(cup);
  cup.mesh->origin_at_base = false;
  EXPECT_EQ(refusal(cup), "");
  VesselData ball = of_file("ball", icosphere(0.03, 3), 1e-3);
  ball.inner = {{false, {0, 1e-3}, {}, 0, 0}, {false, {29e-3, 1e-3}, {}, 0, 0}, {false, {29e-3, 59e-3}, {}, 0, 0}};
  EXPECT_NE(refusal(ball).find("passes through the mesh"), std::string::npos) << refusal(ball);
}

// What a sweep that goes on asks of its scene.
TEST_F(MeshVessel, KeysTellMeshesAndLatticesApart) {
  const auto key_of = [&](const TriangleMesh& mesh, double spacing) { return mesh_keys(loaded({of_file("mesh", mesh, spacing)})); };
  const std::string key = key_of(icosphere(0.03, 2), 2e-3);
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(key_of(icosphere(0.03, 2), 2e-3), key);
  EXPECT_NE(key_of(icosphere(0.03, 3), 2e-3), key);
  EXPECT_NE(key_of(icosphere(0.03, 2), 2.1e-3), key);
  const Scene two = loaded({of_file("a", icosphere(0.03, 2), 2e-3), beaker1(), of_file("b", icosphere(0.03, 2), 2e-3)});
  EXPECT_EQ(mesh_keys(two), key + " " + key);
  EXPECT_EQ(mesh_lines(two).find("vessel 'a': a.glb: 320 triangles"), 0u);
}

// The lattices come from a device that allowed less memory than this machine does.
TEST_F(MeshVessel, AResultsLatticesAreMadeAgainWhateverTheMemory) {
  const ScopedVariable cache("XDG_CACHE_HOME", folder_.c_str());
  const VesselData ball = of_file("ball", torus(0.03, 0.01, 12, 6), 0);
  Scene swept = scene_of({ball});
  swept.file = (folder_ / "scene.toml").string();
  MeshOptions small;
  small.most_bytes = 1 << 16;
  load_meshes(swept, small);
  const std::string keys = mesh_keys(swept), lattices = mesh_lattices(swept);
  EXPECT_EQ(lattices.substr(lattices.size() - 3), " 16");
  Scene again = scene_of({ball});
  EXPECT_EQ(reload_meshes(again, swept.file, keys, lattices), "");
  EXPECT_EQ(*again.vessels[0].mesh->body->lattice.words, *swept.vessels[0].mesh->body->lattice.words);
  Scene untold = scene_of({ball});
  EXPECT_NE(reload_meshes(untold, swept.file, keys, "").find("by which lattices"), std::string::npos);
  of_file("ball", torus(0.03, 0.01, 14, 6), 0);
  Scene other = scene_of({ball});
  EXPECT_NE(reload_meshes(other, swept.file, keys, lattices).find("not what they were"), std::string::npos);
  EXPECT_EQ(other.vessels[0].mesh->body, nullptr);
}

TEST_F(MeshVessel, AResultsMeshesAreLookedForBesideItThenWhereTheyLay) {
  const ScopedVariable cache("XDG_CACHE_HOME", folder_.c_str());
  const VesselData ball = of_file("ball", icosphere(0.03, 2), 2e-3);
  Scene swept = scene_of({ball});
  swept.file = (folder_ / "scene.toml").string();
  load_meshes(swept, MeshOptions());
  const std::filesystem::path moved = folder_ / "moved", mesh = ball.mesh->file;
  const std::string result = (moved / "a.nc").string(), beside = (moved / "scene.toml").string();
  std::filesystem::create_directory(moved);
  // why the meshes are not those, and the place where they were found
  const auto found = [&] {
    Scene again = scene_of({ball});
    again.file = swept.file;
    const std::string trouble = reload_meshes(again, result, mesh_keys(swept), mesh_lattices(swept), true);
    EXPECT_EQ(again.vessels[0].mesh->body != nullptr, trouble.empty());
    return std::pair(trouble, again.file);
  };
  const std::pair<std::string, std::string> here{"", beside}, there{"", swept.file};
  EXPECT_EQ(found(), there);
  std::filesystem::copy_file(folder_ / mesh, moved / mesh);
  EXPECT_EQ(found(), here);
  std::filesystem::rename(folder_ / mesh, folder_ / "kept");
  EXPECT_EQ(found(), here);
  of_file("ball", icosphere(0.03, 3), 2e-3);
  EXPECT_EQ(found(), here) << "another one lies at the old place";
  std::filesystem::rename(folder_ / mesh, moved / mesh);
  EXPECT_NE(found().first.find("not what they were"), std::string::npos) << "another one beside it, and none at the old place";
  std::filesystem::rename(folder_ / "kept", folder_ / mesh);
  EXPECT_EQ(found(), there);
  std::filesystem::remove(folder_ / mesh);
  std::filesystem::remove(moved / mesh);
  EXPECT_EQ(found().first, result + ": a mesh of its scene is missing: neither " + (moved / mesh).string() + " nor " +
                               (folder_ / mesh).string() + " exists");
}

TEST_F(MeshVessel, ASceneThatIsNotReadIsNotEvaluated) {
  const Scene scene = scene_of({of_file("ball", icosphere(0.03, 2), 1e-3)});
  EXPECT_THROW(make_core_evaluator(scene), Error);
  EXPECT_TRUE(has_meshes(scene));
  EXPECT_FALSE(has_meshes(scene_of({beaker1()})));
}

TEST_F(MeshVessel, ALatticeFitsTheDevice) {
  const std::uint64_t all = largest_buffer("core");
  EXPECT_LE(largest_lattice(all), LARGEST_LATTICE);
  EXPECT_EQ(largest_lattice(1000), 1000u);
  const std::uint64_t device = largest_buffer("vulkan");
  EXPECT_GT(device, 1u << 20);
  EXPECT_LT(device, all);
  EXPECT_THROW(largest_buffer("no such device"), Error);
}

}  // namespace
}  // namespace wholehand::sweeps
