// SPDX-License-Identifier: MIT
// Vessels from mesh files: what the kernels make of them, on any device.
// sanitizers: none (sampling its meshes would be most of a sanitized run; mesh_commands_test goes the same way)
#include "core/meshes/vessel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/mesh_vessel.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/support/whole_parity.h"

namespace wholehand {
namespace {

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

// Differences of two evaluators that should be one: root mean squares, which unlike largest values do not jump with where a contact
// falls in its cell.
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
    mesh.inner = inner_outline_of(outline);
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
    mesh.inner = inner_outline_of(outline);
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
  const double error = plain.vessels[0].mesh->body->lattice_error;

  // a file that lies on its side, stood up by the scene; centered by the scene again
  const TriangleMesh lying = placed_mesh(mug, {-PI / 2, 0, 0}, {0.5, -0.2, 0.1});
  VesselData stood = of_file("lying", lying, spacing);
  stood.mesh->rotate = {PI / 2, 0, 0};
  const Scene again = loaded({stood});
  const MeshBody &a = *plain.vessels[0].mesh->body, &b = *again.vessels[0].mesh->body;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(a.facts.low[k], b.facts.low[k], 1e-7);  // the file holds floats
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
  const double error = right.vessels[0].mesh->body->lattice_error;
  Random random(3);
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const Triple p{random.uniform(-0.07, 0.07), random.uniform(-0.01, 0.12), random.uniform(-0.05, 0.05)};
    const double distance = a->distance(0, p);
    if (distance > lattice_margin(right))
      continue;  // off the box it is a bound, and the boxes are not each other's image to a cell
    ++compared;
    EXPECT_NEAR(distance, b->distance(0, {-p[0], p[1], p[2]}), 2 * error);
  }
  EXPECT_GT(compared, 200);
  int feasible = 0;
  for (const GripInput& grip : side_grips(0.03, 0.09, 300)) {
    const GripInput other = mirrored_grip(grip);
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

// A saucer of 12 mm, of which no hand that keeps 15 mm off the table could touch anything. Its file has it 50 mm above its origin:
// what counts is how high it is.
TEST_F(MeshVessel, ATableAboveItsTopIsRefused) {
  const TriangleMesh saucer = placed_mesh(turned_mesh(cylinder("saucer", 120, 12, 2), 64, 2e-3), {}, {0, 0.05, 0});
  Scene scene = scene_of({of_file("saucer", saucer, 2e-3)});
  scene.file = (folder_ / "scene.toml").string();
  scene.table = TableData{15e-3};
  MeshOptions options;
  options.cache_folder = folder_.string();
  try {
    load_meshes(scene, options);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    const std::string line = error.what();
    EXPECT_NE(
        line.find("its mesh is 12 mm high, and clearance_mm = 15 reaches its top; allowed: a clearance of less than this height"),
        std::string::npos)
        << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  scene.table = TableData{10e-3};
  load_meshes(scene, options);
  EXPECT_NEAR(scene.vessels[0].height - scene.vessels[0].base, 12e-3, 1e-8);  // m: the file has floats
}

// Dry meshes and wet ones beside an outline, in both hands; the lattices in both storages.
TEST_F(MeshVessel, DevicesGiveWhatTheCoreGives) {
  for (const HandData& hand : {paper_hand(), left_hand()}) {
    VesselData dry = of_file("mug", mug_mesh(), 1.5e-3), wet = of_file("beaker", turned_mesh(beaker3(), 64, 2e-3), 1.5e-3);
    wet.inner = inner_outline_of(beaker3());
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
  EXPECT_TRUE(scene.vessels[0].mesh->body->lattice.halves);
  expect_parity(scene, "halves");
}

}  // namespace
}  // namespace wholehand
