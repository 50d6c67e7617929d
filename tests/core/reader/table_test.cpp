// SPDX-License-Identifier: MIT
// What scene files are refused for, table by table, with the place to which the refusal points.
#include "core/reader/table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

// A scene file, '@' where the refusal must point, and what that must say.
struct RefusedScene {
  const char* text;
  const char* gist;
};

constexpr RefusedScene NO_TOML[] = {
    {"[scene@\n", "allowed: TOML 1.0"},
    {"a = @", "allowed: TOML 1.0"},
};

// The first of the file is named.
constexpr RefusedScene UNKNOWN_KEYS[] = {
    {"[@secne]", "unknown key 'secne' in the scene; the nearest known key is 'scene'"},
    {"[scene]\n@pse = 1", "unknown key 'pse' in [scene]; the nearest known key is 'pose'"},
    {"[scene]\npose = \"paper\"\n@zz = 1\naa = 1", "unknown key 'zz' in [scene]"},
    {"[hand]\n@max_angle_dge = 3", "the nearest known key is 'max_angle_deg'"},
    {"[hand.@thunb]", "unknown key 'thunb' in [hand]; the nearest known key is 'thumb'"},
    {"[hand.thumb]\n@arch_deg = 3", "unknown key 'arch_deg' in [hand.thumb]"},
    {"[hand.angles]\n@dip_deg = [0, 1]", "in [hand.angles]"},
    {"[grips]\nroll_deg = { from = 1, to = 2, @cuont = 2 }", "unknown key 'cuont' in roll_deg; the nearest known key is 'count'"},
};

constexpr RefusedScene WRONG_TYPES[] = {
    {"scene = @3", "scene = 3; allowed: a table"},
    {"[scene]\npose = @3", "pose = 3; allowed: \"articulated\", \"paper\" or \"rigged\""},
    {"[scene]\ngravity_m_s2 = @\"heavy\"", "gravity_m_s2 = 'heavy'; allowed: a number, 0 to 100"},
    {"[scene]\ngravity_m_s2 = @true", "gravity_m_s2 = true; allowed: a number, 0 to 100"},
    {"[scene]\ngravity_m_s2 = @[9.8]", "gravity_m_s2 is an array; allowed: a number, 0 to 100"},
    {"[scene]\ngravity_m_s2 = @2020-01-01", "gravity_m_s2 is a date or time"},
    {"[scene]\nname = @3", "name = 3; allowed: a string of 1 to 64"},
    {"[scene]\nname = @\"a/b\"", "allowed: a name without '/'"},
    {"[scene]\nname = @\"a\\nb\"", "name = 'a\\x0ab'; allowed: a string"},
    {"[scene]\nname = @\"\"", "allowed: a string of 1 to 64"},
    {"[hand]\njoint_limit_deg = @[80, 90]", "joint_limit_deg has 2 entries; allowed: [MCP, PIP, DIP], 3 numbers"},
    {"[hand]\njoint_limit_deg = [80, @\"x\", 90]", "joint_limit_deg = 'x'; allowed: a number, 0 to 180"},
    {"[hand]\nthumb = @[]", "thumb is an array; allowed: a table"},
    {"[hand.thumb]\nsegments_mm = @[46, 31, 27, 20]", "segments_mm has 4 entries; allowed: from the base to the tip, 3 numbers"},
    {"[hand.index]\nradii_mm = @[5, 5, 5, 5]", "radii_mm has 4 entries; allowed: from the base to the tip, 5 numbers"},
    {"[output]\nbest = @2.0", "best = 2; allowed: a whole number, 0 to 100000"},
    {"[output]\nkeep = @\"score\"", "keep = 'score'; allowed: names of result variables"},
    {"[output]\nkeep = [\"score\", @3]", "a name in keep = 3"},
    {"[output]\nkeep = [\"score\", @\"score\"]", "keep names 'score' a second time"},
};

constexpr RefusedScene OUT_OF_RANGE[] = {
    {"[scene]\ngravity_m_s2 = @-1", "gravity_m_s2 = -1; allowed: 0 to 100"},
    {"[scene]\ngravity_m_s2 = @100.5", "gravity_m_s2 = 100.5; allowed: 0 to 100"},
    {"[scene]\ngravity_m_s2 = @nan", "gravity_m_s2 = nan; allowed: 0 to 100"},
    {"[scene]\ngravity_m_s2 = @inf", "gravity_m_s2 = inf; allowed: 0 to 100"},
    {"[scene]\ngravity_m_s2 = @-inf", "gravity_m_s2 = -inf; allowed: 0 to 100"},
    {"[scene]\ngravity_m_s2 = @9223372036854775807", "allowed: 0 to 100"},
    {"[hand]\nscale = @0.04", "scale = 0.04; allowed: 0.05 to 20"},
    {"[hand]\nhandedness = @\"Right\"", "handedness = 'Right'; allowed: \"right\" or \"left\""},
    {"[hand.angles]\nmcp_deg = [4, @200]", "mcp_deg = 200; allowed: -180 to 180"},
    {"[force]\nfriction = @-0.1", "friction = -0.1; allowed: 0 to 10"},
    {"[strength]\nthumb_N = @0", "thumb_N = 0; allowed: 0.1 to 10000"},
    {"[strength]\npalm_N = @-3", "palm_N = -3; allowed: 0.1 to 10000"},
    {"[strength]\nopening = @\"wide\"", "opening = 'wide'; allowed: \"measured\" or \"fixed\""},
    {"[strength]\nopening = @51", "opening = 51; allowed: \"measured\" or \"fixed\""},
    {"[strength]\nefforts = @\"no\"", "efforts = 'no'; allowed: true or false"},
    {"[strength]\nefforts = false\nindex_N = @25", "index_N beside efforts = false; allowed: efforts = false alone"},
    {"[strength]\nopening = @\"fixed\"\nefforts = false", "opening beside efforts = false; allowed: efforts = false alone"},
    {"[live]\nrate_Hz = @100", "rate_Hz = 100; allowed: 250 to 8000"},
    {"[live]\nslide = @1", "slide = 1; allowed: true or false"},
    {"[live]\nslide_by = @\"arm\"", "slide_by = 'arm'; allowed: \"tips\" or \"hand\""},
    {"[strength]\nefforts = false\n[live]\nslide_by = @\"hand\"", "slide_by = \"hand\" beside [strength] efforts = false"},
    {"[live]\nlate_steps = @0", "late_steps = 0; allowed: a whole number, 1 to 1000"},
    {"[output]\nbest = @-1", "best = -1; allowed: a whole number, 0 to 100000"},
    {"[output]\napart_mm = @-1", "apart_mm = -1; allowed: 0 to 10000"},
    {"@[score]\nfingers = 0\ncontacts = 0\ndepth = 0\nposture = 0", "[score] weighs only force and hold, and there are no [tilts]"},
};

constexpr RefusedScene WRONG_AXES[] = {
    {"[grips]\nroll_deg = @[]", "roll_deg has 0 entries; allowed: 1 to 1000000 entries"},
    {"[grips]\nroll_deg = @\"all\"", "roll_deg = 'all'; allowed: a number, a list of 1 to 1000000 or {from, to, count}"},
    {"[grips]\nroll_deg = [1, 2, @1]", "roll_deg: 1 a second time; allowed: each value once"},
    {"[grips]\nroll_deg = [1, @400]", "a value of roll_deg = 400; allowed: -360 to 360"},
    {"[grips]\nroll_deg = @{ from = 1, to = 2 }", "roll_deg lacks 'count'"},
    {"[grips]\nroll_deg = @{ to = 2, count = 2 }", "roll_deg lacks 'from'"},
    {"[grips]\nroll_deg = { from = 1, to = 2, count = @0 }", "count = 0; allowed: a whole number, 1 to 1000000"},
    {"[grips]\nroll_deg = { from = 1, to = 2, count = @1000001 }", "count = 1000001; allowed: a whole number, 1 to 1000000"},
    {"[grips]\nroll_deg = { from = 1, to = 2, count = @1 }", "roll_deg: 1 values from 1 to 2; allowed: one value where from = to"},
    {"[grips]\nroll_deg = { from = 1, to = 1, count = @2 }", "roll_deg: 2 values from 1 to 1"},
    {"[grips]\nroll_deg = { from = 2, to = @1, count = 2 }", "roll_deg: to = 1 is below from; allowed: from <= to; from = 2"},
    {"[grips]\nheight_mm = 3\nheight_fraction = @0.5", "both height_fraction and height_mm are given; allowed: one of the two"},
    {"[grips]\nheight_fraction = @1.5", "height_fraction = 1.5; allowed: 0 to 1"},
    {"[grips]\nsampling = @\"random\"", "sampling = 'random'; allowed: \"grid\" or \"sobol\""},
    {"[grips]\ncount = @3", "count without sampling = \"sobol\""},
    {"[grips]\nseed = @3", "seed without sampling = \"sobol\""},
    {"@[grips]\nsampling = \"sobol\"", "[grips] lacks 'count'"},
    {"[grips]\nsampling = \"sobol\"\ncount = @0", "count = 0; allowed: a whole number, 1 to 1000000000000000"},
    {"[grips]\nsampling = \"sobol\"\ncount = 1\nseed = @-1", "seed = -1; allowed: a whole number, 0 to 9223372036854775807"},
};

constexpr RefusedScene WRONG_TILTS_AND_FILLS[] = {
    {"@[tilts]", "[tilts] lacks 'deg'"},
    {"[tilts]\ndeg = @[]", "deg has 0 entries; allowed: 1 to 2048 entries"},
    {"[tilts]\ndeg = @3", "deg = 3; allowed: an ascending list"},
    {"[tilts]\ndeg = [0, @181]", "a value of deg = 181; allowed: 0 to 180"},
    {"[tilts]\ndeg = [0, 10, @10]", "deg: 10 after 10; allowed: values in ascending order, each once"},
    {"[tilts]\ndeg = { from = 0, to = 10, count = @2049 }", "count = 2049; allowed: a whole number, 1 to 2048"},
    {"[liquid]\nfills = [1]\n[tilts]\ndeg = [0]\nuntil_poured = @0", "until_poured = 0; allowed: 1e-06 to 1"},
    {"[liquid]\nfills = [1]\n[tilts]\ndeg = [0]\nuntil_poured = @-0.5", "until_poured = -0.5; allowed: 1e-06 to 1"},
    {"[liquid]\nfills = [1]\n[tilts]\ndeg = [0]\nuntil_poured = @1.01", "until_poured = 1.01; allowed: 1e-06 to 1"},
    {"[liquid]\nfills = [1]\n[tilts]\ndeg = [0]\nuntil_poured = @nan", "until_poured = nan; allowed: 1e-06 to 1"},
    {"[liquid]\nfills = [1]\n[tilts]\ndeg = [0]\nuntil_poured = @\"half\"", "until_poured = 'half'; allowed: a number, 1e-06 to 1"},
    {"[tilts]\ndeg = [0]\nuntil_poured = @0.5", "until_poured without [liquid]; allowed: in a scene with [liquid]"},
    {"@[liquid]", "[liquid] lacks 'fills'"},
    {"[liquid]\nfills = @0.5", "fills = 0.5; allowed: an ascending list of fractions"},
    {"[liquid]\nfills = [@-0.1]", "a value of fills = -0.1; allowed: 0 to 1"},
    {"[liquid]\nfills = [0.5, @0.25]", "fills: 0.25 after 0.5; allowed: values in ascending order"},
};

constexpr RefusedScene WRONG_STRENGTHS_AND_TABLES[] = {
    {"[strength]\nindex_N = @0", "index_N = 0; allowed: 0.1 to 10000"},
    {"[strength]\nmiddle_N = @-0.1", "middle_N = -0.1; allowed: 0.1 to 10000"},
    {"[strength]\nring_N = @0.099", "ring_N = 0.099; allowed: 0.1 to 10000"},
    {"[strength]\nlittle_N = @10001", "little_N = 10001; allowed: 0.1 to 10000"},
    {"[strength]\npalm_N = @nan", "palm_N = nan; allowed: 0.1 to 10000"},
    {"[strength]\nthumb_N = @inf", "thumb_N = inf; allowed: 0.1 to 10000"},
    {"[strength]\nthumb_N = @\"strong\"", "thumb_N = 'strong'; allowed: a number, 0.1 to 10000"},
    {"[strength]\nthumb_N = @0\nindex_N = 0\nmiddle_N = 0\nring_N = 0\nlittle_N = 0\npalm_N = 0",
     "thumb_N = 0; allowed: 0.1 to 10000"},
    {"strength = @40", "strength = 40; allowed: a table"},
    {"[arm]\nflexion_deg = @-76", "flexion_deg = -76; allowed: 1 to 180"},
    {"[arm]\nextension_deg = @0", "extension_deg = 0; allowed: 1 to 180"},
    {"[arm]\nradial_deg = @nan", "radial_deg = nan; allowed: 1 to 180"},
    {"[arm]\nulnar_deg = @181", "ulnar_deg = 181; allowed: 1 to 180"},
    {"[arm]\npronation_deg = @[-76, 82]", "pronation_deg is an array; allowed: a number, 1 to 180"},
    {"[arm]\nsupination_deg = @\"far\"", "supination_deg = 'far'; allowed: a number, 1 to 180"},
    {"[arm]\nshoulder_mm = @[200, 350]", "shoulder_mm"},
    {"[arm]\nshoulder_mm = [200, @nan, 400]", "nan; allowed: -10000 to 10000"},
    {"[arm]\nforearm_mm = @0", "forearm_mm = 0; allowed: 10 to 5000"},
    {"[arm]\nupper_arm_mm = @inf", "upper_arm_mm = inf; allowed: 10 to 5000"},
    {"[arm]\nelbow_radius_mm = @0", "elbow_radius_mm = 0; allowed: 1 to 500"},
    {"[arm]\n@wrist_deg = 3", "wrist_deg"},
    {"arm = @1", "arm = 1; allowed: a table"},
    {"@[robust]\nroll_deg = 0\ncount = 64", "[robust] has no standard deviation; allowed: at least one of height_mm,"},
    {"[robust]\nroll_deg = @-1", "roll_deg = -1; allowed: 0 to 90"},
    {"[robust]\nheight_mm = @nan", "height_mm = nan; allowed: 0 to 100"},
    {"[robust]\nfriction = @1.5", "friction = 1.5; allowed: 0 to 1"},
    {"[robust]\nhand_scale = @0.5", "hand_scale = 0.5; allowed: 0 to 0.3"},
    {"[robust]\nroll_deg = 3\ncount = @7", "count = 7; allowed: a whole number, 8 to 4096"},
    {"[robust]\nroll_deg = 3\nseed = @-1", "seed = -1; allowed: a whole number, 0 to"},
    {"[robust]\n@tilt_deg = 3", "tilt_deg"},
    {"robust = @1", "robust = 1; allowed: a table"},
    {"[hand]\nbetween = @-1", "between = -1; allowed: a whole number, 0 to 8"},
    {"[hand]\nbetween = @9", "between = 9; allowed: a whole number, 0 to 8"},
    {"[hand]\nbetween = @2.5", "between = 2.5; allowed: a whole number, 0 to 8"},
    {"[table]\nclearance_mm = @-1", "clearance_mm = -1; allowed: 0 to 100"},
    {"[table]\nclearance_mm = @101", "clearance_mm = 101; allowed: 0 to 100"},
    {"[table]\nclearance_mm = @nan", "clearance_mm = nan; allowed: 0 to 100"},
    {"table = @true", "table = true; allowed: a table"},
};

constexpr RefusedScene WRONG_LIVE_DEVICE_AND_TASK[] = {
    {"[device]\ngap_mm = @[25, 0]", "gap_mm = [25, 0]; allowed: [closed, open]"},
    {"[device]\naxes = [\"x\", \"y\", @\"-x\"]", "an entry of axes = '-x'"},
    {"[device]\naxes = [\"x\", \"y\", @\"w\"]", "an entry of axes = 'w'"},
    {"[device]\naxes = @[\"x\"]", "axes has 1 entries"},
    {"[device]\naxes = @[\"-x\", \"y\", \"z\"]", "mirrors the device"},
    {"[device]\naxes = @[\"y\", \"x\", \"z\"]", "mirrors the device"},
    {"@[task]", "[task] lacks 'target'"},
    {"[task]\ntarget = @{ place_mm = [0, 0, 0] }", "[task.target] lacks 'diameter_mm'"},
};

struct RefusedSubject {
  const char* name;
  std::span<const RefusedScene> scenes;
};

constexpr RefusedSubject REFUSED_SUBJECTS[] = {
    {"TOML itself", NO_TOML},
    {"unknown keys", UNKNOWN_KEYS},
    {"types", WRONG_TYPES},
    {"ranges", OUT_OF_RANGE},
    {"axes", WRONG_AXES},
    {"tilts and fills", WRONG_TILTS_AND_FILLS},
    {"strengths and tables", WRONG_STRENGTHS_AND_TABLES},
    {"live, device and task", WRONG_LIVE_DEVICE_AND_TASK},
};

TEST(SceneTable, RefusesWithPlaceFoundAndAllowed) {
  for (const RefusedSubject& subject : REFUSED_SUBJECTS) {
    for (const auto& [text, gist] : subject.scenes) {
      SCOPED_TRACE(std::string(subject.name) + ": " + text);
      expect_refusal(std::string(text) + "\n" + VESSEL, gist);
    }
  }
}

// A table that reaches the mouth, with the clearance of the file and with the usual one of 2 mm.
TEST(SceneTable, RefusesATableAboveAVesselsMouth) {
  const auto vessel = [](const char* name, double height) {
    return fmt::format(
        "\n[[vessel]]\nname = \"{}\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = {}\nmass_kg = 1\n"
        "center_of_mass_mm = [0, 1, 0]\n",
        name, height);
  };
  expect_refusal("[table]\nclearance_mm = @60" + vessel("tall", 110) + vessel("low", 50),
                 "clearance_mm = 60 reaches the mouth of vessel 'low'; allowed: less than the vessel's height, 50 mm");
  expect_refusal("[table]\nclearance_mm = @50" + vessel("low", 50), "allowed: less than the vessel's height, 50 mm");
  expect_refusal("@[table]" + vessel("dish", 2), "clearance_mm = 2 reaches the mouth of vessel 'dish'");
  EXPECT_EQ(scene_from("[table]\nclearance_mm = 49.9" + vessel("low", 50)).table->clearance, 49.9e-3);
  EXPECT_EQ(scene_from("[table]" + vessel("dish", 2.1)).table->clearance, 2e-3);
}

TEST(SceneTable, RefusesVessels) {
  const std::string head = "[[vessel]]\nname = \"v\"\n",
                    cylinder = head + "shape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"@", "the scene lacks 'vessel'; allowed: 1 to 64 tables [[vessel]]"},
      {"vessel = @3", "vessel = 3; allowed: tables [[vessel]]"},
      {"vessel = @[]", "vessel has 0 entries"},
      {"vessel = [@3]", "an entry of vessel = 3"},
      {"@[vessel]\nname = \"v\"", "vessel is a table; allowed: tables [[vessel]]"},
      {"@[[vessel]]\nshape = \"cylinder\"", "[[vessel]] lacks 'name'"},
      {"[[vessel]]\nname = @\"1\"", "name = '1'; allowed: a letter, then letters, digits"},
      {"[[vessel]]\nname = @\"a b\"", "name = 'a b'"},
      {"@" + head, "vessel 'v' has no form; allowed: one of 'shape', 'outline' and 'mesh'"},
      {head + "shape = \"cylinder\"\noutline = @[]", "vessel 'v' has both 'shape' and 'outline'"},
      {head + "outline = []\nmesh = @\"a\"", "vessel 'v' has both 'outline' and 'mesh'"},
      {head + "shape = @\"cube\"", "shape = 'cube'; allowed: \"cylinder\", \"flask\" or \"conical\""},
      {head + "mesh = \"a.glb\"\nheight_mm = @3", "height_mm is given without 'shape'"},
      {cylinder + "grid_mm = @3", "grid_mm is given without 'mesh'"},
      {cylinder + "up = @\"z\"", "up is given without 'mesh'"},
      {cylinder + "close_holes = @true", "close_holes is given without 'mesh'"},
      {head + "mesh = \"a.stl\"\nup = @\"x\"", "up = 'x'"},
      {head + "mesh = \"a.stl\"\nclose_holes = @1", "close_holes = 1; allowed: true or false"},
      {cylinder + "part = @1", "part is given without 'mesh'"},
      {cylinder + "thickness_mm = @2", "thickness_mm is given without 'mesh'"},
      {cylinder + "origin = @[0, 0, 0]", "origin is given without 'mesh'"},
      {head + "mesh = \"a.stl\"\npart = @0", "part = 0; allowed: a whole number, 1 to 100000"},
      {head + "mesh = \"a.stl\"\npart = @100001", "part = 100001; allowed: a whole number, 1 to 100000"},
      {head + "mesh = \"a.stl\"\npart = @1.5", "part = 1.5; allowed: a whole number, 1 to 100000"},
      {head + "mesh = \"a.stl\"\npart = @\"cup\"", "part = 'cup'; allowed: a whole number, 1 to 100000"},
      {head + "mesh = \"a.stl\"\npart = @[]", "part has 0 entries; allowed: 1 to 1000 entries, numbers from 1"},
      {head + "mesh = \"a.stl\"\npart = [1, @0]", "an entry of part = 0; allowed: a whole number, 1 to 100000"},
      {head + "mesh = \"a.stl\"\npart = [1, @2.0]", "an entry of part = 2; allowed: a whole number, 1 to 100000"},
      {head + "mesh = \"a.stl\"\npart = [@\"cup\"]", "an entry of part = 'cup'; allowed: a whole number, 1 to 100000"},
      {head + "mesh = \"a.stl\"\norigin = @\"top\"", "origin = 'top'; allowed: \"base\" or \"as_is\""},
      {head + "mesh = \"a.stl\"\norigin = @[1, 2]", "origin has 2 entries"},
      {head + "mesh = \"a.stl\"\norigin = [1, @\"x\", 2]", "origin = 'x'"},
      {head + "mesh = \"a.stl\"\norigin = [1, 2, @1.1e12]", "origin = 1100000000000; allowed: -1000000000000 to 1000000000000"},
      {head + "mesh = \"a.stl\"\nthickness_mm = @0", "thickness_mm = 0; allowed: 0.05 to 100"},
      {head + "mesh = \"a.stl\"\nthickness_mm = @101", "thickness_mm = 101; allowed: 0.05 to 100"},
      {head + "mesh = \"a.stl\"\nthickness_mm = @nan", "thickness_mm = nan; allowed: 0.05 to 100"},
      {head + "mesh = \"a.stl\"\nthickness_mm = @\"2\"", "thickness_mm = '2'; allowed: a number"},
      {head + "mesh = \"a.stl\"\nclose_holes = true\nthickness_mm = @2",
       "both close_holes and thickness_mm are given; allowed: thickness_mm for a sheet, whose mouth stays open, or close_holes"},
      {cylinder + "inner_outline = @[]", "inner_outline has 0 entries"},
      {head + "mesh = \"a.glb\"\nwall_mm = @2", "wall_mm is given for a mesh; allowed: with 'shape' or 'outline'"},
      {head + "mesh = \"a.glb\"\nfloor_mm = @2", "floor_mm is given for a mesh; allowed: with 'shape' or 'outline'"},
      {head + "mesh = \"a.glb\"\nsurface = @\"shell\"", "surface is given for a mesh; allowed: with 'shape' or 'outline'"},
      {head + "mesh = \"a.glb\"\ninner_outline = [@{line = [1, 2]}, {line = [3, 9]}]",
       "the inner outline begins at [1, 2], off the axis"},
      {head + "mesh = \"a.glb\"\ninner_outline = [{line = [0, 2]}, {line = [3, 9]}, @{line = [3, 8]}]",
       "the inner outline falls between [3, 9] and [3, 8]"},
      {head + "mesh = \"a.glb\"\ninner_outline = [{line = [0, 2]}, @{line = [3, 2]}]",
       "the inner outline ends at [3, 2], which is not a mouth"},
      {head + "mesh = \"a.glb\"\ninner_outline = [{line = [0, 2]}, @{line = [0, 9]}]",
       "the inner outline ends at [0, 9], which is not a mouth"},
      {head + "mesh = \"a.glb\"\ninner_outline = [{line = [0, 2]}, @{arc = [5, 2], center = [2.5, 4]}, {line = [5, 9]}]",
       "the inner outline falls between [0, 2] and [5, 2]"},
      {head + "mesh = \"a.glb\"\ninner_outline = [{line = [0, 2]}, @{line = [0, 2]}, {line = [5, 9]}]", "an element has no length"},
      {head + "mesh = \"a.glb\"\ninner_outline = @[]", "inner_outline has 0 entries"},
      {"[liquid]\nfills = [1]\n@" + head + "mesh = \"a.glb\"\nliquid = {name = \"tea\", fill = 1}",
       "vessel 'v' has a liquid and is a mesh without 'inner_outline'"},
      {cylinder + "neck_mm = @3", "neck_mm is not a dimension of a cylinder; allowed: diameter_mm, height_mm"},
      {"@" + head + "shape = \"cylinder\"\ndiameter_mm = 80",
       "[[vessel]] lacks 'height_mm'; allowed: a cylinder with diameter_mm, height_mm"},
      {head + "shape = \"cylinder\"\ndiameter_mm = @0.5\nheight_mm = 110", "diameter_mm = 0.5; allowed: 1 to 10000"},
      {head + "shape = \"flask\"\ndiameter_mm = 80\nneck_mm = @80\nheight_mm = 110",
       "neck_mm = 80; allowed: less than diameter_mm = 80"},
      {head + "shape = \"flask\"\ndiameter_mm = 80\nneck_mm = 30\nheight_mm = @70", "height_mm = 70; allowed: more than 77.081"},
      {head + "shape = \"conical\"\ndiameter_mm = 80\nneck_mm = 30\nupright_mm = @90\nshoulder_mm = 90\nheight_mm = 110",
       "upright_mm = 90; allowed: less than shoulder_mm = 90"},
      {head + "shape = \"conical\"\ndiameter_mm = 80\nneck_mm = 30\nupright_mm = 0\nshoulder_mm = @110\nheight_mm = 110",
       "shoulder_mm = 110; allowed: less than height_mm = 110"},
      {"@" + cylinder, "vessel 'v' has no mass; allowed: 'wall_mm' or 'inner_outline', or 'mass_kg' and 'center_of_mass_mm'"},
      {cylinder + "wall_mm = @40", "wall_mm = 40; allowed: less than the vessel's largest radius, 40 mm"},
      {head + "shape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 20\nwall_mm = @20",
       "wall_mm = 20; allowed: less than the vessel's height, 20 mm"},
      {cylinder + "wall_mm = @0", "wall_mm = 0; allowed: 0.05 to 100"},
      {cylinder + "surface = @\"shell\"", "surface = 'shell' without a wall"},
      {cylinder + "mass_kg = @1", "mass_kg without center_of_mass_mm; allowed: both or neither; a mesh may have mass_kg alone"},
      {cylinder + "wall_mm = 1\ncenter_of_mass_mm = @[0, 0, 0]", "center_of_mass_mm without mass_kg"},
      {cylinder + "mass_kg = 1\ncenter_of_mass_mm = [0, 0, 0]\ndensity_kg_m3 = @2230",
       "both density_kg_m3 and mass_kg are given; allowed: one of the two"},
      {"[liquid]\nfills = [0]\n@" + cylinder + "mass_kg = 1\ncenter_of_mass_mm = [0, 0, 0]",
       "vessel 'v' has no 'wall_mm' and no 'inner_outline', so [liquid] cannot fill it"},
      {"@" + cylinder + "wall_mm = 1\nliquid = { name = \"a\", fill = 1 }",
       "vessel 'v' has a liquid, but the scene has no [liquid]"},
      {cylinder + "wall_mm = 1\nliquid = @{ name = \"a\" }", "[vessel.liquid] lacks 'fill'"},
      {cylinder + "wall_mm = 1\nguidance_mm = [[1, 2], @[3]]",
       "an entry of guidance_mm has 1 entries; allowed: [height_mm, azimuth_deg]"},
      {cylinder + "wall_mm = 1\nguidance_mm = [[1, @\"x\"]]", "azimuth in guidance_mm = 'x'"},
      {cylinder + "wall_mm = 1\n[[vessel]]\nname = @\"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 1",
       "a second vessel 'v'; allowed: another name, as the vessel in line 1 has this one"},
      {"[liquid]\nfills = [0]\n[task]\ntarget = { place_mm = [0, 0, 0], diameter_mm = 3 }\namounts_ml = { acdi = @5 "
       "}\ndestination_mm = [0, 0, 0]\ntolerance_ml = 1\n" +
           cylinder + "wall_mm = 1\nliquid = { name = \"acid\", fill = 1 }",
       "amounts_ml names 'acdi', which no vessel holds; the nearest liquid is 'acid'"},
  };
  for (const auto& [text, gist] : cases) expect_refusal(text, gist);
  std::string many;
  for (int i = 0; i < 65; ++i)
    many +=
        "[[vessel]]\nname = \"v" + std::to_string(i) + "\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 1\n";
  expect_refusal("@" + many, "vessel has 65 entries; allowed: 1 to 64 entries");
}

}  // namespace
}  // namespace wholehand
