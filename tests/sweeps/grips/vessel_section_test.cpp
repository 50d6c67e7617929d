// SPDX-License-Identifier: MIT
// The picture of a surveyed mesh: walls, inner outline, and the liquid that fills half of it, to scale.
#include "sweeps/grips/vessel_section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/vessel_models.h"
#include "tests/support/xml.h"

namespace wholehand::sweeps {
namespace {

using Points = std::vector<std::array<double, 2>>;  // units, y upward

constexpr double WRITTEN = 0.005;  // units: coordinates have two digits

// A path of lines: its loops.
std::vector<Points> loops_of(std::string text) {
  for (char& c : text)
    if (c == 'L') c = ' ';
  std::vector<Points> loops;
  std::istringstream loop_texts(text);
  for (std::string loop; std::getline(loop_texts, loop, 'M');) {
    if (loop.empty()) continue;
    std::istringstream numbers(loop);
    Points& points = loops.emplace_back();
    for (double x = 0, y = 0; numbers >> x >> y;) points.push_back({x, -y});
  }
  return loops;
}

// The paths of a picture in their order.
std::vector<std::vector<Points>> paths_of(const std::string& svg) {
  const std::string mark = "<path d=\"";
  std::vector<std::vector<Points>> paths;
  for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + 1)) {
    const std::size_t from = at + mark.size();
    paths.push_back(loops_of(svg.substr(from, svg.find('"', from) - from)));
  }
  return paths;
}

struct Box {
  double left = INFINITY, right = -INFINITY, low = INFINITY, high = -INFINITY;
};

Box box_of(const std::vector<Points>& loops) {
  Box box;
  for (const Points& loop : loops)
    for (const auto& [x, y] : loop) {
      box.left = std::min(box.left, x);
      box.right = std::max(box.right, x);
      box.low = std::min(box.low, y);
      box.high = std::max(box.high, y);
    }
  return box;
}

// What the right half of a loop that is drawn on both sides encloses when it turns about its middle: its volume, and the area of its surface with the
// level one on top.
struct Turned {
  double volume = 0, area = 0, top = 0;
};

Turned turn(const Points& both, double middle) {
  Turned turned;
  const std::size_t count = both.size() / 2;
  for (std::size_t k = 1; k < count; ++k) {
    const double a = both[k - 1][0] - middle, b = both[k][0] - middle, rise = both[k][1] - both[k - 1][1];
    turned.volume += PI / 3 * (a * a + a * b + b * b) * rise;
    turned.area += PI * (a + b) * std::hypot(b - a, rise);
  }
  const double rim = both[count - 1][0] - middle;
  turned.area += PI * rim * rim;
  turned.top = both[count - 1][1];
  return turned;
}

MeshSurvey survey_of(const std::string& name) {
  const TemporaryFolder folder;
  SurveyRequest request;
  request.file = folder / "cup.stl";
  request.scale = 1;
  write_file(request.file, stl_text(vessel_model(name).mesh));
  return survey_mesh(request);
}

TEST(VesselSection, ShowsWallsOutlineAndHalfOfTheLiquid) {
  for (const char* name : {"straight_mug", "mug_with_handle", "wine_glass", "erlenmeyer_flask"}) {
    SCOPED_TRACE(name);
    const MeshSurvey survey = survey_of(name);
    ASSERT_TRUE(survey.cavity.cavity.has_value()) << survey.cavity.refusal;
    const std::string svg = vessel_section(survey, "A & B");
    expect_well_formed(svg);
    EXPECT_NE(svg.find("A &amp; B"), std::string::npos);
    const auto paths = paths_of(svg);
    ASSERT_EQ(paths.size(), 3u);
    const auto &walls = paths[0], &liquid = paths[1], &outline = paths[2];
    ASSERT_EQ(liquid.size(), 1u);
    ASSERT_EQ(outline.size(), 1u);

    // to scale
    const Box wall = box_of(walls), inner = box_of(outline), wet = box_of(liquid);
    const MeshFacts& facts = survey.mesh.facts;
    const double scale = (wall.high - wall.low) / (facts.high[1] - facts.low[1]);  // units per m
    const auto height = [&](double y) { return wall.low + scale * (y - facts.low[1]); };
    const FoundCavity& cavity = *survey.cavity.cavity;
    EXPECT_NEAR(inner.high, height(cavity.brim), 3 * WRITTEN);
    EXPECT_NEAR(wet.low, inner.low, 2 * WRITTEN) << "the floor";
    EXPECT_TRUE(inner.left > wall.left && inner.right < wall.right && inner.low > wall.low) << "within the walls";
    const double middle = (inner.left + inner.right) / 2;
    EXPECT_NEAR((wet.left + wet.right) / 2, middle, 2 * WRITTEN);

    // half of what the outline holds, below a level surface
    const Turned whole = turn(outline[0], middle), filled = turn(liquid[0], middle);
    // digits move a surface by up to WRITTEN across and along, and the middle by as much
    const double off = 2 * std::sqrt(2.0) * WRITTEN;
    EXPECT_NEAR(filled.volume, whole.volume / 2, off * (filled.area + whole.area / 2));
    EXPECT_NEAR(filled.top, wet.high, 1e-12);
    EXPECT_LT(wet.high, inner.high);
    // arcs in chords that lie within 0.02 mm
    EXPECT_NEAR(whole.volume, cavity.outline.volume * std::pow(scale, 3),
                (off + 0.02e-3 * scale) * whole.area + whole.volume * 6 * WRITTEN / (wall.high - wall.low));
  }
}

TEST(VesselSection, ShowsTheHandle) {
  const MeshSurvey survey = survey_of("mug_with_handle");
  const auto walls = paths_of(vessel_section(survey, "mug"))[0];
  const Box wall = box_of(walls);
  const MeshFacts& facts = survey.mesh.facts;
  const double scale = (wall.high - wall.low) / (facts.high[1] - facts.low[1]);
  EXPECT_EQ(walls.size(), 2u) << "mug and handle";
  EXPECT_NEAR(wall.right - wall.left, scale * (facts.high[0] - facts.low[0]), 4 * WRITTEN) << "along x, where the handle is";
  for (const Points& loop : walls) EXPECT_EQ(loop.front(), loop.back());
}

TEST(VesselSection, AMeshWithoutCavityShowsItsWallsOnly) {
  const MeshSurvey survey = survey_of("solid_hull");
  ASSERT_FALSE(survey.cavity.cavity.has_value());
  const std::string svg = vessel_section(survey, "<\"&'\x01>");
  expect_well_formed(svg);
  const auto paths = paths_of(svg);
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].size(), 1u);
  EXPECT_EQ(svg.find("half full"), std::string::npos);
}

}  // namespace
}  // namespace wholehand::sweeps
