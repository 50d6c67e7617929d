// SPDX-License-Identifier: MIT
// Scene files: keys that are misspelt, keys in the reference, the shipped scenes, and files that are none.
#include "core/reader/reader.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "base/text/error.h"
#include "tests/support/files.h"
#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

std::string scenes_dir() { return WHOLEHAND_SOURCE_DIR "/examples/scenes/"; }

const std::map<std::string, std::vector<std::string>> SCENE_KEYS{
    {"[scene]", {"name", "pose", "gravity_m_s2"}},
    {"[hand]",
     {"scale", "length_mm", "person", "handedness", "contact_tolerance_mm", "max_angle_deg", "paper_max_angle_deg",
      "depth_limit_mm", "joint_limit_deg", "thumb", "index", "middle", "ring", "little", "angles"}},
    {"[hand.person]", {"sex", "percentile"}},
    {"[hand.thumb]", {"base_mm", "splay_deg", "segments_mm", "radii_mm"}},
    {"[hand.index]", {"base_mm", "splay_deg", "arch_deg", "segments_mm", "radii_mm"}},
    {"[hand.little]", {"base_mm", "splay_deg", "arch_deg", "segments_mm", "radii_mm"}},
    {"[hand.angles]", {"thumb_abduction_deg", "thumb_mcp_deg", "thumb_ip_deg", "mcp_deg", "pip_deg", "dip_per_pip"}},
    {"[[vessel]]",
     {"name",     "shape",      "diameter_mm", "height_mm",     "neck_mm", "upright_mm",        "shoulder_mm",   "outline",
      "mesh",     "mesh_scale", "rotate_deg",  "origin",        "grid_mm", "inner_outline",     "wall_mm",       "floor_mm",
      "surface",  "up",         "close_holes", "density_kg_m3", "mass_kg", "center_of_mass_mm", "force_range_N", "guidance_mm",
      "place_mm", "liquid",     "part",        "thickness_mm"}},
    {"[liquid]", {"density_kg_m3", "fills", "fills_ml", "pour"}},
    {"[force]", {"base_N", "range_N", "torque", "reference", "max_N", "k_open_N_m", "friction", "torsion_mm"}},
    {"[strength]", {"thumb_N", "index_N", "middle_N", "ring_N", "little_N", "palm_N", "opening", "efforts"}},
    {"[grips]",
     {"height_mm", "height_fraction", "azimuth_deg", "obliquity_deg", "roll_deg", "offset_mm", "hand_scale", "sampling", "count",
      "seed"}},
    {"[tilts]", {"deg", "until_poured"}},
    {"[score]", {"fingers", "contacts", "depth", "posture", "force", "hold"}},
    {"[output]", {"keep", "also", "best", "apart_mm"}},
    {"[table]", {"clearance_mm"}},
    {"[arm]",
     {"shoulder_mm", "upper_arm_mm", "forearm_mm", "wrist_radius_mm", "elbow_radius_mm", "flexion_deg", "extension_deg",
      "radial_deg", "ulnar_deg", "pronation_deg", "supination_deg"}},
    {"[people]",
     {"women",
      "scatter",
      "size",
      "proportions",
      "height_mm",
      "azimuth_deg",
      "obliquity_deg",
      "roll_deg",
      "reaction_s",
      "response_s",
      "gain",
      "margin",
      "friction",
      "weight_guess",
      "grip_tremor",
      "grip_error",
      "tremor_Hz",
      "arm_tremor_mm",
      "finger_mass_kg",
      "arm_mass_kg",
      "arm_damping_Ns_m",
      "arm_stiffness_N_m",
      "finger_damping_Ns_m",
      "finger_stiffness_N_m",
      "patience_s",
      "strength"}},
    {"[live]", {"rate_Hz", "K_N_m", "B_Ns_m", "slip_mm", "ramp_s", "slew_N_s", "jump_m_s", "late_steps", "slide", "slide_by"}},
    {"[device]", {"gap_mm", "workspace_scale", "origin_mm", "axes", "clutch_button", "library"}},
    {"[task]", {"target", "amounts_ml", "destination_mm", "tolerance_ml"}},
};

TEST(SceneReader, EveryMisspeltKeyGetsTheRightOneSuggested) {
  for (const auto& [table, keys] : SCENE_KEYS) {
    for (const std::string& key : keys) {
      const std::string misspelt = key + "x";
      const std::string vessel = table == "[[vessel]]" ? "" : VESSEL;
      expect_refusal(table + "\n@" + misspelt + " = 1\n" + vessel,
                     "unknown key '" + misspelt + "' in " + table + "; the nearest known key is '" + key + "'");
    }
  }
}

TEST(SceneReader, EveryKeyIsInTheReference) {
  const std::string reference = file_text(std::string(WHOLEHAND_SOURCE_DIR) + "/docs/scene.md");
  for (const auto& [table, keys] : SCENE_KEYS) {
    EXPECT_NE(reference.find("`" + table + "`"), std::string::npos) << table;
    for (const std::string& key : keys) EXPECT_NE(reference.find("`" + key + "`"), std::string::npos) << table << " " << key;
  }
}

TEST(SceneReader, ReadsTheShippedScenes) {
  const Scene beakers = read_scene_file(scenes_dir() + "three_beakers.toml");
  EXPECT_EQ(beakers.name, "three_beakers");
  EXPECT_EQ(beakers.text, file_text(scenes_dir() + "three_beakers.toml"));
  ASSERT_EQ(beakers.vessels.size(), 3u);
  EXPECT_EQ(beakers.vessels[0].name, "beaker1");
  EXPECT_EQ(beakers.vessels[1].name, "beaker2");
  EXPECT_EQ(beakers.vessels[2].name, "beaker3");
  EXPECT_EQ(beakers.vessels[0].force_range, 2);
  EXPECT_EQ(beakers.vessels[1].force_range, 3);
  EXPECT_EQ(beakers.vessels[2].force_range, 4);
  for (const auto& vessel : beakers.vessels) {
    EXPECT_EQ(vessel.wall, 1.5e-3);
    EXPECT_EQ(vessel.density, 2230);
    EXPECT_EQ(vessel.surface, Surface::solid);
  }
  EXPECT_EQ(beakers.vessels[0].height, 0.11);
  EXPECT_EQ(beakers.vessels[1].height, 0.14);
  EXPECT_EQ(beakers.vessels[2].height, 0.145);
  EXPECT_EQ(beakers.pose, Pose::articulated);
  EXPECT_EQ(beakers.grips.height.values.size() * beakers.grips.azimuth.values.size() * beakers.grips.obliquity.values.size() *
                beakers.grips.roll.values.size() * beakers.grips.offset.values.size() * beakers.grips.hand_scale.values.size(),
            34816u);
  EXPECT_EQ(beakers.grips.height.values.front(), 0.10);
  EXPECT_EQ(beakers.grips.height.values.back(), 0.95);
  EXPECT_EQ(beakers.liquid->fills, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(beakers.tilts.size(), 31u);
  EXPECT_EQ(beakers.tilts.back(), radians(150));
  EXPECT_EQ(beakers.output.best, 20);

  const Scene paper = read_scene_file(scenes_dir() + "paper_pose.toml");
  EXPECT_EQ(paper.pose, Pose::paper);
  EXPECT_FALSE(paper.liquid);
  for (const auto& finger : paper.hand.fingers) EXPECT_EQ(finger.radii, (std::array<double, 5>{}));

  const Scene small = read_scene_file(scenes_dir() + "small.toml");
  EXPECT_EQ(small.hand.handedness, Handedness::left);
  EXPECT_EQ(small.vessels[0].surface, Surface::shell);
  EXPECT_TRUE(small.vessels[0].outline[1].is_arc);
}

TEST(SceneReader, RefusesFilesThatAreNone) {
  const auto refusal = [](const std::string& path) -> std::string {
    try {
      read_scene_file(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("/nowhere/scene.toml"), "no scene file '/nowhere/scene.toml'; give the path of a TOML file");
  EXPECT_EQ(refusal("/"), "'/' is a directory; give the path of a scene file");
  EXPECT_EQ(refusal(""), "no scene file ''; give the path of a TOML file");
  EXPECT_NE(refusal("/dev/zero").find("/dev/zero:1:1: more than 1,048,576 bytes"), std::string::npos);
  EXPECT_NE(refusal("/dev/null").find("/dev/null:1:1: the scene lacks 'vessel'"), std::string::npos);
}

}  // namespace
}  // namespace wholehand
