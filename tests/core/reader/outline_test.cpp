// SPDX-License-Identifier: MIT
// Vessels' outlines: shapes that become outlines, and what an outline must hold.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/scene_texts.h"

namespace wholehand {
namespace {

// `elements` after the base; the vessel's outline.
std::string outline_scene(const std::string& elements, const std::string& wall = "1") {
  return "[[vessel]]\nname = \"v\"\nwall_mm = " + wall + "\noutline = [\n" + elements + "\n]\n";
}

// As far apart as they may be at the least, which no two doubles at 50 and 50.001 are.
TEST(SceneOutline, EdgesOfAMicrometerAreLongEnough) {
  const Scene scene = parse_scene(
      "[[vessel]]\nname = \"v\"\nmass_kg = 1\ncenter_of_mass_mm = [0, 0, 0]\noutline = [{ line = [30, 0] }, { line = [30, 50] }, "
      "{ line = [30.001, 50] }, { line = [30.001, 50.001] }, { line = [0, 50.001] }]",
      "test.toml");
  EXPECT_EQ(scene.vessels[0].outline.size(), 5u);
}

TEST(SceneOutline, ShapesBecomeOutlines) {
  const Scene scene = scene_from(R"(
[[vessel]]
name = "cylinder"
shape = "cylinder"
diameter_mm = 80
height_mm = 110
wall_mm = 2
[[vessel]]
name = "flask"
shape = "flask"
diameter_mm = 100
neck_mm = 60
height_mm = 120
wall_mm = 2
[[vessel]]
name = "conical"
shape = "conical"
diameter_mm = 85
upright_mm = 4
neck_mm = 34
shoulder_mm = 105
height_mm = 145
wall_mm = 2
[[vessel]]
name = "cone"
shape = "conical"
diameter_mm = 85
upright_mm = 0
neck_mm = 34
shoulder_mm = 105
height_mm = 145
wall_mm = 2
)");
  using End = std::array<double, 2>;
  const auto& cylinder = scene.vessels[0].outline;
  ASSERT_EQ(cylinder.size(), 3u);
  EXPECT_EQ(cylinder[0].end, (End{40e-3, 0}));
  EXPECT_EQ(cylinder[1].end, (End{40e-3, 110e-3}));
  EXPECT_EQ(cylinder[2].end, (End{0, 110e-3}));
  EXPECT_EQ(cylinder[0].line, 4);
  EXPECT_EQ(cylinder[0].column, 9);
  const auto& flask = scene.vessels[1].outline;  // a 3-4-5 triangle: the sphere of 50 meets the neck of 30 at 50 + 40
  ASSERT_EQ(flask.size(), 3u);
  EXPECT_TRUE(flask[0].is_arc);
  EXPECT_EQ(flask[0].center, (End{0, 50e-3}));
  EXPECT_NEAR(flask[0].end[0], 30e-3, 1e-17);
  EXPECT_NEAR(flask[0].end[1], 90e-3, 1e-16);
  EXPECT_EQ(flask[1].end, (End{30e-3, 120e-3}));
  EXPECT_EQ(flask[2].end, (End{0, 120e-3}));
  const auto& conical = scene.vessels[2].outline;
  ASSERT_EQ(conical.size(), 5u);
  EXPECT_EQ(conical[1].end, (End{42.5e-3, 4e-3}));
  EXPECT_EQ(conical[2].end, (End{17e-3, 105e-3}));
  EXPECT_EQ(conical[3].end, (End{17e-3, 145e-3}));
  EXPECT_EQ(conical[4].end, (End{0, 145e-3}));
  EXPECT_EQ(scene.vessels[3].outline.size(), 4u);
  for (const auto& vessel : scene.vessels) EXPECT_EQ(vessel.height, vessel.outline.back().end[1]);
}

TEST(SceneOutline, ReadsOutlines) {
  const Scene scene = scene_from(outline_scene(R"({ line = [26, 0] },
  { arc = [32, 6], center = [26, 6] },
  { line = [32, 90] },
  { line = [0, 90] })"));
  const auto& outline = scene.vessels[0].outline;
  ASSERT_EQ(outline.size(), 4u);
  EXPECT_FALSE(outline[0].is_arc);
  EXPECT_TRUE(outline[1].is_arc);
  EXPECT_EQ(outline[1].center, (std::array{26e-3, 6e-3}));
  EXPECT_EQ(outline[1].line, 6);
  EXPECT_EQ(outline[1].column, 3);
  EXPECT_EQ(scene.vessels[0].height, 90e-3);
}

TEST(SceneOutline, AcceptsUnusualOutlines) {
  const std::vector<std::string> outlines{
      // a hemisphere that starts level on the axis; a base that is drawn in (y < 0)
      "{ arc = [30, 30], center = [0, 30] }, { line = [0, 30] }",
      "{ line = [20, -3] }, { line = [30, -3] }, { line = [30, 90] }, { line = [0, 90] }",
      // an arc that starts upright on the axis, and a rolled rim that is level with the mouth
      "{ arc = [10, -10], center = [10, 0] }, { line = [30, -10] }, { line = [30, 50] }, { line = [0, 50] }",
      "{ line = [30, 0] }, { line = [30, 90] }, { arc = [28, 92], center = [28, 90] }, { line = [0, 92] }",
      // a waist; a half circle that bulges
      "{ line = [30, 0] }, { arc = [30, 60], center = [90, 30] }, { line = [30, 90] }, { line = [0, 90] }",
      "{ line = [30, 0] }, { arc = [30, 60], center = [30, 30] }, { line = [0, 60] }",
      "{ line = [30, 0] }, { arc = [30, 40], center = [0, 20] }, { line = [0, 40] }",
      // one circle in two arcs
      "{ line = [30, 0] }, { arc = [60, 30], center = [30, 30] }, { arc = [30, 60], center = [30, 30] }, { line = [0, 60] }",
  };
  for (const auto& outline : outlines) EXPECT_EQ(refusal_of(outline_scene(outline)), "accepted") << outline;
}

TEST(SceneOutline, RefusesOutlines) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"@3, {}",
       "an element of outline = 3; allowed: {line = [r, y]}, {arc = [r, y], center = [r, y]} or {arc_through = [r, y], to = [r, "
       "y]}"},
      {"@{ line = [1, 2], arc = [1, 2] }, {}", "has both 'line' and 'arc'"},
      {"@{}, {}", "has none of 'line', 'arc' and 'arc_through'"},
      {"@{ arc = [1, 2] }, {}", "has 'arc' but no 'center'"},
      {"@{ line = [1, 2], center = [0, 0] }, {}", "has 'line' and 'center'"},
      {"@{ arc_through = [1, 2] }, {}", "has 'arc_through' but no 'to'"},
      {"@{ line = [1, 2], to = [1, 2] }, {}", "has 'to' but no 'arc_through'"},
      {"@{ line = [1, 2], arc_through = [1, 2] }, {}", "has 'arc_through' and another form"},
      {"{ line = @[1] }, {}", "line has 1 entries; allowed: [r, y] in mm"},
      {"{ line = @3 }, {}", "line = 3; allowed: [r, y] in mm"},
      {"{ line = [@-1, 0] }, {}", "r of line = -1; allowed: 0 to 5000"},
      {"{ line = [1, @nan] }, {}", "y of line = nan"},
      // open, off the axis, no mouth
      {"{ line = [30, 0] }, @{ line = [30, 90] }", "the outline is open: it ends at [30, 90], off the axis"},
      {"{ line = [30, 0] }, @{ line = [0, 90] }", "the last element, from [30, 0] to [0, 90], is not a level line"},
      {"{ line = [30, 0] }, @{ arc = [0, 30], center = [0, 0] }", "the last element, from [30, 0] to [0, 30], is not a level line"},
      {"@{ line = [0, 30] }, { line = [30, 30] }, { line = [30, 90] }, { line = [0, 90] }",
       "comes back to the axis at [0, 30], before its mouth"},
      {"{ line = [30, 0] }, @{ line = [0, 20] }, { line = [30, 40] }, { line = [0, 40] }", "comes back to the axis at [0, 20]"},
      {"{ line = [5, 0] }, @{ arc = [5, 40], center = [20, 20] }, { line = [30, 40] }, { line = [30, 60] }, { line = [0, 60] }",
       "leaves its half plane: this arc reaches r = -5 at y = 20"},
      // lengths
      {"{ line = [30, 0] }, @{ line = [30, 0] }, { line = [0, 0] }", "an element has no length: from [30, 0] to [30, 0]"},
      {"{ line = [30, 0] }, { line = [30, 90] }, @{ line = [30, 90.0001] }, { line = [0, 90.0001] }",
       "allowed: elements of at least 0.001 mm"},
      // arcs
      {"{ line = [30, 0] }, { arc = [30, 60], center = @[31, 31] }, { line = [0, 60] }", "from the arc's start and"},
      {"{ line = [30, 0] }, @{ arc = [50, 0], center = [40, 0] }, { line = [50, 60] }, { line = [0, 60] }",
       "a half circle from [30, 0] to [50, 0] may pass above or below"},
      // the mouth
      {"{ line = [30, 0] }, @{ line = [40, 95] }, { line = [30, 90] }, { line = [0, 90] }",
       "the outline rises to y = 95, above its mouth at 90"},
      {"{ line = [30, 0] }, { line = [30, 90] }, @{ arc = [26, 90], center = [28, 89.9] }, { line = [0, 90] }",
       "above its mouth at 90"},
      {"@{ line = [30, 0] }, { line = [30, -90] }, { line = [0, -90] }", "the outline rises to y = 0, above its mouth at -90"},
      // crossing and touching
      {"{ line = [40, 0] }, { line = [40, 50] }, { line = [20, 50] }, { line = [20, 20] }, @{ line = [60, 20] }, { line = [60, 90] "
       "}, { line = [0, 90] }",
       "the outline meets itself at [40, 20], on the element of line 5, column 21"},
      {"{ line = [40, 0] }, { line = [40, 50] }, { line = [20, 50] }, @{ line = [30, 0] }, { line = [30, 90] }, { line = [0, 90] }",
       "the outline meets itself at [30, 0]"},
      {"{ line = [40, 0] }, @{ line = [20, 0] }, { line = [20, 90] }, { line = [0, 90] }",
       "the outline meets itself at [20, 0], on the element of line 5, column 1"},
      {"{ line = [40, 0] }, { line = [40, 90] }, @{ line = [40, 20] }, { line = [20, 90] }, { line = [0, 90] }",
       "the outline meets itself at [40, 20]"},
      {"{ line = [40, 0] }, { arc = [40, 60], center = [40, 30] }, @{ line = [70, 30] }, { line = [30, 90] }, { line = [0, 90] }",
       "the outline meets itself at [70, 30]"},
      {"{ line = [30, 0] }, { line = [30, 60] }, { line = [50, 60] }, { line = [50, 20] }, @{ arc = [50, 40], center = [40, 30] }, "
       "{ line = [80, 40] }, { line = [80, 90] }, { line = [0, 90] }",
       "the outline meets itself at"},
  };
  for (const auto& [elements, gist] : cases) {
    expect_refusal(outline_scene(elements), gist);
  }
  expect_refusal("[[vessel]]\nname = \"v\"\nwall_mm = 1\noutline = @[{ line = [1, 0] }]",
                 "outline has 1 entries; allowed: 2 to 1000 entries");
  expect_refusal(outline_scene("{ line = [30, 0] }, { line = [30, 90] }, { line = [0, 90] }", "@30"),
                 "less than the vessel's largest radius, 30 mm");
}

// ---- arcs through a point ----

// The one arc of an outline that begins at [30, 0].
std::vector<OutlineElement> arc_of(const std::string& arc, double mouth) {
  auto outline = scene_from(outline_scene("{ line = [30, 0] }, " + arc + ", { line = [0, " + std::to_string(mouth) + "] }"))
                     .vessels[0]
                     .outline;
  outline.erase(outline.begin());
  outline.pop_back();
  return outline;
}

TEST(SceneOutline, ArcsThroughAPointLieOnTheCircleThroughThree) {
  // a 3-4-5 circle about [27, 40]: 30 - 27 = 3, so r^2 = 1609
  const auto shorter = arc_of("{ arc_through = [67, 37], to = [30, 80] }", 80);
  ASSERT_EQ(shorter.size(), 1u);
  EXPECT_TRUE(shorter[0].is_arc);
  EXPECT_NEAR(shorter[0].center[0], 27e-3, 1e-15);
  EXPECT_NEAR(shorter[0].center[1], 40e-3, 1e-15);
  EXPECT_EQ(shorter[0].end, (std::array{30e-3, 80e-3}));
  // the same circle the other way would leave the half plane
  EXPECT_NE(refusal_of(outline_scene("{ line = [30, 0] }, { arc_through = [-13, 43], to = [30, 80] }, { line = [0, 80] }")),
            "accepted");
}

TEST(SceneOutline, TheArcIsTheOneThroughThePoint) {
  // from [30, 0] to [30, 20] on the circle about [40, 10]: the near side bends in, the far side is the longer way, in two arcs
  const double near = 40 - std::sqrt(200), far = 40 + std::sqrt(200);
  const auto inwards = arc_of("{ arc_through = [" + std::to_string(near) + ", 10], to = [30, 20] }", 20);
  ASSERT_EQ(inwards.size(), 1u);
  const auto around = scene_from(outline_scene("{ line = [30, -10] }, { line = [30, 0] }, { arc_through = [" + std::to_string(far) +
                                               ", 10], to = [30, 20] }, { line = [30, 40] }, { line = [0, 40] }"))
                          .vessels[0]
                          .outline;
  ASSERT_EQ(around.size(), 6u);
  EXPECT_TRUE(around[2].is_arc && around[3].is_arc);
  EXPECT_NEAR(around[2].end[0], far * 1e-3, 1e-9);  // far is rounded to 1e-6 mm above
  EXPECT_NEAR(around[2].end[1], 10e-3, 1e-9);
  EXPECT_NEAR(around[3].center[0], 40e-3, 1e-9);
  EXPECT_EQ(around[3].end, (std::array{30e-3, 20e-3}));
}

TEST(SceneOutline, RefusesArcsThroughNoCircle) {
  const auto refused = [](const std::string& arc, const std::string& gist) {
    expect_refusal(outline_scene("{ line = [30, 0] }, " + arc + ", { line = [0, 60] }"), gist);
  };
  refused("{ arc_through = @[30, 25], to = [30, 60] }", "[30, 0], [30, 25] and [30, 60] lie on one line; allowed: a point beside");
  refused("@{ arc_through = [30, 0], to = [30, 60] }", "two of the points [30, 0], [30, 0] and [30, 60] are the same");
  refused("{ arc_through = @[30.00001, 30], to = [30, 60] }", "the circle through these points has its center at");
  expect_refusal(outline_scene("{ line = [30, 0] }, @{ arc_through = [60, 30], to = [30, 0] }, { line = [0, 0] }"), "are the same");
}

// ---- fillets ----

TEST(SceneOutline, FilletsAreTangentArcs) {
  const auto outline =
      scene_from(outline_scene("{ line = [30, 0], fillet_mm = 6 }, { line = [30, 60], fillet_mm = 2 }, { line = [0, 60] }"))
          .vessels[0]
          .outline;
  ASSERT_EQ(outline.size(), 5u);
  using Pair = std::array<double, 2>;
  const std::vector<Pair> ends{{24, 0}, {30, 6}, {30, 58}, {28, 60}, {0, 60}};
  for (std::size_t i = 0; i < 5; ++i)
    for (const int k : {0, 1}) EXPECT_NEAR(outline[i].end[k], ends[i][k] * 1e-3, 1e-15) << i;
  EXPECT_TRUE(outline[1].is_arc && outline[3].is_arc);
  EXPECT_NEAR(outline[1].center[0], 24e-3, 1e-15);
  EXPECT_NEAR(outline[1].center[1], 6e-3, 1e-15);
  EXPECT_NEAR(outline[3].center[1], 58e-3, 1e-15);
}

TEST(SceneOutline, FilletOfASlantedCornerHasTheClosedForm) {
  // the way turns by 60 degrees: the arc begins 10 tan(30 deg) before the corner
  const auto outline =
      scene_from(outline_scene("{ line = [40, 0], fillet_mm = 10 }, { line = [60, 34.641016151377549] }, { line = [0, "
                               "34.641016151377549] }"))
          .vessels[0]
          .outline;
  const double cut = 10 * std::tan(PI / 6);
  EXPECT_NEAR(outline[0].end[0], (40 - cut) * 1e-3, 1e-15);
  EXPECT_NEAR(outline[1].end[0], (40 + cut / 2) * 1e-3, 1e-15);
  EXPECT_NEAR(outline[1].end[1], cut * std::sqrt(0.75) * 1e-3, 1e-15);
  EXPECT_NEAR(outline[1].center[0], (40 - cut) * 1e-3, 1e-15);
  EXPECT_NEAR(outline[1].center[1], 10e-3, 1e-15);
}

TEST(SceneOutline, FilletsBetweenLinesAndArcsAreTangentToBoth) {
  // a ball of 30 about [0, 40] on a foot of 20: the hollow corner where they meet
  const auto outline =
      scene_from(outline_scene("{ line = [20, 0] }, { line = [20, 17.639320225002103], fillet_mm = 4 }, { arc = [18, 64], "
                               "center = [0, 40] }, { line = [0, 64] }"))
          .vessels[0]
          .outline;
  ASSERT_EQ(outline.size(), 5u);
  const auto& center = outline[2].center;
  EXPECT_NEAR(center[0], 24e-3, 1e-14) << "4 mm outside of the line";
  EXPECT_NEAR(std::hypot(center[0], center[1] - 40e-3), 34e-3, 1e-14) << "4 mm outside of the ball";
  EXPECT_NEAR(outline[2].end[0], center[0] * 30 / 34, 1e-14);
  EXPECT_NEAR(outline[1].end[1], center[1], 1e-14);
}

TEST(SceneOutline, TwoFilletsMayUseUpTheElementBetweenThem) {
  const auto outline = scene_from(
                           "[[vessel]]\nname = \"v\"\nmass_kg = 1\ncenter_of_mass_mm = [0, 0, 0]\noutline = [{ line = [30, 0] }, "
                           "{ line = [30, 60], fillet_mm = 2 }, { line = [26, 60], fillet_mm = 2 }, { line = [26, 50] }, "
                           "{ line = [20, 50] }, { line = [20, 60] }, { line = [0, 60] }]")
                           .vessels[0]
                           .outline;
  ASSERT_EQ(outline.size(), 8u);  // of seven elements one went and two came
  EXPECT_TRUE(outline[2].is_arc && outline[3].is_arc);
  EXPECT_NEAR(outline[2].end[0], 28e-3, 1e-15);
}

TEST(SceneOutline, RefusesFilletsWithTheLargestThatFits) {
  const auto scene = [](const std::string& radius) {
    return outline_scene("{ line = [30, 0], fillet_mm = " + radius + " }, { line = [30, 20] }, { line = [0, 20] }");
  };
  expect_refusal(scene("@20.5"),
                 "fillet_mm = 20.5 at [30, 0]: the fillet is too large for its two elements; allowed: up to 20 there");
  EXPECT_EQ(refusal_of(scene("19.9")), "accepted");
  EXPECT_EQ(refusal_of(scene("20")), "accepted") << "which leaves nothing of the element";
  // and would leave less than an element
  const std::string line = refusal_of(scene("19.9999")), allowed = "allowed: up to ";
  ASSERT_NE(line.find(allowed), std::string::npos) << line;
  const std::string largest = line.substr(line.find(allowed) + allowed.size(), 8);
  EXPECT_EQ(refusal_of(scene(largest.substr(0, largest.find(' ')))), "accepted") << line;
  const auto refused = [](const std::string& elements, const std::string& gist) { expect_refusal(outline_scene(elements), gist); };
  // what the first leaves is all that the second has
  refused("{ line = [30, 0], fillet_mm = 12 }, { line = [30, 20], fillet_mm = @9 }, { line = [0, 20] }", "allowed: up to 8 there");
  refused(
      "{ line = [20, 0] }, { line = [20, 17.639320225002103], fillet_mm = @400 }, { arc = [18, 64], center = [0, 40] }, { line = "
      "[0, 64] }",
      "allowed: up to ");
  refused("{ line = [20, 0], fillet_mm = @3 }, { line = [30, 0] }, { line = [30, 20] }, { line = [0, 20] }",
          "the two elements have the same direction, or opposite directions");
  refused("{ line = [30, 0] }, { line = [30, 20] }, { line = [0, 20], fillet_mm = @3 }", "fillet_mm of the last element");
  refused("{ line = [30, 0], fillet_mm = @0 }, { line = [30, 20] }, { line = [0, 20] }", "allowed: 0.01 to 5000");
  expect_refusal(
      "[[vessel]]\nname = \"v\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\ninner_outline = [{ line = [0, 5], "
      "fillet_mm = @1 }, { line = [30, 5] }, { line = [30, 110] }]",
      "this corner is on the axis");
}

TEST(SceneOutline, TakesThousandElementsAndNoMore) {
  const auto zigzag = [](int teeth) {
    std::string elements = "{ line = [30, 0] }";
    for (int i = 1; i <= teeth; ++i) elements += ", { line = [" + std::to_string(30 + i % 2) + ", " + std::to_string(i) + "] }";
    return outline_scene(elements + ", { line = [0, " + std::to_string(teeth) + "] }");
  };
  EXPECT_EQ(refusal_of(zigzag(998)), "accepted");
  EXPECT_NE(refusal_of(zigzag(999)).find("outline has 1001 entries; allowed: 2 to 1000 entries"), std::string::npos);
}

}  // namespace
}  // namespace wholehand
