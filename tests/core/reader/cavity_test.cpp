// SPDX-License-Identifier: MIT
// What a vessel of a scene file holds: wall_mm with floor_mm, inner outlines, and volumes of liquid.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/capacity.h"
#include "core/evaluator.h"
#include "core/outline_points.h"
#include "core/planes.h"
#include "core/reader/shipped.h"
#include "sweeps/grips/glass.h"
#include "sweeps/plan/cavity_notes.h"
#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

// 80 x 110 mm; the keys that follow say what it holds.
std::string cylinder_with(const std::string& keys) {
  return "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\n" + keys + "\n";
}

// A foot of 35, a stem of 5 up to a bowl: a sphere of 40 about [0, 120], open at 140. The keys say what it holds.
std::string wine_glass(const std::string& keys) {
  const double meets = 120 - std::sqrt(40.0 * 40 - 25), mouth = std::sqrt(40.0 * 40 - 400);
  return fmt::format(
      "[[vessel]]\nname = \"wine\"\noutline = [{{ line = [35, 0] }}, {{ line = [35, 3] }}, {{ line = [5, 6] }}, {{ line = [5, "
      "{0:.12f}] "
      "}}, {{ arc = [{1:.12f}, 140], center = [0, 120] }}, {{ line = [0, 140] }}]\n{2}\n",
      meets, mouth, keys);
}

const std::string BOWL = fmt::format(
    "inner_outline = [{{ line = [0, 82] }}, {{ arc = [38, 120], center = [0, 120] }}, {{ arc = [{:.12f}, 140], center = [0, 120] "
    "}}]",
    std::sqrt(38.0 * 38 - 400));

// Volume of a ball of radius r between two levels from its middle, mm3.
double segment(double r, double low, double high) {
  return PI * (r * r * (high - low) - (high * high * high - low * low * low) / 3);
}

double frustum(double a, double b, double height) { return PI * height / 3 * (a * a + a * b + b * b); }

TEST(SceneCavity, FloorIsAsThickAsItSays) {
  const Scene scene = scene_from(cylinder_with("wall_mm = 2\nfloor_mm = 10"));
  EXPECT_EQ(scene.vessels[0].floor, 10e-3);
  EXPECT_NEAR(capacity_of(scene.vessels[0]), PI * 38 * 38 * 100 * 1e-9, 1e-15);  // rounding of 4.5e-4
  const auto core = make_core_evaluator(scene);
  EXPECT_NEAR(core->empty_mass(0), 2230 * PI * (40 * 40 * 110 - 38 * 38 * 100) * 1e-9, 1e-12);
  // at the wall's own floor it changes nothing
  EXPECT_EQ(capacity_of(scene_from(cylinder_with("wall_mm = 2\nfloor_mm = 2")).vessels[0]),
            capacity_of(scene_from(cylinder_with("wall_mm = 2")).vessels[0]));
}

TEST(SceneCavity, FloorCutsARoundBottom) {
  // the inner wall is a ball of 38 about the same middle, but in the last millimeter, where the rim's edge at [a, 140] is the
  // nearest: with s from the mouth down r = a - (4 - s^2)^(1/2)
  const Scene scene = scene_from(wine_glass("wall_mm = 2\nfloor_mm = 85"));
  const double a = std::sqrt(40.0 * 40 - 400);
  const double rim = PI * (a * a - 2 * a * (std::sqrt(3.0) / 2 + PI / 3) + 4 - 1.0 / 3);
  EXPECT_NEAR(capacity_of(scene.vessels[0]), (segment(38, -35, 19) + rim) * 1e-9, 1e-14);
}

TEST(SceneCavity, InnerOutlineIsWhatItHolds) {
  const Scene scene = scene_from(wine_glass(BOWL) + "[liquid]\nfills = [0.5]\n");
  const VesselData& vessel = scene.vessels[0];
  EXPECT_NEAR(vessel.wall, 2e-3, 1e-9);  // its thinnest place: two spheres about one middle, in 12 digits of a millimeter
  const double held = segment(38, -38, 20) * 1e-9;
  EXPECT_NEAR(capacity_of(vessel), held, 1e-14);
  const auto core = make_core_evaluator(scene);
  EXPECT_NEAR(core->capacity(0), held, 1e-14);
  const double below = std::sqrt(40.0 * 40 - 25);
  const double outer = PI * 35 * 35 * 3 + frustum(35, 5, 3) + PI * 25 * (120 - below - 6) + segment(40, -below, 20);
  EXPECT_NEAR(core->empty_mass(0), 2230 * (outer * 1e-9 - held), 1e-11);
}

TEST(SceneCavity, AShellHasTheInnerOutlineForItsWall) {
  const auto core = make_core_evaluator(scene_from(wine_glass("surface = \"shell\"\n" + BOWL)));
  EXPECT_NEAR(core->distance(0, {0, 120e-3, 0}), 38e-3, 1e-12);  // the middle of the bowl, and of its spheres
  EXPECT_NEAR(core->distance(0, {0, 60e-3, 0}), -5e-3, 1e-12);   // the stem is solid
  EXPECT_NEAR(core->distance(0, {39e-3 * 0.8, 120e-3 - 39e-3 * 0.6, 0}), -1e-3, 1e-9);  // half way through the wall
  EXPECT_NEAR(make_core_evaluator(scene_from(wine_glass(BOWL)))->distance(0, {0, 120e-3, 0}), -20e-3, 1e-12)
      << "solid to the mouth";
}

TEST(SceneCavity, InnerOutlineOfAShape) {
  const Scene scene = scene_from(cylinder_with("inner_outline = [{ line = [0, 25] }, { line = [30, 25] }, { line = [36, 110] }]"));
  EXPECT_NEAR(capacity_of(scene.vessels[0]), frustum(30, 36, 85) * 1e-9, 1e-15);
  EXPECT_NEAR(scene.vessels[0].wall, 4e-3, 1e-12);
}

// The cavity is kept as r over y: its level elements are left out and must be drawn all the same.
TEST(SceneCavity, ALevelLedgeIsDrawn) {
  const Scene scene = scene_from(cylinder_with(
      "inner_outline = [{ line = [0, 6] }, { line = [20, 6] }, { line = [20, 30] }, { line = [36, 30] }, { line = [36, 110] }]"));
  const std::vector<PreparedElement> cavity = prepare_vessel(scene.vessels[0], true).cavity;
  const auto points = outline_points(cavity, cavity.size(), ARC_STEP);
  const std::vector<std::array<double, 2>> corners{{20, 6}, {20, 30}, {36, 30}, {36, 110}};
  ASSERT_EQ(points.size(), corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    EXPECT_NEAR(points[k][0], 1e-3 * corners[k][0], 1e-12) << k;
    EXPECT_NEAR(points[k][1], 1e-3 * corners[k][1], 1e-12) << k;
  }
  std::string svg;
  const sweeps::DrawnView front{"front", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}, nullptr};
  sweeps::DrawnGlass(scene.vessels[0]).draw(svg, front);
  for (const double side : {-1.0, 1.0}) {
    std::string path = "class=\"inner\" d=\"M" + sweeps::point_text({0, -6});
    for (const auto& [r, y] : corners) path += "L" + sweeps::point_text({side * r, -y});
    EXPECT_NE(svg.find(path + "\""), std::string::npos) << svg;
  }
}

TEST(SceneCavity, RefusesWhatIsNoCavity) {
  const auto refused = [](const std::string& keys, const std::string& gist) { expect_refusal(cylinder_with(keys), gist); };
  refused("floor_mm = @10", "floor_mm without wall_mm");
  refused("wall_mm = 2\nfloor_mm = @110", "allowed: less than the vessel's height, 110 mm");
  refused("wall_mm = 2\nfloor_mm = @0", "allowed: 0.05 to 10000");
  refused("wall_mm = @2\ninner_outline = [{ line = [0, 5] }, { line = [36, 110] }]", "both wall_mm and inner_outline are given");
  refused("inner_outline = [{ line = [0, 5] }, { line = [36, 5] }, @{ line = [36, 100] }]",
          "the inner outline ends at [36, 100], and the mouth is at y = 110");
  refused("inner_outline = [@{ line = [0, -5] }, { line = [36, 110] }]", "begins at [0, -5], outside of the vessel");
  refused("inner_outline = [@{ line = [0, 110] }, { line = [36, 120] }]", "begins at [0, 110], outside of the vessel");
  refused("inner_outline = [{ line = [0, 5] }, @{ line = [41, 50] }, { line = [36, 110] }]",
          "between [0, 5] and [41, 50] meets the outline on the element of line 3, column 9; allowed: a wall of at least 0.05 mm");
  refused("inner_outline = [{ line = [0, 0.04] }, @{ line = [36, 0.04] }, { line = [36, 110] }]", "leaves a wall of 0.04 mm");
  refused("inner_outline = [{ line = [0, 5] }, { line = [36, 5] }, @{ arc = [36, 110], center = [4, 57.5] }]", "meets the outline");
  refused("inner_outline = [{ line = [0, 5] }, { line = [36, 5] }, @{ line = [0, 50] }, { line = [36, 110] }]",
          "the inner outline comes back to the axis at [0, 50]; allowed: one cavity");
  refused("inner_outline = [{ line = [0, 5] }, { line = [4, 42] }, @{ arc = [4, 58], center = [10, 50] }, { line = [36, 110] }]",
          "the inner outline comes back to the axis at [0, 50]");
  refused("surface = @\"shell\"\nmass_kg = 1\ncenter_of_mass_mm = [0, 50, 0]", "allowed: with 'wall_mm' or 'inner_outline'");
  EXPECT_EQ(refusal_of(cylinder_with("inner_outline = [{ line = [0, 0.05] }, { line = [39.95, 0.05] }, { line = [39.95, 110] }]")),
            "accepted");
}

TEST(SceneCavity, FloorWithinTheWallIsRefused) {
  for (const std::string& text : {cylinder_with("wall_mm = 5\nfloor_mm = 3"), wine_glass("wall_mm = 5.5\nfloor_mm = 1")}) {
    const Scene scene = scene_from(text);
    try {
      capacity_of(scene.vessels[0]);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("the wall fills the vessel up to "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(" mm; floor_mm = "), std::string::npos) << error.what();
    }
  }
  EXPECT_NEAR(capacity_of(scene_from(wine_glass("wall_mm = 5.5\nfloor_mm = 90")).vessels[0]) * 1e9, segment(34.5, -30, 20), 400)
      << "above the solid stem; the rim's edge is the nearest near the mouth";
}

TEST(SceneCavity, SaysWhereLiquidWouldStandInAStem) {
  const Scene scene = scene_from(wine_glass("wall_mm = 2"));
  const auto narrow = narrow_place(scene.vessels[0], 10e-3);
  ASSERT_TRUE(narrow);
  EXPECT_NEAR(narrow->radius, 3e-3, 1e-12);
  EXPECT_LT(narrow->beneath, 0.05 * capacity_of(scene.vessels[0]));
  EXPECT_GT(narrow->beneath, 0);
  const auto notes = sweeps::cavity_notes(scene);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("vessel 'wine': its cavity narrows to a radius of 3 mm at "), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find("'floor_mm' or 'inner_outline'"), std::string::npos);
  EXPECT_EQ(notes[0].find('\n'), std::string::npos);
  const auto inner = sweeps::cavity_notes(scene_from(
      cylinder_with("inner_outline = [{ line = [0, 10] }, { line = [30, 10] }, { line = [4, 50] }, { line = [30, 110] }]")));
  ASSERT_EQ(inner.size(), 1u);
  EXPECT_NE(inner[0].find("belongs there, let 'inner_outline' begin above this height"), std::string::npos) << inner[0];
  for (const std::string& keys : {std::string("wall_mm = 2\nfloor_mm = 85"), BOWL})
    EXPECT_TRUE(sweeps::cavity_notes(scene_from(wine_glass(keys))).empty()) << keys;
  for (const char* shipped : {"three_beakers", "mixing_board", "paper_pose", "small"})
    EXPECT_TRUE(sweeps::cavity_notes(read_scene_file(find_scene(shipped))).empty()) << shipped;
}

TEST(SceneCavity, ANarrowPlaceIsWiderOnBothSides) {
  const auto narrow_of = [](const std::string& inner) {
    return narrow_place(scene_from(cylinder_with("inner_outline = [" + inner + "]")).vessels[0], 10e-3);
  };
  // two cones, tip to tip at 50: the lower one lies beneath
  const auto waist = narrow_of("{ line = [0, 10] }, { line = [30, 10] }, { line = [4, 50] }, { line = [30, 110] }");
  ASSERT_TRUE(waist);
  EXPECT_NEAR(waist->radius, 4e-3, 1e-15);
  EXPECT_NEAR(waist->height, 50e-3, 1e-15);
  EXPECT_NEAR(waist->beneath, frustum(30, 4, 40) * 1e-9, 1e-15);
  // an arc whose narrowest place lies between its ends: half of the ring's section beneath
  const auto round =
      narrow_of("{ line = [0, 10] }, { line = [20, 40] }, { arc = [20, 70], center = [24, 55] }, { line = [30, 110] }");
  ASSERT_TRUE(round);
  EXPECT_NEAR(round->height, 55e-3, 1e-12);
  EXPECT_NEAR(round->radius, (24 - std::hypot(4, 15)) * 1e-3, 1e-12);
  EXPECT_FALSE(narrow_of("{ line = [0, 10] }, { line = [30, 10] }, { line = [11, 50] }, { line = [30, 110] }")) << "wide enough";
  EXPECT_FALSE(narrow_of("{ line = [0, 10] }, { line = [30, 10] }, { line = [4, 110] }")) << "a bottle's neck";
  EXPECT_FALSE(narrow_of("{ line = [0, 10] }, { line = [4, 10] }, { line = [30, 110] }")) << "a funnel";
}

// ---- volumes ----

const std::string TWO_VESSELS =
    "[[vessel]]\nname = \"wide\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 2\n"
    "[[vessel]]\nname = \"slim\"\nshape = \"cylinder\"\ndiameter_mm = 44\nheight_mm = 102\nwall_mm = 2\n";

TEST(SceneFills, VolumesAreFractionsOfEachVessel) {
  const Scene scene = scene_from("[liquid]\nfills_ml = [0, 50, 125.5]\n[tilts]\ndeg = [0]\n" + TWO_VESSELS);
  EXPECT_TRUE(scene.liquid->fills.empty());
  EXPECT_EQ(scene_fills(scene), 3u);
  const auto core = make_core_evaluator(scene);
  for (std::size_t v = 0; v < 2; ++v) {
    const std::vector<double>& fills = vessel_fills(scene, scene.vessels[v]);
    ASSERT_EQ(fills.size(), 3u);
    for (std::size_t f = 0; f < 3; ++f)
      EXPECT_NEAR(core->liquid(v, fills[f], 0).volume, scene.liquid->volumes[f], 1e-16) << v << ", " << f;
  }
  EXPECT_NE(vessel_fills(scene, scene.vessels[0])[1], vessel_fills(scene, scene.vessels[1])[1]);
  const Scene fractions = scene_from("[liquid]\nfills = [0, 0.5]\n" + TWO_VESSELS);
  EXPECT_EQ(vessel_fills(fractions, fractions.vessels[1]), (std::vector<double>{0, 0.5}));
}

TEST(SceneFills, MoreThanAVesselHoldsIsRefused) {
  // pi x 20^2 x 100 mm3
  expect_refusal("[liquid]\nfills_ml = [0, 50, @125.7]\n" + TWO_VESSELS,
                 "fills_ml: 125.7: vessel 'slim' holds 125.663 mL; allowed: 0 to this volume");
  EXPECT_EQ(refusal_of("[liquid]\nfills_ml = [125.663]\n" + TWO_VESSELS), "accepted");
  expect_refusal("[liquid]\nfills = [0]\nfills_ml = @[1]\n" + TWO_VESSELS, "both fills_ml and fills are given");
  expect_refusal("[liquid]\nfills_ml = [2, @1]\n" + TWO_VESSELS, "allowed: values in ascending order");
  expect_refusal("[liquid]\nfills_ml = [@-1]\n" + TWO_VESSELS, "allowed: 0 to");
}

TEST(SceneFills, WhatTheMessageAllowsIsAllowed) {
  // pi x 249^2 x 391 mm3 = 76159.7175 mL: rounded to seven digits it would be more
  const auto of_vat = [](const std::string& volume) {
    return refusal_of("[liquid]\nfills_ml = [" + volume +
                      "]\n[[vessel]]\nname = \"vat\"\nshape = \"cylinder\"\ndiameter_mm = 500\nheight_mm = 392\nwall_mm = 1\n");
  };
  EXPECT_NE(of_vat("80000").find("holds 76159.717 mL; allowed: 0 to this volume"), std::string::npos) << of_vat("80000");
  EXPECT_EQ(of_vat("76159.717"), "accepted");
}

TEST(SceneFills, AVesselsOwnLiquidMayBeAVolume) {
  const std::string vessel = "[liquid]\nfills = [0]\n" + TWO_VESSELS + "liquid = { name = \"water\", ";
  EXPECT_NEAR(scene_from(vessel + "fill_ml = 62.8 }\n").vessels[1].liquid_fill * PI * 400 * 100, 62.8e3, 1e-9);
  expect_refusal(vessel + "fill_ml = @126 }\n", "vessel 'slim' holds 125.663 mL");
  expect_refusal(vessel + "fill = 0.5, fill_ml = @1 }\n", "both fill_ml and fill are given");
}

}  // namespace
}  // namespace wholehand
