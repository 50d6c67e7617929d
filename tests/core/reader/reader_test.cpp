// SPDX-License-Identifier: MIT
// Scene files: every key and every default.
#include "core/reader/reader.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "core/hand_size.h"
#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

TEST(SceneReader, LeavesEverythingElseAtItsDefault) {
  const Scene scene = scene_from(VESSEL);
  const Scene plain;
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.file, "test.toml");
  EXPECT_EQ(scene.text, VESSEL);
  EXPECT_EQ(scene.pose, Pose::articulated);
  EXPECT_EQ(scene.gravity, 9.80665);
  EXPECT_EQ(scene.hand.scale, 1);
  EXPECT_EQ(scene.hand.handedness, Handedness::right);
  EXPECT_EQ(scene.hand.joint_limit, plain.hand.joint_limit);
  EXPECT_EQ(scene.hand.fingers[1].segments, plain.hand.fingers[1].segments);
  ASSERT_EQ(scene.vessels.size(), 1u);
  const VesselData& vessel = scene.vessels[0];
  EXPECT_EQ(vessel.density, 2230);
  EXPECT_EQ(vessel.surface, Surface::solid);
  EXPECT_FALSE(vessel.mass);
  EXPECT_FALSE(vessel.force_range);
  EXPECT_FALSE(vessel.mesh);
  EXPECT_TRUE(vessel.guidance.empty());
  EXPECT_EQ(vessel.line, 2);
  EXPECT_EQ(vessel.column, 1);
  EXPECT_FALSE(scene.liquid);
  EXPECT_FALSE(scene.task);
  EXPECT_FALSE(scene.table);
  EXPECT_TRUE(scene.tilts.empty());
  EXPECT_FALSE(scene.until_poured);
  EXPECT_EQ(scene.force.range, 3);
  EXPECT_EQ(scene.force.torsion, 5e-3);
  EXPECT_EQ(scene.grips.sampling, Sampling::grid);
  EXPECT_TRUE(scene.grips.height_is_fraction);
  EXPECT_EQ(scene.grips.height.values, std::vector<double>{0.5});
  EXPECT_EQ(scene.grips.azimuth.values, std::vector<double>{0.0});
  EXPECT_EQ(scene.grips.hand_scale.values, std::vector<double>{1.0});
  EXPECT_EQ(scene.score.fingers, ScoreWeights{}.fingers);
  EXPECT_FALSE(scene.output.keep);
  EXPECT_EQ(scene.output.best, 20);
  EXPECT_EQ(scene.output.apart, 25e-3);
  EXPECT_EQ(scene.live.rate, 1000);
  EXPECT_FALSE(scene.device.has_gap);
}

const std::string SCENE_AND_HAND = R"(
[scene]
name = "all of it"
pose = "paper"
gravity_m_s2 = 1.62

[hand]
scale = 0.9
handedness = "left"
contact_tolerance_mm = 0.3
max_angle_deg = 30
paper_max_angle_deg = 7
depth_limit_mm = 4
joint_limit_deg = [80, 90, 70]

[hand.thumb]
base_mm = [1, 2, 3]
splay_deg = 11
segments_mm = [46, 31, 27]
radii_mm = [1, 2, 3, 4]

[hand.index]
base_mm = [4, 5, 6]
splay_deg = -9
arch_deg = 1
segments_mm = [68, 39, 22, 19]
radii_mm = [5, 4, 3, 2, 1]

[hand.middle]
splay_deg = 1
[hand.ring]
arch_deg = 5
[hand.little]
base_mm = [7, 8, 9]

[hand.angles]
thumb_abduction_deg = [61, 56]
thumb_mcp_deg = [5, 6]
thumb_ip_deg = [3, 46]
mcp_deg = [5, 67]
pip_deg = [13, 41]
dip_per_pip = 0.5
)";

TEST(SceneReader, ReadsSceneAndHand) {
  const Scene scene = scene_from(SCENE_AND_HAND + VESSEL);
  EXPECT_EQ(scene.name, "all of it");
  EXPECT_EQ(scene.pose, Pose::paper);
  EXPECT_EQ(scene.gravity, 1.62);
  const HandData& hand = scene.hand;
  EXPECT_EQ(hand.scale, 0.9);
  EXPECT_EQ(hand.handedness, Handedness::left);
  EXPECT_EQ(hand.contact_tolerance, 0.3e-3);
  EXPECT_EQ(hand.max_angle, radians(30));
  EXPECT_EQ(hand.paper_max_angle, radians(7));
  EXPECT_EQ(hand.depth_limit, 4e-3);
  EXPECT_EQ(hand.joint_limit, (std::array{radians(80), radians(90), radians(70)}));
  EXPECT_EQ(hand.fingers[0].base, (Triple{1e-3, 2e-3, 3e-3}));
  EXPECT_EQ(hand.fingers[0].splay, radians(11));
  EXPECT_EQ(hand.fingers[0].segments, (std::array{46e-3, 31e-3, 27e-3, 0.0}));
  EXPECT_EQ(hand.fingers[0].radii, (std::array{1e-3, 2e-3, 3e-3, 4e-3, 0.0}));
  EXPECT_EQ(hand.fingers[1].base, (Triple{4e-3, 5e-3, 6e-3}));
  EXPECT_EQ(hand.fingers[1].splay, radians(-9));
  EXPECT_EQ(hand.fingers[1].arch, radians(1));
  EXPECT_EQ(hand.fingers[1].segments, (std::array{68e-3, 39e-3, 22e-3, 19e-3}));
  EXPECT_EQ(hand.fingers[1].radii, (std::array{5e-3, 4e-3, 3e-3, 2e-3, 1e-3}));
  EXPECT_EQ(hand.fingers[2].splay, radians(1));
  EXPECT_EQ(hand.fingers[3].arch, radians(5));
  EXPECT_EQ(hand.fingers[3].splay, radians(7));  // untouched
  EXPECT_EQ(hand.fingers[4].base, (Triple{7e-3, 8e-3, 9e-3}));
  EXPECT_EQ(hand.thumb_abduction.open, radians(61));
  EXPECT_EQ(hand.thumb_abduction.closed, radians(56));
  EXPECT_EQ(hand.thumb_mcp.closed, radians(6));
  EXPECT_EQ(hand.thumb_ip.open, radians(3));
  EXPECT_EQ(hand.mcp.closed, radians(67));
  EXPECT_EQ(hand.pip.open, radians(13));
  EXPECT_EQ(hand.dip_per_pip, 0.5);
}

TEST(SceneReader, HandsOfPeople) {
  const Scene woman = scene_from("[hand]\nperson = { sex = \"female\", percentile = 5 }\n" + VESSEL);
  EXPECT_NEAR(size_of(woman.hand).length, surveyed_size(Sex::female, 5).length, 1e-15);
  EXPECT_NEAR(size_of(woman.hand).breadth, surveyed_size(Sex::female, 5).breadth, 1e-15);
  EXPECT_EQ(woman.hand.scale, 1);
  const Scene man = scene_from("[hand.person]\nsex = \"male\"\npercentile = 99.9\n" + VESSEL);
  EXPECT_NEAR(size_of(man.hand).length, surveyed_size(Sex::male, 99.9).length, 1e-15);
  // further keys change single numbers of that hand
  const Scene measured =
      scene_from("[hand]\nlength_mm = 171.5\nhandedness = \"left\"\nindex = { radii_mm = [0, 0, 0, 0, 0] }\n" + VESSEL);
  EXPECT_NEAR(size_of(measured.hand).length, 171.5e-3, 1e-15);
  EXPECT_EQ(measured.hand.handedness, Handedness::left);
  EXPECT_EQ(measured.hand.fingers[1].radii, (std::array<double, 5>{}));
  HandData whole;
  set_size(whole, {171.5e-3, expected_breadth(171.5e-3)});
  EXPECT_EQ(measured.hand.fingers[2].radii, whole.fingers[2].radii);
  EXPECT_EQ(measured.hand.fingers[1].segments, whole.fingers[1].segments);
  EXPECT_EQ(scene_from("[hand]\nlength_mm = 171.5\nscale = 0.5\n" + VESSEL).hand.scale, 0.5) << "it multiplies every hand";
}

TEST(SceneReader, ThePapersHand) {
  const HandData hand = scene_from("[hand]\nperson = \"paper\"\nscale = 1.5\ndepth_limit_mm = 4\n" + VESSEL).hand;
  EXPECT_NEAR(size_of(hand).breadth, 69.24e-3, 5e-6);
  EXPECT_EQ(hand.fingers[1].radii, paper_hand().fingers[1].radii);
  EXPECT_EQ(hand.scale, 1.5);
  EXPECT_EQ(hand.depth_limit, 4e-3);
}

TEST(SceneReader, RefusesHandsOfNobody) {
  const std::string either = "allowed: one of length_mm and person";
  expect_refusal("[hand]\nlength_mm = 180\nperson = @{ sex = \"male\", percentile = 5 }\n" + VESSEL,
                 "person beside length_mm; " + either);
  expect_refusal("[hand]\nperson = @\"paper\"\nlength_mm = 180\n" + VESSEL, "person beside length_mm; " + either);
  expect_refusal("[hand]\nlength_mm = @18\n" + VESSEL, "length_mm = 18; allowed: 100 to 300");
  expect_refusal("[hand]\nlength_mm = @nan\n" + VESSEL, "allowed: 100 to 300");
  expect_refusal("[hand]\nperson = @\"me\"\n" + VESSEL, "person = 'me'; allowed: \"paper\" or a table with sex and percentile");
  expect_refusal("[hand]\nperson = @5\n" + VESSEL, "person = 5; allowed: \"paper\" or a table with sex and percentile");
  expect_refusal("[hand]\nperson = @{ percentile = 5 }\n" + VESSEL, "[hand.person] lacks 'sex'; allowed: \"female\" or \"male\"");
  expect_refusal("[hand]\nperson = @{ sex = \"male\" }\n" + VESSEL, "[hand.person] lacks 'percentile'; allowed: 0.01 to 99.99");
  expect_refusal("[hand]\nperson = { sex = @\"child\", percentile = 5 }\n" + VESSEL, "allowed: \"female\" or \"male\"");
  for (const char* bad : {"0", "100", "-5", "inf"})
    expect_refusal("[hand]\nperson = { sex = \"male\", percentile = @" + std::string(bad) + " }\n" + VESSEL,
                   "allowed: 0.01 to 99.99");
}

TEST(SceneReader, TheDefaultHandIsWhatItsTableSays) {
  // lengths are divided, not multiplied: 44.69 mm must be the double 44.69e-3
  const Scene scene = scene_from(
      "[hand.thumb]\nbase_mm = [-22.03, -9.01, -18.03]\nsplay_deg = 10\n"
      "[hand.middle]\nsegments_mm = [64.69, 44.69, 26.37, 21.38]\n" +
      VESSEL);
  const HandData plain;
  EXPECT_EQ(scene.hand.fingers[0].base, plain.fingers[0].base);
  EXPECT_EQ(scene.hand.fingers[2].segments, plain.fingers[2].segments);
  EXPECT_EQ(scene.hand.fingers[0].splay, plain.fingers[0].splay);
}

const std::string THREE_VESSELS = R"(
[liquid]
fills = [0.5]
[[vessel]]
name = "glass"
shape = "cylinder"
diameter_mm = 70
height_mm = 100
wall_mm = 1.25
surface = "shell"
density_kg_m3 = 2500
force_range_N = 2.5
guidance_mm = [[30, 0], [60.5, 90]]
place_mm = [100, 0, -200]
liquid = { name = "acid", fill = 0.25 }

[[vessel]]
name = "weighed"
shape = "cylinder"
diameter_mm = 70
height_mm = 100
wall_mm = 1
mass_kg = 0.25
center_of_mass_mm = [1, 50, 2]

[[vessel]]
name = "scanned"
mesh = "cup.glb"
mesh_scale = 0.001
up = "z"
close_holes = true
rotate_deg = [90, 0, -45]
origin = "as_is"
grid_mm = 1.5
inner_outline = [{ line = [0, -3] }, { line = [20, -3] }, { arc = [30, 7], center = [20, 7] }, { line = [30, 80] }]
)";

TEST(SceneReader, ReadsVessels) {
  const Scene scene = scene_from(THREE_VESSELS);
  ASSERT_EQ(scene.vessels.size(), 3u);
  const VesselData& glass = scene.vessels[0];
  EXPECT_EQ(glass.name, "glass");
  EXPECT_EQ(glass.height, 0.1);
  EXPECT_EQ(glass.wall, 1.25e-3);
  EXPECT_EQ(glass.surface, Surface::shell);
  EXPECT_EQ(glass.density, 2500);
  EXPECT_EQ(glass.force_range, 2.5);
  ASSERT_EQ(glass.guidance.size(), 2u);
  EXPECT_EQ(glass.guidance[1].height, 60.5e-3);
  EXPECT_EQ(glass.guidance[1].azimuth, radians(90));
  EXPECT_EQ(glass.place, (Triple{0.1, 0, -0.2}));
  EXPECT_EQ(glass.liquid_name, "acid");
  EXPECT_EQ(glass.liquid_fill, 0.25);
  EXPECT_FALSE(glass.mass);
  const VesselData& weighed = scene.vessels[1];
  EXPECT_EQ(weighed.mass, 0.25);
  EXPECT_EQ(weighed.center_of_mass, (Triple{1e-3, 50e-3, 2e-3}));
  EXPECT_EQ(weighed.line, 17);
  const VesselData& scanned = scene.vessels[2];
  ASSERT_TRUE(scanned.mesh);
  EXPECT_EQ(scanned.mesh->file, "cup.glb");
  EXPECT_EQ(scanned.mesh->scale, 0.001);
  EXPECT_TRUE(scanned.mesh->z_is_up);
  EXPECT_TRUE(scanned.mesh->close_holes);
  EXPECT_EQ(scanned.mesh->rotate, (Triple{radians(90), 0, radians(-45)}));
  EXPECT_FALSE(scanned.mesh->origin_at_base);
  EXPECT_FALSE(scanned.mesh->origin);
  EXPECT_TRUE(scanned.mesh->parts.empty());
  EXPECT_FALSE(scanned.mesh->thickness);
  EXPECT_EQ(scanned.mesh->lattice_spacing, 1.5e-3);
  ASSERT_EQ(scanned.inner.size(), 4u);
  EXPECT_EQ(scanned.inner[0].end, (std::array<double, 2>{0, -3e-3}));
  EXPECT_TRUE(scanned.inner[2].is_arc);
  EXPECT_EQ(scanned.inner[2].center, (std::array<double, 2>{20e-3, 7e-3}));
  // every 15 degrees where no azimuth is given
  EXPECT_EQ(scene.grips.azimuth.values.size(), 24u);
  EXPECT_EQ(scene.grips.azimuth.values[1], radians(15));
  EXPECT_TRUE(scanned.outline.empty());
}

TEST(SceneReader, ReadsPartsOriginAndThicknessOfAMesh) {
  const auto mesh = [](const std::string& keys) {
    return scene_from("[[vessel]]\nname = \"v\"\nmesh = \"a.glb\"\n" + keys).vessels[0].mesh.value();
  };
  EXPECT_EQ(mesh("part = 1").parts, std::vector<int>{1});
  EXPECT_EQ(mesh("part = 100000").parts, std::vector<int>{100000});
  EXPECT_EQ(mesh("part = [3, 1, 2]").parts, (std::vector<int>{3, 1, 2}));
  EXPECT_EQ(mesh("origin = [1.5, -20, 0]").origin, (Triple{1.5e-3, -20e-3, 0}));
  EXPECT_TRUE(mesh("origin = \"base\"").origin_at_base);
  EXPECT_FALSE(mesh("origin = \"base\"").origin);
  EXPECT_EQ(mesh("thickness_mm = 2.5").thickness, 2.5e-3);
  EXPECT_EQ(mesh("thickness_mm = 0.05\nclose_holes = false").thickness, 0.05e-3);
}

TEST(SceneReader, ReadsLiquidForceScoreAndOutput) {
  const Scene scene = scene_from(R"(
[liquid]
density_kg_m3 = 789
fills = [0, 0.5, 1]
pour = "towards"
[force]
base_N = 1
range_N = 2
torque = "exact"
reference = "per_grip"
max_N = 12
k_open_N_m = 500
friction = 0.5
torsion_mm = 4
[score]
fingers = 1
contacts = 2
depth = 3
posture = 4
force = 5
hold = 6
[output]
keep = ["score", "gap"]
best = 7
apart_mm = 40
)" + VESSEL);
  ASSERT_TRUE(scene.liquid);
  EXPECT_EQ(scene.liquid->density, 789);
  EXPECT_EQ(scene.liquid->fills, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(scene.liquid->pour, Pour::towards);
  EXPECT_EQ(scene.force.base, 1);
  EXPECT_EQ(scene.force.range, 2);
  EXPECT_EQ(scene.force.torque, Torque::exact);
  EXPECT_EQ(scene.force.reference, TorqueReference::per_grip);
  EXPECT_EQ(scene.force.max, 12);
  EXPECT_EQ(scene.force.k_open, 500);
  EXPECT_EQ(scene.force.friction, 0.5);
  EXPECT_EQ(scene.force.torsion, 4e-3);
  EXPECT_EQ(scene.score.fingers, 1);
  EXPECT_EQ(scene.score.contacts, 2);
  EXPECT_EQ(scene.score.depth, 3);
  EXPECT_EQ(scene.score.posture, 4);
  EXPECT_EQ(scene.score.force, 5);
  EXPECT_EQ(scene.score.hold, 6);
  EXPECT_EQ(scene.output.keep, (std::vector<std::string>{"score", "gap"}));
  EXPECT_EQ(scene.output.best, 7);
  EXPECT_EQ(scene.output.apart, 40e-3);
  EXPECT_EQ(scene_from("[output]\nalso = [\"joints\"]" + VESSEL).output.also, std::vector<std::string>{"joints"});
  expect_refusal("[output]\nkeep = [\"score\"]\nalso = @[\"joints\"]" + VESSEL, "both also and keep are given");
  expect_refusal("[output]\nalso = [\"joints\", @\"joints\"]" + VESSEL, "also names 'joints' a second time");
}

TEST(SceneReader, ReadsRobust) {
  EXPECT_FALSE(scene_from(VESSEL).robust);
  const Scene usual = scene_from("[robust]\nroll_deg = 3" + VESSEL);
  ASSERT_TRUE(usual.robust);
  EXPECT_EQ(usual.robust->roll, radians(3));
  EXPECT_EQ(usual.robust->count, 64);
  EXPECT_EQ(usual.robust->seed, 1u);
  EXPECT_EQ(usual.robust->height, 0);
  const RobustData aimed = scene_from("[robust]\ncount = 16" + VESSEL).robust.value();
  EXPECT_EQ(std::tuple(aimed.height, aimed.offset, aimed.obliquity, aimed.roll), std::tuple(3e-3, 3e-3, radians(5), radians(5)));
  EXPECT_EQ(std::tuple(aimed.azimuth, aimed.friction, aimed.hand_scale, aimed.count), std::tuple(0.0, 0.0, 0.0, 16));
  const Scene all = scene_from(
      "[robust]\nheight_mm = 3\nazimuth_deg = 4\nobliquity_deg = 5\noffset_mm = 6\nfriction = 0.07\nhand_scale = 0.08\n"
      "count = 128\nseed = 9" +
      VESSEL);
  EXPECT_EQ(all.robust->height, 3e-3);
  EXPECT_EQ(all.robust->azimuth, radians(4));
  EXPECT_EQ(all.robust->obliquity, radians(5));
  EXPECT_EQ(all.robust->offset, 6e-3);
  EXPECT_EQ(all.robust->friction, 0.07);
  EXPECT_EQ(all.robust->hand_scale, 0.08);
  EXPECT_EQ(all.robust->count, 128);
  EXPECT_EQ(all.robust->seed, 9u);
}

TEST(SceneReader, ReadsArm) {
  EXPECT_FALSE(scene_from(VESSEL).arm);
  const Scene usual = scene_from("[arm]" + VESSEL);
  ASSERT_TRUE(usual.arm);
  EXPECT_EQ(*usual.arm, ArmData());
  const Scene left = scene_from("[hand]\nhandedness = \"left\"\n[arm]" + VESSEL);
  EXPECT_EQ(left.arm->shoulder, (Triple{-0.2, 0.35, 0.4})) << "on the side of the hand";
  const ArmData all = *scene_from(
                           "[hand]\nhandedness = \"left\"\n[arm]\nshoulder_mm = [1, 2, 3]\nupper_arm_mm = 300\nforearm_mm = 250\n"
                           "wrist_radius_mm = 25\nelbow_radius_mm = 50\nflexion_deg = 60\nextension_deg = 61\nradial_deg = 20\n"
                           "ulnar_deg = 30\npronation_deg = 80\nsupination_deg = 81" +
                           VESSEL)
                           .arm;
  EXPECT_EQ(all.shoulder, (Triple{1e-3, 2e-3, 3e-3})) << "as given, whatever the hand";
  EXPECT_EQ(all.upper_arm, 0.3);
  EXPECT_EQ(all.forearm, 0.25);
  EXPECT_EQ(all.wrist_radius, 25e-3);
  EXPECT_EQ(all.elbow_radius, 50e-3);
  EXPECT_EQ(all.flexion, radians(60));
  EXPECT_EQ(all.extension, radians(61));
  EXPECT_EQ(all.radial, radians(20));
  EXPECT_EQ(all.ulnar, radians(30));
  EXPECT_EQ(all.pronation, radians(80));
  EXPECT_EQ(all.supination, radians(81));
}

TEST(SceneReader, ReadsSpheresBetweenJoints) {
  EXPECT_EQ(scene_from(VESSEL).hand.between, 2);
  EXPECT_EQ(scene_from("[hand]\nbetween = 0" + VESSEL).hand.between, 0);
  EXPECT_EQ(scene_from("[hand]\nbetween = 8" + VESSEL).hand.between, 8);
}

TEST(SceneReader, ReadsTheTable) {
  const Scene usual = scene_from("[table]\n" + VESSEL);
  ASSERT_TRUE(usual.table);
  EXPECT_EQ(usual.table->clearance, 2e-3);
  EXPECT_EQ(scene_from("[table]\nclearance_mm = 0" + VESSEL).table->clearance, 0);
  EXPECT_EQ(scene_from("[table]\nclearance_mm = 7.5" + VESSEL).table->clearance, 7.5e-3);
  EXPECT_EQ(scene_from("[table]\nclearance_mm = 100" + VESSEL).table->clearance, 0.1);
  expect_refusal("[table]\nclearance_mm = @-0.1" + VESSEL, "clearance_mm = -0.1; allowed: 0 to 100");
  expect_refusal("[table]\nclearance_mm = @100.1" + VESSEL, "clearance_mm = 100.1; allowed: 0 to 100");
  expect_refusal("[table]\nclearance_mm = @nan" + VESSEL, "allowed: 0 to 100");
  expect_refusal("[table]\nclearance_mm = @\"2\"" + VESSEL, "clearance_mm = '2'; allowed: a number");
  expect_refusal("table = @2" + VESSEL, "table = 2; allowed: a table");
}

TEST(SceneReader, ReadsAxesOfEveryForm) {
  const Scene scene = scene_from(R"(
[grips]
height_mm = { from = 10, to = 30, count = 3 }
azimuth_deg = [90, 0]
obliquity_deg = -5.5
roll_deg = { from = -90, to = 30, count = 16 }
offset_mm = [1]
hand_scale = { from = 0.8, to = 1.2, count = 2 }
[tilts]
deg = { from = 0, to = 150, count = 31 }
)" + VESSEL);
  const GripsData& grips = scene.grips;
  EXPECT_FALSE(grips.height_is_fraction);
  EXPECT_EQ(grips.height.values, (std::vector<double>{10e-3, 20e-3, 30e-3}));
  EXPECT_TRUE(grips.height.is_range);
  EXPECT_EQ(grips.azimuth.values, (std::vector<double>{radians(90), 0}));
  EXPECT_FALSE(grips.azimuth.is_range);
  EXPECT_EQ(grips.obliquity.values, std::vector<double>{radians(-5.5)});
  ASSERT_EQ(grips.roll.values.size(), 16u);
  EXPECT_EQ(grips.roll.values[1], radians(-82));
  EXPECT_EQ(grips.roll.values.back(), radians(30));
  EXPECT_EQ(grips.offset.values, std::vector<double>{1e-3});
  EXPECT_EQ(grips.hand_scale.values, (std::vector<double>{0.8, 1.2}));
  ASSERT_EQ(scene.tilts.size(), 31u);
  for (int i = 0; i < 31; ++i) EXPECT_EQ(scene.tilts[i], radians(5 * i));
  EXPECT_EQ(scene_from("[grips]\nheight_fraction = [0, 1]" + VESSEL).grips.height.values, (std::vector<double>{0, 1}));
  EXPECT_EQ(scene_from("[tilts]\ndeg = [0, 45, 180]" + VESSEL).tilts, (std::vector<double>{0, radians(45), radians(180)}));
}

TEST(SceneReader, ReadsTheShareThatIsPoured) {
  const std::string tilts = "[liquid]\nfills = [0.5]\n[tilts]\ndeg = [0, 45]\n";
  EXPECT_FALSE(scene_from(tilts + VESSEL).until_poured);
  EXPECT_EQ(scene_from(tilts + "until_poured = 0.25" + VESSEL).until_poured, 0.25);
  EXPECT_EQ(scene_from(tilts + "until_poured = 1" + VESSEL).until_poured, 1);
  EXPECT_EQ(scene_from("[tilts]\nuntil_poured = 0.5\ndeg = [0]\n[liquid]\nfills = [1]" + VESSEL).until_poured, 0.5);
}

TEST(SceneReader, ReadsSobolRangesWithAndWithoutCount) {
  const Scene scene = scene_from(R"(
[grips]
sampling = "sobol"
count = 10_000_000
seed = 42
height_fraction = { from = 0.1, to = 0.9 }
roll_deg = { from = -90, to = 30, count = 4 }
obliquity_deg = { from = 5, to = 5 }
)" + VESSEL);
  EXPECT_EQ(scene.grips.sampling, Sampling::sobol);
  EXPECT_EQ(scene.grips.count, 10000000u);
  EXPECT_EQ(scene.grips.seed, 42u);
  EXPECT_TRUE(scene.grips.height.is_range);
  EXPECT_EQ(scene.grips.height.values, (std::vector<double>{0.1, 0.9}));
  EXPECT_TRUE(scene.grips.roll.is_range);
  EXPECT_EQ(scene.grips.roll.values.size(), 4u);
  EXPECT_EQ(scene.grips.obliquity.values, std::vector<double>{radians(5)});
}

TEST(SceneReader, ReadsStrengths) {
  const std::string vessel = "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 2\n";
  EXPECT_EQ(scene_from(vessel).strength.value().digits, StrengthData{}.digits);
  EXPECT_TRUE(scene_from(vessel).strength.value().by_opening);
  EXPECT_FALSE(scene_from("[strength]\nefforts = false\n" + vessel).strength);
  EXPECT_TRUE(scene_from("[strength]\nefforts = true\nopening = \"measured\"\n" + vessel).strength.value().by_opening);
  EXPECT_FALSE(scene_from("[strength]\nopening = \"fixed\"\n" + vessel).strength.value().by_opening);
  EXPECT_EQ(scene_from("[strength]\n" + vessel).strength.value().digits, (std::array<double, 6>{40, 25, 35, 25, 14, 80}));
  EXPECT_EQ(scene_from("[strength]\nthumb_N = 41\nindex_N = 26\nmiddle_N = 36\nring_N = 27\nlittle_N = 15\npalm_N = 81\n" + vessel)
                .strength.value()
                .digits,
            (std::array<double, 6>{41, 26, 36, 27, 15, 81}));
}

TEST(SceneReader, ReadsLiveDeviceAndTask) {
  const Scene scene = scene_from(R"(
[liquid]
fills = [0]
[live]
rate_Hz = 4000
K_N_m = 700
B_Ns_m = 2
slip_mm = 9
ramp_s = 0.25
slew_N_s = 1000
jump_m_s = 4
late_steps = 5
slide = true
slide_by = "hand"
[device]
gap_mm = [0, 25]
workspace_scale = 1.5
origin_mm = [1, 2, 3]
axes = ["z", "-x", "-y"]
clutch_button = 1
library = "/opt/libdhd.so"
[task]
target = { place_mm = [0, 1, 2], diameter_mm = 90 }
amounts_ml = { acid = 50 }
destination_mm = [3, 4, 5]
tolerance_ml = 5
[[vessel]]
name = "v"
shape = "cylinder"
diameter_mm = 80
height_mm = 110
wall_mm = 2
liquid = { name = "acid", fill = 0.5 }
)");
  EXPECT_EQ(scene.live.rate, 4000);
  EXPECT_EQ(scene.live.stiffness, 700);
  EXPECT_EQ(scene.live.damping, 2);
  EXPECT_EQ(scene.live.slip, 9e-3);
  EXPECT_EQ(scene.live.ramp, 0.25);
  EXPECT_EQ(scene.live.slew, 1000);
  EXPECT_EQ(scene.live.jump, 4);
  EXPECT_EQ(scene.live.late_steps, 5);
  EXPECT_TRUE(scene.live.slide);
  EXPECT_EQ(scene.live.slide_by, SlideBy::hand);
  EXPECT_TRUE(scene.device.has_gap);
  EXPECT_EQ(scene.device.gap, (std::array{0.0, 25e-3}));
  EXPECT_EQ(scene.device.workspace_scale, 1.5);
  EXPECT_EQ(scene.device.origin, (Triple{1e-3, 2e-3, 3e-3}));
  EXPECT_EQ(scene.device.axes, (std::array<std::string, 3>{"z", "-x", "-y"}));
  EXPECT_EQ(scene.device.clutch_button, 1);
  EXPECT_EQ(scene.device.library, "/opt/libdhd.so");
  ASSERT_TRUE(scene.task);
  EXPECT_EQ(scene.task->target_place, (Triple{0, 1e-3, 2e-3}));
  EXPECT_EQ(scene.task->target_diameter, 90e-3);
  ASSERT_EQ(scene.task->amounts.size(), 1u);
  EXPECT_EQ(scene.task->amounts[0].first, "acid");
  EXPECT_EQ(scene.task->amounts[0].second, 50e-6);
  EXPECT_EQ(scene.task->destination, (Triple{3e-3, 4e-3, 5e-3}));
  EXPECT_EQ(scene.task->tolerance, 5e-6);
}

}  // namespace
}  // namespace wholehand
