// SPDX-License-Identifier: MIT
// An outline of few lines and arcs keeps its tolerance, does not fall, and is read back as it was written.
#include "core/meshes/outline_fit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/reader/reader.h"

namespace wholehand {
namespace {

using Points = std::vector<ProfilePoint>;

constexpr double TOLERANCE = 0.1e-3;    // m
constexpr double SAGITTA = 1e-6;        // m, of the chords with which an arc is compared
constexpr double FIT_ROUNDING = 1e-12;  // m: of a circle through three points, whose radius is up to 10 m

// Points along lines between corners, `step` apart at most.
Points divided(const Points& corners, double step) {
  Points points{corners.front()};
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const auto &a = corners[k - 1], &b = corners[k];
    const int steps = static_cast<int>(std::ceil(std::hypot(b[0] - a[0], b[1] - a[1]) / step));
    for (int i = 1; i <= steps; ++i) points.push_back({a[0] + (b[0] - a[0]) * i / steps, a[1] + (b[1] - a[1]) * i / steps});
    points.back() = b;
  }
  return points;
}

// Appends an arc about a center, from angle to angle (degrees).
void add_arc(Points& points, const ProfilePoint& center, double radius, double from, double to, int steps) {
  for (int k = points.empty() ? 0 : 1; k <= steps; ++k) {
    const double angle = radians(from + (to - from) * k / steps);
    points.push_back({center[0] + radius * std::cos(angle), center[1] + radius * std::sin(angle)});
  }
}

double chain_distance(const Points& chain, const ProfilePoint& p) {
  double least = INFINITY;
  for (std::size_t k = 1; k < chain.size(); ++k) least = std::min(least, segment_distance(chain[k - 1], chain[k], p));
  return least;
}

// Whether the elements start and end at points, come within the tolerance of all, and do not fall.
void expect_fit(const Points& points, const std::vector<FittedElement>& elements, double tolerance, const std::string& what) {
  ASSERT_FALSE(elements.empty()) << what;
  EXPECT_EQ(elements.back().end, points.back()) << what;
  auto at = points.begin();
  for (const FittedElement& element : elements) {
    at = std::find(at, points.end(), element.end);
    ASSERT_NE(at, points.end()) << what << ": an end that is no point, or out of order";
  }
  const Points chain = points_along(points.front(), elements, SAGITTA);
  double farthest = 0;
  for (const ProfilePoint& p : points) farthest = std::max(farthest, chain_distance(chain, p));
  EXPECT_LE(farthest, tolerance + SAGITTA + FIT_ROUNDING) << what;
  for (std::size_t k = 1; k < chain.size(); ++k) ASSERT_GE(chain[k][1], chain[k - 1][1] - FIT_ROUNDING) << what << ", chord " << k;
}

TEST(OutlineFit, CornersComeBackAsTheyAre) {
  const Points corners{{0, 0.006}, {0.03, 0.006}, {0.036, 0.05}, {0.02, 0.07}, {0.02, 0.08}, {0.03, 0.1}};
  // also in steps so short that a line could pass a corner within the tolerance
  for (const double step : {1.0, 5e-3, 0.5e-3, 0.02e-3}) {
    const Points points = divided(corners, step);
    const std::vector<FittedElement> elements = fit_outline(points, TOLERANCE);
    ASSERT_EQ(elements.size(), corners.size() - 1) << step;
    for (std::size_t k = 0; k < elements.size(); ++k) {
      EXPECT_FALSE(elements[k].is_arc);
      EXPECT_EQ(elements[k].end, corners[k + 1]);
    }
  }
}

TEST(OutlineFit, ALevelFloorStaysLevel) {
  const std::vector<FittedElement> elements = fit_outline(divided({{0, 0.005}, {0.03, 0.005}, {0.03, 0.09}}, 1e-3), TOLERANCE);
  ASSERT_EQ(elements.size(), 2u);
  EXPECT_EQ(elements[0].end, (ProfilePoint{0.03, 0.005}));
  EXPECT_EQ(elements[1].end, (ProfilePoint{0.03, 0.09}));
}

TEST(OutlineFit, AQuarterArcIsOneArc) {
  constexpr double RADIUS = 0.04;
  for (const int steps : {8, 90, 1000}) {
    Points points;
    add_arc(points, {0, RADIUS}, RADIUS, -90, 0, steps);
    const std::vector<FittedElement> elements = fit_outline(points, TOLERANCE);
    ASSERT_EQ(elements.size(), 1u) << steps;
    EXPECT_TRUE(elements[0].is_arc);
    EXPECT_NEAR(std::hypot(elements[0].through[0], elements[0].through[1] - RADIUS), RADIUS, FIT_ROUNDING);
    expect_fit(points, elements, TOLERANCE, "quarter");
    for (const ProfilePoint& p : points_along(points.front(), elements, SAGITTA))
      EXPECT_NEAR(std::hypot(p[0], p[1] - RADIUS), RADIUS, FIT_ROUNDING);
  }
}

TEST(OutlineFit, AnSIsTwoArcs) {
  Points points;
  add_arc(points, {0, 0.03}, 0.03, -90, 0, 60);
  add_arc(points, {0.06, 0.03}, 0.03, 180, 90, 60);
  const std::vector<FittedElement> elements = fit_outline(points, TOLERANCE);
  ASSERT_EQ(elements.size(), 2u);
  EXPECT_TRUE(elements[0].is_arc && elements[1].is_arc);
  expect_fit(points, elements, TOLERANCE, "S");
}

// A chain that rises and turns by chance, in steps that vary from rough to smooth.
Points random_profile(std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0, 1);
  const int count = 2 + static_cast<int>(300 * share(random));
  const double rough = std::pow(10, -6 + 4 * share(random)), level = share(random) < 0.3 ? 0.3 : 0;  // m; of the steps
  Points points{{0, 0.01 * share(random)}};
  double slope = 0;
  for (int k = 1; k < count; ++k) {
    slope = 0.9 * slope + 2 * (share(random) - 0.5);
    const double rise = share(random) < level ? 0 : 1e-3 * share(random);
    points.push_back({std::max(1e-6, points.back()[0] + 1e-3 * slope + rough * (share(random) - 0.5)), points.back()[1] + rise});
  }
  return points;
}

TEST(OutlineFit, NoRandomProfileIsMissedOrMadeToFall) {
  std::mt19937_64 random(7);
  for (int tries = 0; tries < 150; ++tries) {
    const Points points = random_profile(random);
    for (const double tolerance : {0.03e-3, TOLERANCE, 1e-3})
      expect_fit(points, fit_outline(points, tolerance), tolerance, fmt::format("profile {} to {} mm", tries, 1e3 * tolerance));
  }
}

TEST(OutlineFit, ALooserToleranceTakesNoMoreElements) {
  Points points;
  add_arc(points, {0, 0.04}, 0.04, -90, -10, 200);
  std::size_t before = points.size();
  for (const double tolerance : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    const std::size_t elements = fit_outline(points, tolerance).size();
    EXPECT_LE(elements, before) << tolerance;
    before = elements;
  }
  EXPECT_EQ(before, 1u);
}

// ---- as text ----

Scene scene_of(const ProfilePoint& floor, std::vector<FittedElement> elements) {
  elements.insert(elements.begin(), FittedElement{false, {}, floor});
  return parse_scene("[[vessel]]\nname = \"cup\"\nmesh = \"cup.stl\"\ninner_outline = " + outline_text(elements) + "\n",
                     "cup.toml");
}

TEST(OutlineFit, TheSceneReaderTakesItsText) {
  Points points = divided({{0, 0.006}, {0.012, 0.006}}, 1e-3);
  add_arc(points, {0.012, 0.026}, 0.02, -90, -20, 40);
  points.push_back({0.034, 0.09});
  const std::vector<FittedElement> elements = fit_outline(points, TOLERANCE);
  ASSERT_EQ(std::count_if(elements.begin(), elements.end(), [](const FittedElement& one) { return one.is_arc; }), 1);
  const Scene scene = scene_of(points.front(), elements);
  const std::vector<OutlineElement>& read = scene.vessels.at(0).inner;
  ASSERT_EQ(read.size(), elements.size() + 1);
  constexpr double WRITTEN = 0.5e-6 + 1e-15;  // m: half a micrometer
  for (std::size_t k = 0; k < elements.size(); ++k) {
    EXPECT_NEAR(read[k + 1].end[0], elements[k].end[0], WRITTEN);
    EXPECT_NEAR(read[k + 1].end[1], elements[k].end[1], WRITTEN);
    EXPECT_EQ(read[k + 1].is_arc, elements[k].is_arc);
  }
}

TEST(OutlineFit, TextHasWholeMicrometersAndNoMinusZero) {
  EXPECT_EQ(outline_text({{false, {}, {0, 0.0060004}}, {true, {0.01, 0.02}, {0.0300006, 0.1}}}),
            "[{ line = [0, 6] }, { arc_through = [10, 20], to = [30.001, 100] }]");
  EXPECT_EQ(outline_text({{false, {}, {-1e-9, 0.05}}}), "[{ line = [0, 50] }]");
}

TEST(OutlineFit, RandomOutlinesAreReadBack) {
  std::mt19937_64 random(8);
  int arcs = 0;
  for (int tries = 0; tries < 100; ++tries) {
    Points points = random_profile(random);
    points.push_back({points.back()[0], points.back()[1] + 1e-3});  // the reader wants an outline to end at a mouth
    const std::vector<FittedElement> elements = fit_outline(points, TOLERANCE);
    if (elements.size() > 200) continue;
    for (const FittedElement& one : elements) arcs += one.is_arc;
    EXPECT_NO_THROW(scene_of(points.front(), elements)) << tries << outline_text(elements);
  }
  EXPECT_GT(arcs, 50);
}

}  // namespace
}  // namespace wholehand
