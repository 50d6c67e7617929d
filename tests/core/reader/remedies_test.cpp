// SPDX-License-Identifier: MIT
// A scene is accepted once it is as its refusal says.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

// A scene, words of its refusal, and the scene as these words make it.
struct Case {
  std::string text, words, mended;
};

void expect_accepted(const std::vector<Case>& cases) {
  for (const Case& each : cases) {
    const std::string refusal = refusal_of(each.text);
    EXPECT_NE(refusal.find(each.words), std::string::npos) << refusal << "\nlacks " << each.words << "\nof\n" << each.text;
    EXPECT_EQ(refusal_of(each.mended), "accepted") << each.words << "\n" << each.mended;
  }
}

const std::string HEAD = "[[vessel]]\nname = \"v\"\n", FORM = HEAD + "shape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\n",
                  SOLID = "mass_kg = 1\ncenter_of_mass_mm = [0, 50, 0]\n";

TEST(SceneRemedies, HelpVessels) {
  const std::string outline = HEAD + "outline = [{ line = [40, 0] }, { line = [40, 100] }, { line = [0, 100] }]\n",
                    mesh = HEAD + "mesh = \"a.obj\"\n";
  const std::string walled = FORM + "wall_mm = 2\n",
                    inner = "inner_outline = [{ line = [0, 3] }, { line = [37, 3] }, { line = [37, 110] }]\n";
  const std::string with_liquid = "liquid = { name = \"red\", fill = 0.5 }\n", liquid = "[liquid]\nfills = [0]\n";
  expect_accepted({
      {FORM, "allowed: 'wall_mm'", walled},
      {FORM, "or 'inner_outline'", FORM + inner},
      {FORM, "or 'mass_kg' and 'center_of_mass_mm'", FORM + SOLID},
      {FORM + "mass_kg = 1\n", "allowed: both or neither", FORM + SOLID},
      {walled + "center_of_mass_mm = [0, 50, 0]\n", "allowed: both or neither", walled},
      {FORM + SOLID + "density_kg_m3 = 2230\n", "allowed: one of the two", FORM + SOLID},
      {FORM + SOLID + "surface = \"shell\"\n", "allowed: with 'wall_mm' or 'inner_outline'", walled + "surface = \"shell\"\n"},
      {FORM + SOLID + "floor_mm = 5\n", "allowed: with 'wall_mm'", walled + "floor_mm = 5\n"},
      {walled + inner, "allowed: inner_outline alone", FORM + inner},
      {walled + mesh.substr(HEAD.size()), "allowed: one of 'shape', 'outline' and 'mesh'", walled},
      {HEAD, "allowed: one of 'shape', 'outline' and 'mesh'", walled},
      {HEAD, "allowed: one of 'shape', 'outline' and 'mesh'", mesh},
      {mesh + "wall_mm = 2\n", "'inner_outline' gives its cavity", mesh + inner},
      {mesh + "wall_mm = 2\n", "allowed: with 'shape' or 'outline'", outline + "wall_mm = 2\n"},
      {mesh + with_liquid + liquid, "allowed: with 'inner_outline'", mesh + inner + with_liquid + liquid},
      {walled + "mesh_scale = 2\n", "allowed: leave out mesh_scale", walled},
      {walled + "height_fraction = 1\n", "unknown key 'height_fraction' in [[vessel]]", walled},
      {walled + with_liquid, "allowed: both, or neither", walled + with_liquid + liquid},
      {FORM + SOLID + liquid, "allowed: one of the two keys in every shape and outline", walled + liquid},
      {FORM + SOLID + liquid, "or no [liquid]", FORM + SOLID},
      {walled + "liquid = { name = \"red\", fill = 0.5, fill_ml = 5 }\n" + liquid, "allowed: one of the two",
       walled + with_liquid + liquid},
      {walled + walled, "allowed: another name", walled + "[[vessel]]\nname = \"w\"\n" + walled.substr(HEAD.size())},
      {"[hand]\nperson = \"paper\"\nlength_mm = 180\n" + walled, "allowed: one of length_mm and person",
       "[hand]\nlength_mm = 180\n" + walled},
  });
}

TEST(SceneRemedies, HelpOutlines) {
  const auto outline = [](const std::string& elements) {
    return HEAD + "outline = [{ line = [40, 0] }, " + elements + "]\n" + SOLID;
  };
  const auto cavity = [](const std::string& elements) { return FORM + "inner_outline = [" + elements + "]\n"; };
  const std::string straight = outline("{ line = [40, 100] }, { line = [0, 100] }"),
                    inner = "{ line = [0, 3] }, { line = [37, 3] }, ", whole = cavity(inner + "{ line = [37, 110] }");
  expect_accepted({
      {outline("{ line = [40, 50] }, { arc = [20, 50], center = [30, 50] }, { line = [20, 100] }, { line = [0, 100] }"),
       "arc_through with a point on the way",
       outline("{ line = [40, 50] }, { arc_through = [30, 60], to = [20, 50] }, { line = [20, 100] }, { line = [0, 100] }")},
      {cavity("{ line = [37, 3] }, { line = [37, 110] }"), "allowed: a first element {line = [0, y]}", whole},
      {cavity(inner + "{ line = [37, 100] }"), "allowed: an end at the mouth's height", whole},
      {cavity(inner + "{ line = [37, 60] }, { line = [36, 50] }, { line = [36, 110] }"), "allowed: elements that rise or are level",
       whole},
      {cavity("{ line = [0, 3] }, { line = [39.99, 3] }, { line = [39.99, 110] }"), "allowed: a wall of at least", whole},
      {outline("{ line = [40, 100] }"), "allowed: a last element {line = [0, y]}", straight},
      {outline("{ line = [40, 0] }, { line = [40, 100] }, { line = [0, 100] }"), "allowed: elements of at least", straight},
      {outline("{ line = [40, 100] }, { line = [0, 100], fillet_mm = 5 }"),
       "allowed: at the end of an element that another element follows",
       outline("{ line = [40, 100], fillet_mm = 5 }, { line = [0, 100] }")},
  });
}

TEST(SceneRemedies, HelpTheRestOfAScene) {
  const std::string tilts = "[tilts]\ndeg = [0, 45]\n", liquid = "[liquid]\nfills = [0, 0.5]\n";
  const std::string
      task = "[task]\ntarget = { place_mm = [0, 0, 0], diameter_mm = 30 }\ndestination_mm = [0, 0, 0]\ntolerance_ml = 1\n",
      filled = VESSEL + "liquid = { name = \"acid\", fill = 0.5 }\n" + liquid;
  const std::vector<Case> cases{
      {"[grips]\ncount = 3\n", "allowed: with sampling = \"sobol\"", "[grips]\ncount = 3\nsampling = \"sobol\"\n"},
      {"[grips]\nheight_mm = 50\nheight_fraction = 0.5\n", "allowed: one of the two", "[grips]\nheight_mm = 50\n"},
      {"[tilts]\ndeg = [45, 0]\n", "allowed: values in ascending order", "[tilts]\ndeg = [0, 45]\n"},
      {"[grips]\nroll_deg = { from = 0, to = -30, count = 2 }\n", "allowed: from <= to",
       "[grips]\nroll_deg = { from = -30, to = 0, count = 2 }\n"},
      {"[grips]\nroll_deg = { from = -30, to = 0, count = 1 }\n", "more otherwise",
       "[grips]\nroll_deg = { from = -30, to = 0, count = 2 }\n"},
      {"[grips]\nroll_deg = { from = 0, to = 0, count = 2 }\n", "allowed: one value where from = to",
       "[grips]\nroll_deg = { from = 0, to = 0, count = 1 }\n"},
      {"[output]\nalso = [\"gap\"]\nkeep = [\"gap\"]\n", "allowed: one of the two", "[output]\nkeep = [\"gap\"]\n"},
      {"[output]\nkeep = [\"gap\", \"gap\"]\n", "allowed: each name once", "[output]\nkeep = [\"gap\"]\n"},
      {"[liquid]\nfills = [0]\nfills_ml = [0]\n", "allowed: one of the two", "[liquid]\nfills_ml = [0]\n"},
      {"[tilts]\ndeg = [0]\nuntil_poured = 0.5\n", "allowed: in a scene with [liquid]",
       "[tilts]\ndeg = [0]\nuntil_poured = 0.5\n" + liquid},
      {"[score]\nfingers = 0\ncontacts = 0\ndepth = 0\nposture = 0\n", "allowed: at least one weight above 0 that counts",
       "[score]\nfingers = 1\ncontacts = 0\ndepth = 0\nposture = 0\n"},
      {"[score]\nfingers = 0\ncontacts = 0\ndepth = 0\nposture = 0\n", "and there are no [tilts]",
       "[score]\nfingers = 0\ncontacts = 0\ndepth = 0\nposture = 0\n" + tilts},
      {"[scene]\nname = \"a/b\"\n", "allowed: a name without '/'", "[scene]\nname = \"ab\"\n"},
      {"[scene]\npsoe = \"paper\"\n", "the nearest known key is 'pose'", "[scene]\npose = \"paper\"\n"},
      {"[strength]\nefforts = false\n[live]\nslide_by = \"hand\"\n", "allowed: slide_by = \"tips\"",
       "[strength]\nefforts = false\n[live]\nslide_by = \"tips\"\n"},
      {"[strength]\nefforts = false\n[live]\nslide_by = \"hand\"\n", "or efforts",
       "[strength]\nefforts = true\n[live]\nslide_by = \"hand\"\n"},
      {"[device]\ngap_mm = [20, 10]\n", "closed less than open", "[device]\ngap_mm = [10, 20]\n"},
      {"[device]\naxes = [\"-x\", \"y\", \"z\"]\n", "allowed: axes with one '-' more or less",
       "[device]\naxes = [\"x\", \"y\", \"z\"]\n"},
  };
  std::vector<Case> whole;
  for (const Case& each : cases) whole.push_back({each.text + VESSEL, each.words, each.mended + VESSEL});
  whole.push_back({filled + task + "amounts_ml = { acdi = 5 }\n", "the nearest liquid is 'acid'",
                   filled + task + "amounts_ml = { acid = 5 }\n"});
  expect_accepted(whole);
}

}  // namespace
}  // namespace wholehand
