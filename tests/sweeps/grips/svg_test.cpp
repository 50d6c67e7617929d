// SPDX-License-Identifier: MIT
// A grip as a line drawing: well-formed, to scale, and every view shows what it should.
// sanitizers: address
#include "sweeps/grips/svg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "base/text/error.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitized.h"
#include "tests/support/scenes.h"
#include "tests/support/xml.h"

namespace wholehand::sweeps {
namespace {

GripReport report_of(const Scene& scene, std::size_t vessel, const GripInput& grip) {
  return make_grip_report(scene, vessel, grip, scene_axes(scene, vessel),
                          core_grip_methods(scene, make_core_evaluator(scene), "core"));
}

std::string drawn(const Scene& scene, std::size_t vessel, const GripInput& grip) {
  return grip_svg(scene, vessel, report_of(scene, vessel, grip));
}

std::string group(const std::string& svg, const std::string& id) {
  const std::size_t from = svg.find("<g id=\"" + id + "\">");
  EXPECT_NE(from, std::string::npos) << id;
  return svg.substr(from, svg.find("</g>", from) - from);
}

int count(const std::string& text, const std::string& part) {
  int times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
  return times;
}

// Ends of the first line of a class within a group.
std::array<double, 4> line_in(const std::string& text, const std::string& style) {
  std::smatch match;
  const std::regex line("class=\"" + style + "\" d=\"M([-0-9.]+) ([-0-9.]+)L([-0-9.]+) ([-0-9.]+)\"");
  EXPECT_TRUE(std::regex_search(text, match, line)) << text;
  std::array<double, 4> ends{};
  for (int k = 0; k < 4; ++k) ends[k] = std::stod(match[k + 1]);
  return ends;
}

const GripInput BESIDE{0.0585, 0, 0.1, 0.38, 0, 1};

TEST(GripSvg, IsWellFormedForEveryVesselAndRoll) {
  const Scene scene = three_beakers();
  int drawings = 0;
  for (std::size_t v = 0; v < 3; ++v) {
    for (const double roll : {-90, -30, 0, 22}) {
      const GripReport report = report_of(scene, v, {0.05, 0.4, -0.1, radians(roll), 0.001, 1});
      if (report.answer.result.reason != Reason::none) continue;
      expect_well_formed(grip_svg(scene, v, report));
      ++drawings;
    }
  }
  EXPECT_GE(drawings, 9);
}

TEST(GripSvg, HasTheWordsOfAScreenReader) {
  Scene scene = three_beakers();
  scene.vessels[0].name = "a <b> & \"c\"\x01\xff";
  const std::string svg = drawn(scene, 0, BESIDE);
  expect_well_formed(svg);
  EXPECT_NE(svg.find("<title id=\"title\">Grip of a &lt;b&gt; &amp; &quot;c&quot;\uFFFD\uFFFD</title>"), std::string::npos);
  EXPECT_NE(svg.find("aria-labelledby=\"title desc\""), std::string::npos);
  EXPECT_NE(svg.find("80 mm wide and 110 mm high, between thumb and index finger 58.5 mm above its base"), std::string::npos);
  EXPECT_NE(svg.find("The thumb touches with 1 of its 4 points."), std::string::npos) << svg.substr(0, 1500);
}

// One unit is a millimeter, and the views agree with one another: the thumb-index line is as long as it is seen.
TEST(GripSvg, ViewsAreToScale) {
  for (const Handedness handedness : {Handedness::right, Handedness::left}) {
    Scene scene = three_beakers();
    scene.hand.handedness = handedness;
    const double sign = handedness == Handedness::right ? 1 : -1;
    for (const double azimuth : {0.0, 2.5}) {
      GripInput grip = BESIDE;
      grip.azimuth = azimuth;
      const GripReport report = report_of(scene, 0, grip);
      const std::string svg = grip_svg(scene, 0, report);
      const double gap = report.answer.result.gap * 1e3, level = gap * std::cos(0.1), rise = gap * std::sin(0.1);
      const auto front = line_in(group(svg, "front"), "axis"), side = line_in(group(svg, "side"), "axis"),
                 top = line_in(group(svg, "top"), "axis");
      // mm; two decimals at either end. A left hand's index is on the left.
      EXPECT_NEAR(front[2] - front[0], sign * level, 0.011);
      EXPECT_NEAR(front[3] - front[1], -rise, 0.011);
      EXPECT_NEAR(side[2] - side[0], 0, 0.011);
      EXPECT_NEAR(side[3] - side[1], -rise, 0.011);
      EXPECT_NEAR(top[2] - top[0], sign * level, 0.011);
      EXPECT_NEAR(top[3] - top[1], 0, 0.011);
      EXPECT_NEAR(front[1], side[1], 0.011);  // side by side
      EXPECT_NEAR(front[0], top[0], 0.011);   // above one another
      const auto bar = line_in(group(svg, "legend"), "measure");
      EXPECT_NEAR(bar[2] - bar[0], 50, 0.011);
      EXPECT_EQ(count(svg, ">80 mm<") + count(svg, ">110 mm<"), 2);
    }
  }
}

// The outline of a bone's rounded cone is that of two discs: lines that touch both.
TEST(GripSvg, BonesAreTheOutlinesOfRoundedCones) {
  Scene scene = three_beakers();
  for (FingerData& finger : scene.hand.fingers) finger.radii = {9e-3, 8e-3, 6.5e-3, 7e-3, 5e-3};
  scene.hand.fingers[0].radii = {10e-3, 9e-3, 6e-3, 7e-3, 0};
  const std::string svg = drawn(scene, 0, BESIDE), n = "([-0-9.]+)", p = n + " " + n, arc = "A" + p + " 0 ([01]) 0 " + p;
  const std::regex run("class=\"flesh\" d=\"([^\"]*)\"/>\n<path class=\"bone\" d=\"([^\"]*)\""), point("[ML]" + p);
  const std::regex shape("M[^M]*Z"), hull("M" + p + "L" + p + arc + "L" + p + arc + "Z");
  int bones = 0;
  for (std::sregex_iterator found(svg.begin(), svg.end(), run), end; found != end; ++found) {
    const std::string shapes = (*found)[1], line = (*found)[2];
    std::vector<glm::dvec2> joints;
    for (std::sregex_iterator at(line.begin(), line.end(), point); at != end; ++at)
      joints.push_back({std::stod((*at)[1]), std::stod((*at)[2])});
    std::size_t k = 0;
    for (std::sregex_iterator at(shapes.begin(), shapes.end(), shape); at != end; ++at, ++k) {
      const std::string text = (*at)[0];
      std::smatch part;
      ASSERT_LT(k + 1, joints.size());
      if (!std::regex_match(text, part, hull)) continue;  // along the view: one disc covers the other
      ++bones;
      const auto pair = [&](std::size_t first) { return glm::dvec2(std::stod(part[first]), std::stod(part[first + 1])); };
      const glm::dvec2 a = joints[k], b = joints[k + 1];
      const glm::dvec2 starts[] = {pair(1), pair(10)}, ends[] = {pair(3), pair(8)};
      const double far = std::stod(part[5]), near = std::stod(part[12]), length = glm::length(b - a);
      // two decimals: each place is up to 0.0071 mm off, a difference of two twice as much
      constexpr double ROUNDED = 0.0142 + 0.005;
      for (int side = 0; side < 2; ++side) {
        const glm::dvec2 touched = starts[side] - a;
        EXPECT_NEAR(glm::length(touched), near, ROUNDED) << text;
        EXPECT_NEAR(glm::length(ends[side] - b), far, ROUNDED) << text;
        EXPECT_NEAR(glm::dot(ends[side] - starts[side], touched) / near, 0, ROUNDED * (1 + length / near)) << text;
      }
      EXPECT_GT(glm::length(starts[0] - starts[1]), near) << "one on either side";
    }
    EXPECT_EQ(k + 1, joints.size());
  }
  EXPECT_GT(bones, 40);
}

// Whatever is held, the sheet fits on a page and its letters are 8 points.
TEST(GripSvg, FitsOnAPage) {
  for (const double height_mm : {30.0, 110.0, 3000.0}) {
    const Scene scene = scene_of({cylinder("v", 60, height_mm, 1)});
    const std::string svg = drawn(scene, 0, {0.01, 0, 0, 0, 0, 1});
    std::smatch match;
    ASSERT_TRUE(std::regex_search(svg, match, std::regex("width=\"([0-9.]+)mm\" height=\"([0-9.]+)mm\" viewBox=\"0 0 ([0-9.]+) ")));
    const double width = std::stod(match[1]), height = std::stod(match[2]), unit = std::stod(match[3]) / width;
    EXPECT_LE(width, 180.01) << height_mm;
    EXPECT_LE(height, 250.01) << height_mm;
    EXPECT_TRUE(width > 179.9 || height > 249.9) << height_mm;
    ASSERT_TRUE(std::regex_search(svg, match, std::regex("font-size: ([0-9.]+)px")));
    EXPECT_NEAR(std::stod(match[1]) / unit, 2.8, 0.02) << height_mm;
  }
}

// The hand is also on the left in the side view: the mouth leans away from it to the right.
TEST(GripSvg, TheHandIsInFrontInTheFrontView) {
  const Scene scene = three_beakers();
  const std::string svg = drawn(scene, 0, {0.0585, 0.7, 0, 0.38, 0, 1});
  const std::string front = group(svg, "front"), side = group(svg, "side");
  const std::size_t glass = front.find("class=\"glass\"");
  EXPECT_GT(count(front.substr(glass), "class=\"bone\""), 3);
  std::smatch match;
  ASSERT_TRUE(std::regex_search(side, match, std::regex("class=\"glass\" d=\"M([-0-9.]+) ")));
  const double axis = std::stod(match[1]);
  std::vector<double> free;
  const std::regex circle("class=\"free\" cx=\"([-0-9.]+)\"");
  for (std::sregex_iterator it(side.begin(), side.end(), circle), end; it != end; ++it) free.push_back(std::stod((*it)[1]));
  ASSERT_GT(free.size(), 10u);
  double sum = 0;
  for (const double x : free) sum += x;
  EXPECT_LT(sum / static_cast<double>(free.size()), axis - 20);  // mm: the hand is longer than the glass is wide
}

// From above, what rests on a cone is seen, and what is under a sphere's belly is not.
TEST(GripSvg, FromAboveOnlyWhatIsUnderTheGlassIsBehindIt) {
  const Scene scene = three_beakers();
  const auto before_glass = [&](std::size_t vessel, double height, const char* mark) {
    const std::string top = group(drawn(scene, vessel, {height, 0, 0, 0, 0, 1}), "top");
    return count(top.substr(0, top.find("class=\"glass\"")), mark);
  };
  EXPECT_EQ(before_glass(2, 0.06, "class=\"touching\""), 0);
  EXPECT_EQ(before_glass(1, 0.06, "class=\"touching\""), 0);
  EXPECT_EQ(before_glass(1, 0.025, "class=\"projected\""), 2);  // the middle finger, brought up to the base
}

TEST(GripSvg, EveryPointHasItsMark) {
  const Scene scene = three_beakers();
  const GripReport report = report_of(scene, 0, BESIDE);
  const std::string svg = grip_svg(scene, 0, report);
  const GripResult& result = report.answer.result;
  int projected = 0, touching = 0;
  for (int j = 0; j < JOINT_COUNT; ++j) {
    const bool is_projected = ((result.tip_mask | result.finger_mask | result.inner_mask) >> j & 1) != 0;
    projected += is_projected;
    touching += !is_projected && (result.touch_mask >> j & 1) != 0;
  }
  ASSERT_GT(projected, 0);
  for (const char* view : {"front", "side", "top"}) {
    std::map<std::string, int> marks;  // by place: a joint where the glass comes between two bones is drawn with both
    const std::string text = group(svg, view);
    const std::regex mark("class=\"(touching|projected|free)\" [^/]*/");
    std::map<std::string, int> states;
    for (std::sregex_iterator it(text.begin(), text.end(), mark), end; it != end; ++it) {
      if (marks[it->str()]++ == 0) ++states[(*it)[1]];
    }
    EXPECT_EQ(states["projected"], projected) << view;
    EXPECT_EQ(states["touching"], touching) << view;
    EXPECT_EQ(states["free"], JOINT_COUNT - projected - touching) << view;
  }
}

// A finger is named where its tip is seen, and nowhere else.
TEST(GripSvg, TipsThatAreSeenHaveInitials) {
  const Scene scene = three_beakers();
  const std::string svg = drawn(scene, 0, {0.0585, 0, 0, 0.38, 0, 1});
  const auto initials = [&](const char* view) {
    std::string found;
    const std::string text = group(svg, view);
    const std::regex initial("class=\"initial\"[^>]*>([A-Z])<");
    for (std::sregex_iterator it(text.begin(), text.end(), initial), end; it != end; ++it) found += (*it)[1];
    std::sort(found.begin(), found.end());
    return found;
  };
  EXPECT_EQ(initials("front"), "IT");   // the others are behind their own fingers, the little finger behind all
  EXPECT_EQ(initials("side"), "ILMR");  // the thumb is behind the index finger
  EXPECT_EQ(initials("top"), "ILMT");   // the ring finger is under the middle finger
}

// The half outline of a flask is drawn by its own arcs.
TEST(GripSvg, ArcsOfTheOutlineStayArcs) {
  const Scene scene = three_beakers();
  const std::string front = group(drawn(scene, 1, {0.06, 0, 0, 0, 0, 1}), "front");
  EXPECT_GE(count(front, "A42.50 42.50 0 0 0 "), 2);  // anticlockwise up the right side, and down the left
  EXPECT_EQ(count(front, "A42.50 42.50 0 0 1 "), 0);
}

// The scene's first vessel as a mesh, drawn with the grip that the outline gives.
std::string drawn_as(Scene scene, const VesselData& mesh, const GripInput& grip) {
  const GripReport report = report_of(scene, 0, grip);
  scene.vessels[0] = mesh;
  return grip_svg(scene, 0, report);
}

// Least and largest of all coordinates in the paths of a class within a group: x, y.
std::array<double, 4> reach_of(const std::string& text, const std::string& style) {
  std::array<double, 4> reach{1e9, -1e9, 1e9, -1e9};
  const std::regex path("class=\"" + style + "\" d=\"([^\"]*)\""), point("(-?[0-9.]+) (-?[0-9.]+)");
  for (std::sregex_iterator p(text.begin(), text.end(), path), end; p != end; ++p) {
    const std::string places = (*p)[1];
    for (std::sregex_iterator it(places.begin(), places.end(), point); it != end; ++it) {
      const double x = std::stod((*it)[1]), y = std::stod((*it)[2]);
      reach = {std::min(reach[0], x), std::max(reach[1], x), std::min(reach[2], y), std::max(reach[3], y)};
    }
  }
  return reach;
}

TEST(GripSvg, AMeshVesselIsDrawnByItsLines) {
  const VesselData mesh = vessel_of_mesh("mesh", turned_mesh(beaker1(), 64, 2e-3), 0);
  const std::string svg = drawn_as(three_beakers(), mesh, BESIDE);
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "class=\"glass\""), 0);
  EXPECT_EQ(count(svg, "class=\"inner\""), 0);
  for (const char* view : {"front", "side", "top"}) {
    const std::string text = group(svg, view);
    EXPECT_EQ(count(text, "class=\"body\""), 1) << view;
    EXPECT_EQ(count(text, "class=\"contour\""), 1) << view;
    EXPECT_EQ(count(text, "class=\"edge\""), 0) << view;
    const auto contour = reach_of(text, "contour"), body = reach_of(text, "body");
    EXPECT_NEAR(contour[1] - contour[0], 80, 0.02) << view;  // 64 corners round: one lies across; two decimals
    EXPECT_NEAR(contour[3] - contour[2], view == std::string("top") ? 80 : 110, 0.02) << view;
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(body[k], contour[k], 0.3) << view;  // a pixel is 0.1 mm of paper, some 0.2 mm here
  }
  // as the outline's: measures, words, and where the hand is
  const std::string outline = drawn(three_beakers(), 0, BESIDE);
  EXPECT_EQ(count(svg, ">80 mm<") + count(svg, ">110 mm<"), 2);
  EXPECT_NE(svg.find("80 mm wide and 110 mm high, between thumb and index finger 58.5 mm above its base"), std::string::npos);
  for (const char* view : {"front", "side", "top"}) {
    const std::string a = group(svg, view), b = group(outline, view);
    EXPECT_EQ(line_in(a, "axis"), line_in(b, "axis"));
    EXPECT_EQ(count(a.substr(0, a.find("class=\"body\"")), "class=\"bone\""),
              count(b.substr(0, b.find("class=\"glass\"")), "class=\"bone\""))
        << view;
  }
}

TEST(GripSvg, AMeshVesselIsMeasuredWhereItIs) {
  const VesselData mesh = vessel_of_mesh("mesh", placed_mesh(box_mesh({-0.03, 0, -0.04}, {0.05, 0.1, 0.04}), {}, {0, 0.02, 0}), 0);
  const std::string svg = drawn_as(three_beakers(), mesh, {0.0585, 0, 0, 0.38, 0, 1});
  EXPECT_NE(svg.find("80 mm wide and 100 mm high, between thumb and index finger 38.5 mm above its base"), std::string::npos);
  const std::string front = group(svg, "front");
  const auto contour = reach_of(front, "contour"), axis = line_in(front, "axis");
  const auto measure = reach_of(svg, "measure");
  EXPECT_NEAR(contour[1] - contour[0], 80, 0.02);
  EXPECT_NEAR(contour[3] - contour[2], 100, 0.02);
  EXPECT_NEAR(contour[3] - axis[1], 38.5, 0.02);  // the base is 20 mm up
  EXPECT_LE(measure[0], contour[0] + 0.02);
}

// A ring is seen through, and what is sharp is drawn across.
TEST(GripSvg, HolesAndEdgesOfAMesh) {
  TriangleMesh ring = torus(0.035, 0.012, 96, 32);
  for (Triple& p : ring.vertices) p = {p[0], p[2] + 0.047, -p[1]};
  const VesselData rings = vessel_of_mesh("ring", ring, 0);
  const std::string front = group(drawn_as(three_beakers(), rings, {0.0585, 0, 0, 0.38, 0, 1}), "front");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(front, match, std::regex("class=\"body\" d=\"([^\"]*)\"")));
  EXPECT_EQ(count(match[1], "M"), 2);
  EXPECT_EQ(count(match[1], "Z"), 2);
  const VesselData box = vessel_of_mesh("box", placed_mesh(box_mesh({-0.03, 0, -0.03}, {0.03, 0.1, 0.03}), {0, 0.6, 0}, {}), 0);
  const std::string boxed = drawn_as(three_beakers(), box, {0.0585, 0, 0, 0.38, 0, 1});
  EXPECT_EQ(count(group(boxed, "front"), "class=\"edge\""), 1);
  EXPECT_EQ(count(group(boxed, "top"), "class=\"edge\""), 0);
}

TEST(GripSvg, TheCavityOfAMeshIsDashed) {
  VesselData mesh = vessel_of_mesh("mesh", turned_mesh(beaker1(), 48, 4e-3), 0);
  mesh.inner = {line_to(0, 1.5), line_to(38.5, 1.5), line_to(38.5, 110)};
  const std::string svg = drawn_as(three_beakers(), mesh, BESIDE), outline = drawn(three_beakers(), 0, BESIDE);
  expect_well_formed(svg);
  for (const char* view : {"front", "side", "top"})
    EXPECT_EQ(count(group(svg, view), "class=\"inner\""), count(group(outline, view), "class=\"inner\"")) << view;
}

// 82,000 triangles, nearly all of whose edges are sharp.
TEST(GripSvg, AFineMeshMakesNoLargeFile) {
  TriangleMesh crumpled = icosphere(0.045, IS_SANITIZED ? 5 : 6);
  Random random(14);
  for (Triple& p : crumpled.vertices) {
    const double factor = random.uniform(0.95, 1.05);
    for (double& x : p) x *= factor;
    p[1] += 0.05;
  }
  const std::string svg = drawn_as(three_beakers(), vessel_of_mesh("stone", crumpled, 0), BESIDE);
  EXPECT_LT(svg.size(), 1'000'000u);
  EXPECT_GT(svg.size(), 100'000u);
  expect_well_formed(svg);
}

TEST(GripSvg, AMeshThatHasNotBeenReadIsRefused) {
  VesselData unread = vessel_of_mesh("unread", box_mesh({-0.03, 0, -0.03}, {0.03, 0.1, 0.03}), 0);
  unread.mesh->body.reset();
  EXPECT_THROW(drawn_as(three_beakers(), unread, BESIDE), Error);
}

TEST(GripSvg, NothingToDraw) {
  const Scene scene = three_beakers();
  const GripReport report = report_of(scene, 0, {0.3, 0, 0, 0, 0, 1});
  try {
    grip_svg(scene, 0, report);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_EQ(std::string(error.what()).rfind("--svg: ", 0), 0u) << error.what();
  }
}

}  // namespace
}  // namespace wholehand::sweeps
