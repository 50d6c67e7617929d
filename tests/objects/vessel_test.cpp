// SPDX-License-Identifier: MIT
// Vessels from mesh files: what is read, what the kernels make of it, and what is refused.
// sanitizers: none (sampling its meshes would be most of a sanitized run; mesh_commands_test goes the same way)
#include "objects/vessel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "host/open_backend.h"
#include "objects/check.h"
#include "tests/support/environment.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

class MeshVessel : public testing::Test {
 protected:
  MeshVessel()
      : folder_(std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
  }
  ~MeshVessel() override { std::filesystem::remove_all(folder_); }

  // A vessel whose file holds that mesh, not yet read.
  VesselData of_file(const std::string& name, const TriangleMesh& mesh, double spacing) {
    std::ofstream((folder_ / (name + ".glb")).string(), std::ios::binary) << glb_text(mesh);
    VesselData vessel;
    vessel.name = name;
    vessel.mesh.emplace();
    vessel.mesh->place = "scene.toml:3:8";
    vessel.mesh->file = name + ".glb";
    if (spacing > 0) vessel.mesh->grid_spacing = spacing;
    return vessel;
  }

  // Seconds that each look at the clock takes; 0: the machine's clock.
  double seconds_a_look_ = 0;

  // Read, in a scene with everything that a vessel can be asked.
  Scene loaded(std::vector<VesselData> vessels, const HandData& hand = {}) {
    Scene scene = wet_scene(std::move(vessels), Pose::articulated, hand);
    scene.file = (folder_ / "scene.toml").string();
    said_.clear();
    MeshOptions options;
    options.cache_folder = folder_.string();
    if (seconds_a_look_ > 0) options.clock = [this, now = 0.0]() mutable { return now += seconds_a_look_; };
    options.say = [this](const std::string& line) { said_ += line + "\n"; };
    load_meshes(scene, options);
    return scene;
  }

  std::string refusal(const VesselData& vessel) {
    try {
      loaded({vessel});
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
  std::string said_;
};

// The cavity of an outline with a wall as an inner outline.
std::vector<OutlineElement> inner_of(const VesselData& vessel) {
  const PreparedVessel prepared = prepare_vessel(vessel, true);
  std::vector<OutlineElement> inner{{false, {0, prepared.floor_height}, {}, 0, 0}};
  std::array<double, 2> at{0, prepared.floor_height};
  for (const PreparedElement& piece : prepared.cavity) {
    if (piece.a != at) inner.push_back({false, piece.a, {}, 0, 0});
    inner.push_back({piece.side != 0, piece.b, piece.center, 0, 0});
    at = piece.b;
  }
  return inner;
}

// The handle of a mug: a torus about z that lies in the wall at +x, so that no direction is like another.
TriangleMesh mug_mesh() {
  TriangleMesh handle = torus(0.024, 0.0055, 48, 16);
  for (Triple& p : handle.vertices) p = {p[0] + 0.04, p[2] + 0.05, -p[1]};  // about z; a rotation, so that it stays outward
  return joined(turned_mesh(beaker1(), 96, 2e-3), handle);
}

// Grips whose fingers meet the wall well off edges, lid and base.
std::vector<GripInput> side_grips(double low, double high, int count) {
  Random random(11);
  std::vector<GripInput> grips;
  for (int i = 0; i < count; ++i) {
    GripInput grip;
    grip.height = random.uniform(low, high);
    grip.azimuth = random.uniform(-PI, PI);
    grip.obliquity = random.uniform(-0.2, 0.2);
    grip.roll = random.uniform(-PI / 2, 0.5);
    grips.push_back(grip);
  }
  return grips;
}

// Differences of two evaluators that should be one: root mean squares, which unlike largest values do not jump with where a contact falls
// in its cell.
struct Differences {
  double gap = 0, midpoint = 0, force = 0;
  int feasible = 0;
};

Differences differences(const Evaluator& a, const Evaluator& b, const std::vector<GripInput>& grips, double fill, double tilt) {
  Differences mean;
  for (const GripInput& grip : grips) {
    GripResult x, y;
    a.grip(0, grip, x);
    b.grip(0, grip, y);
    EXPECT_EQ(x.reason, y.reason);
    if (x.reason != Reason::none || y.reason != Reason::none) continue;
    ++mean.feasible;
    mean.gap += std::pow(x.gap - y.gap, 2);
    for (int k = 0; k < 3; ++k) mean.midpoint += std::pow(x.midpoint[k] - y.midpoint[k], 2);
    const double of_x = a.state(0, grip, x, a.liquid(0, fill, tilt), tilt).normal_force,
                 of_y = b.state(0, grip, y, b.liquid(0, fill, tilt), tilt).normal_force;
    mean.force += std::pow(of_x - of_y, 2);
  }
  for (double* sum : {&mean.gap, &mean.midpoint, &mean.force}) *sum = std::sqrt(*sum / mean.feasible);
  return mean;
}

// Chords of a turned mesh lie within the outline by r (1 - cos(pi / around)); the liquid and, but for that, the glass are the same.
TEST_F(MeshVessel, ABeakerReadBackWeighsAndPoursAsItsOutline) {
  for (const VesselData& outline : {beaker1(), beaker2(), beaker3()}) {
    const int around = 256;
    VesselData mesh = of_file(outline.name, turned_mesh(outline, around, 0.5e-3), 2e-3);
    mesh.inner = inner_of(outline);
    const Scene scene = loaded({mesh}), exact_scene = wet_scene({outline}, Pose::articulated);
    EXPECT_TRUE(scene.vessels[0].mesh->body->holds_cavity);
    EXPECT_NEAR(scene.vessels[0].height, outline.height, 1e-8);  // the file holds floats
    const auto read = make_core_evaluator(scene), exact = make_core_evaluator(exact_scene);
    EXPECT_NEAR(read->capacity(0), exact->capacity(0), 1e-12 * exact->capacity(0)) << outline.name;
    // a share of 2 / 3 (pi / around)^2 of what the hull encloses, several times the glass
    const double lost = std::pow(PI / around, 2) * (exact->capacity(0) * outline.density + exact->empty_mass(0));
    EXPECT_NEAR(read->empty_mass(0), exact->empty_mass(0), lost) << outline.name;
    EXPECT_NEAR(read->empty_center_of_mass(0)[1], exact->empty_center_of_mass(0)[1], lost / exact->empty_mass(0) * outline.height)
        << outline.name;
    for (const double fill : {0.4, 1.0})
      for (const double tilt : {0.0, 0.6, 1.4}) {
        const LiquidResult a = read->liquid(0, fill, tilt), b = exact->liquid(0, fill, tilt);
        EXPECT_NEAR(a.volume, b.volume, 1e-11 * exact->capacity(0));
        EXPECT_NEAR(a.height, b.height, 1e-9);
        EXPECT_NEAR(a.lean, b.lean, 1e-9);
      }
  }
}

// In the flask's belly the surface is smooth: halving spacing and chord quarters the error of distances, gaps and forces.
TEST_F(MeshVessel, AFlaskReadBackConvergesAtSecondOrder) {
  const VesselData outline = beaker2();
  const auto exact = make_core_evaluator(wet_scene({outline}, Pose::articulated));
  const auto grips = side_grips(0.03, 0.055, 400);
  std::vector<Differences> found;
  std::vector<double> distances;
  for (const int level : {0, 1, 2}) {
    const double spacing = 6e-3 / (1 << level), chord = 6e-3 / (1 << level);
    VesselData mesh = of_file("flask", turned_mesh(outline, 48 << level, chord), spacing);
    mesh.inner = inner_of(outline);
    mesh.mass = 0.1;  // that of the glass converges too, but not with the lattice
    mesh.center_of_mass = {0, 0.05, 0};
    VesselData same_mass = outline;
    same_mass.mass = mesh.mass;
    same_mass.center_of_mass = mesh.center_of_mass;
    const auto read = make_core_evaluator(loaded({mesh})), weighed = make_core_evaluator(wet_scene({same_mass}, Pose::articulated));
    found.push_back(differences(*read, *weighed, grips, 0.4, 0.8));
    double worst = 0;
    Random random(5);
    for (int i = 0; i < 4000; ++i) {  // within 8 mm of the belly's wall
      const double azimuth = random.uniform(0, 2 * PI), lift = random.uniform(-0.6, 0.6), r = 0.0425 + random.uniform(-8e-3, 8e-3);
      const Triple p{r * std::cos(lift) * std::cos(azimuth), 0.0425 + r * std::sin(lift), r * std::cos(lift) * std::sin(azimuth)};
      worst = std::max(worst, std::abs(read->distance(0, p) - exact->distance(0, p)));
    }
    distances.push_back(worst);
    EXPECT_GT(found.back().feasible, 350);
  }
  // over both halvings: 16 at second order, 4 at first; what falls where in its cell makes single ratios jump
  const auto ratio = [&](double Differences::*what) { return found[0].*what / (found[2].*what); };
  for (const double r :
       {distances[0] / distances[2], ratio(&Differences::gap), ratio(&Differences::midpoint), ratio(&Differences::force)}) {
    EXPECT_GT(r, 9);
    EXPECT_LT(r, 28);
  }
  EXPECT_LT(distances[2], 0.1e-3);
  EXPECT_LT(found[2].gap, 0.1e-3);
  EXPECT_LT(found[2].force, 1e-4);
}

// As far as the lattice's stated error goes, wherever the mesh lies in its lattice: on both sides a contact may be that far off.
TEST_F(MeshVessel, TurnedAndMovedCopiesGiveTheSameGrips) {
  const TriangleMesh mug = mug_mesh();
  const double spacing = 1e-3;
  const Scene plain = loaded({of_file("mug", mug, spacing)});
  const auto there = make_core_evaluator(plain);
  const double error = plain.vessels[0].mesh->body->grid_error;

  // a file that lies on its side, stood up by the scene; centred by the scene again
  const TriangleMesh lying = placed_mesh(mug, {-PI / 2, 0, 0}, {0.5, -0.2, 0.1});
  VesselData stood = of_file("lying", lying, spacing);
  stood.mesh->rotate = {PI / 2, 0, 0};
  const Scene again = loaded({stood});
  const MeshBody &a = *plain.vessels[0].mesh->body, &b = *again.vessels[0].mesh->body;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(a.low[k], b.low[k], 1e-7);  // the file holds floats
    EXPECT_NEAR(a.center_of_mass[k], b.center_of_mass[k], 1e-7);
  }
  const auto grips = side_grips(0.03, 0.09, 300);
  const auto moved = make_core_evaluator(again);
  int feasible = 0;
  for (const GripInput& grip : grips) {
    GripResult x, y;
    there->grip(0, grip, x);
    moved->grip(0, grip, y);
    if (x.reason != Reason::none || x.grazing || x.contact_angles[0] > 1 || x.contact_angles[1] > 1) continue;
    ASSERT_EQ(y.reason, Reason::none);
    EXPECT_NEAR(x.gap, y.gap, 4 * error);  // two contacts, each aslant by up to 1 rad
    ++feasible;
  }
  EXPECT_GT(feasible, 200);

  // turned about its axis, and the grips with it
  const double turn = 0.7;
  VesselData turned = of_file("turned", placed_mesh(mug, {0, turn, 0}, {0, 0, 0}), spacing);
  turned.mesh->origin_at_base = false;  // the box's middle does not turn with the mug
  VesselData straight = of_file("straight", mug, spacing);
  straight.mesh->origin_at_base = false;
  const auto before = make_core_evaluator(loaded({straight})), after = make_core_evaluator(loaded({turned}));
  feasible = 0;
  for (GripInput grip : grips) {
    GripResult x, y;
    before->grip(0, grip, x);
    grip.azimuth += turn;
    after->grip(0, grip, y);
    if (x.reason != Reason::none || x.grazing || x.contact_angles[0] > 1 || x.contact_angles[1] > 1) continue;
    ASSERT_EQ(y.reason, Reason::none);
    EXPECT_NEAR(x.gap, y.gap, 4 * error);
    ++feasible;
  }
  EXPECT_GT(feasible, 200);
}

// The lattice of the mirrored mesh is the mirrored lattice but for where its samples fall, so both are compared at one mesh.
TEST_F(MeshVessel, ALeftHandHoldsTheMirrorImage) {
  const TriangleMesh mug = mug_mesh();
  TriangleMesh image = mug;
  for (Triple& p : image.vertices) p[0] = -p[0];
  for (auto& triangle : image.triangles) std::swap(triangle[1], triangle[2]);
  const Scene right = loaded({of_file("mug", mug, 1e-3)}), left = loaded({of_file("image", image, 1e-3)}, left_hand());
  const auto a = make_core_evaluator(right), b = make_core_evaluator(left);
  const double error = right.vessels[0].mesh->body->grid_error;
  Random random(3);
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const Triple p{random.uniform(-0.07, 0.07), random.uniform(-0.01, 0.12), random.uniform(-0.05, 0.05)};
    const double distance = a->distance(0, p);
    if (distance > grid_margin(right)) continue;  // off the box it is a bound, and the boxes are not each other's image to a cell
    ++compared;
    EXPECT_NEAR(distance, b->distance(0, {-p[0], p[1], p[2]}), 2 * error);
  }
  EXPECT_GT(compared, 200);
  int feasible = 0;
  for (const GripInput& grip : side_grips(0.03, 0.09, 300)) {
    GripInput other = grip;
    other.azimuth = PI - grip.azimuth;
    other.offset = -grip.offset;
    GripResult x, y;
    a->grip(0, grip, x);
    b->grip(0, other, y);
    if (x.reason != Reason::none || x.grazing || x.contact_angles[0] > 1 || x.contact_angles[1] > 1) continue;
    ASSERT_EQ(y.reason, Reason::none);
    EXPECT_NEAR(x.gap, y.gap, 4 * error);
    EXPECT_NEAR(x.midpoint[0], -y.midpoint[0], 4 * error);
    EXPECT_NEAR(x.midpoint[2], y.midpoint[2], 4 * error);
    ++feasible;
  }
  EXPECT_GT(feasible, 200);
  EXPECT_NEAR(a->empty_center_of_mass(0)[0], -b->empty_center_of_mass(0)[0], 1e-9);
  EXPECT_GT(std::abs(a->empty_center_of_mass(0)[0]), 1e-4);
}

// Dry meshes and wet ones beside an outline, in both hands; the lattices in both storages.
TEST_F(MeshVessel, DevicesGiveWhatTheCoreGives) {
  for (const HandData& hand : {HandData{}, left_hand()}) {
    VesselData dry = of_file("mug", mug_mesh(), 1.5e-3), wet = of_file("beaker", turned_mesh(beaker3(), 64, 2e-3), 1.5e-3);
    wet.inner = inner_of(beaker3());
    const Scene scene = loaded({dry, wet, beaker1()}, hand);
    expect_parity(scene, "meshes");
  }
  VesselData vessel = of_file("mug", mug_mesh(), 1.5e-3);
  Scene scene = wet_scene({vessel}, Pose::articulated);
  scene.file = (folder_ / "scene.toml").string();
  MeshOptions options;
  options.cache_folder = folder_.string();
  options.most_bytes = 3u << 20;  // floats would take more than half of it
  load_meshes(scene, options);
  EXPECT_TRUE(scene.vessels[0].mesh->body->grid.halves);
  expect_parity(scene, "halves");
}

TEST_F(MeshVessel, LongWorkIsSaidBeforeWithItsTime) {
  seconds_a_look_ = 1;
  const PreparedGrid grid = loaded({of_file("ball", icosphere(0.03, 2), 3e-3)}).vessels[0].mesh->body->grid;
  const std::string said = said_;
  const std::size_t before = said.find("its lattice of 3 mm has "), after = said.find("lattice of 3 mm, ");
  ASSERT_NE(before, std::string::npos) << said;
  EXPECT_LT(before, after) << said;
  EXPECT_NE(said.find("samples, which take about "), std::string::npos) << said;
  EXPECT_NE(said.find("a larger grid_mm takes less"), std::string::npos) << said;
  EXPECT_GT(grid.ny * grid.nz, 12 * 64) << "one second for a row a thread is over 10 s of all";
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
  PreparedGrid grid;
  grid.spacing = 1e-3;
  grid.nx = 100;
  grid.ny = 200;
  grid.nz = 300;
  EXPECT_EQ(forecast_text(grid, 53.2, false),
            "its lattice of 1 mm has 6,000,000 samples, which take about 54 s, as the mesh is open; a closed one, or a larger "
            "grid_mm, takes less");
  EXPECT_EQ(forecast_text(grid, 503, true),
            "its lattice of 1 mm has 6,000,000 samples, which take about 8 min 23 s; a larger grid_mm takes less");
}

TEST_F(MeshVessel, ATinyMeshIsWarnedOfAndGetsASmallLattice) {
  TriangleMesh ball = icosphere(0.04e-3, 1);
  const Scene scene = loaded({of_file("tiny", ball, 0)});
  EXPECT_NE(said_.find("the likely scale is mesh_scale = 1000, with which it is 80 mm large"), std::string::npos) << said_;
  EXPECT_LE(4 * scene.vessels[0].mesh->body->grid.words->size(), 4u << 20) << "an answer soon";
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
  EXPECT_NE(refusal(bowl).find("scene.toml:3:8: bowl.glb: close_holes: a hole is "), std::string::npos) << refusal(bowl);
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
  vessel.inner = inner_of(beaker1());
  const auto core = make_core_evaluator(loaded({vessel}));
  const auto exact = make_core_evaluator(wet_scene({beaker1()}, Pose::articulated));
  // inner and outer wall shrink alike: 2 / 3 (pi / around)^2 of the glass
  EXPECT_NEAR(core->empty_mass(0), exact->empty_mass(0), 1e-3 * exact->empty_mass(0));
  EXPECT_EQ(core->capacity(0), exact->capacity(0));
}

TEST_F(MeshVessel, OverlappingOrInvertedBodiesWeighWhatTheyHold) {
  const TriangleMesh large = box_mesh({0, 0, 0}, {0.06, 0.1, 0.06});
  VesselData overlap = of_file("overlap", joined(large, box_mesh({0.01, 0.06, 0.005}, {0.05, 0.12, 0.055})), 1e-3);
  // by lattices of 1 mm, see enclosed_volume's test
  EXPECT_NEAR(make_core_evaluator(loaded({overlap}))->empty_mass(0), 400e-6 * overlap.density, 0.003 * 400e-6 * overlap.density);
  EXPECT_NE(said_.find("its bodies overlap, or not all face outward"), std::string::npos) << said_;
  EXPECT_NE(said_.find("give mass_kg"), std::string::npos) << said_;
  // beside each other, and one of them inside out
  TriangleMesh inverted = box_mesh({0.1, 0, 0}, {0.14, 0.06, 0.05});
  for (auto& triangle : inverted.triangles) std::swap(triangle[1], triangle[2]);
  VesselData two = of_file("two", joined(large, inverted), 1e-3);
  EXPECT_NEAR(make_core_evaluator(loaded({two}))->empty_mass(0), 480e-6 * two.density, 0.003 * 480e-6 * two.density);
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
  // the farther of base and top from the middle, where the centre of mass is
  const VesselConstants constants = make_core_evaluator(scene)->constants(0);
  EXPECT_NEAR(constants.torque_reference, constants.mass * scene.gravity * 0.03, 1e-6);
}

TEST_F(MeshVessel, SaysWhatItIs) {
  loaded({of_file("ball", icosphere(0.03, 3), 1e-3)});
  for (const char* part :
       {"vessel 'ball': ball.glb: 1280 triangles", "closed", "lattice of 1 mm", "of 32 bits", "at 4096 points of the surface"})
    EXPECT_NE(said_.find(part), std::string::npos) << part << " in\n" << said_;
  loaded({of_file("huge", icosphere(30, 2), 0)});
  EXPECT_NE(said_.find("mesh_scale = 0.001"), std::string::npos) << said_;
}

TEST_F(MeshVessel, WhatCannotBeUsedIsRefusedInOneLine) {
  VesselData vessel = of_file("ball", icosphere(0.03, 3), 0.05e-3);
  vessel.mesh->grid_spacing = 0.05e-3;
  EXPECT_NE(refusal(vessel).find("grid_mm: a lattice of 0.05 mm"), std::string::npos);
  vessel.mesh->grid_spacing = 1e-3;
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
  cup.inner = inner_of(beaker1());
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

// Of a device that allowed less than this machine does.
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
  EXPECT_EQ(*again.vessels[0].mesh->body->grid.words, *swept.vessels[0].mesh->body->grid.words);
  Scene untold = scene_of({ball});
  EXPECT_NE(reload_meshes(untold, swept.file, keys, "").find("by which lattices"), std::string::npos);
  of_file("ball", torus(0.03, 0.01, 14, 6), 0);
  Scene other = scene_of({ball});
  EXPECT_NE(reload_meshes(other, swept.file, keys, lattices).find("not what they were"), std::string::npos);
  EXPECT_EQ(other.vessels[0].mesh->body, nullptr);
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
}  // namespace wholehand
