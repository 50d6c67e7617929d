// SPDX-License-Identifier: MIT
#include "sweeps/result/heat_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "base/text/error.h"
#include "tests/support/fake_backend.h"

namespace wholehand::sweeps {
namespace {

// The map of a scene's first vessel, gathered in chunks of `chunk`.
HeatMap gathered(const Scene& scene, std::size_t chunk) {
  const Plan plan(scene, false);
  FakeBackend backend(scene, make_field_set({FIELD_SCORE, FIELD_STATUS}, scene), Precision::full, chunk);
  HeatMap map(plan);
  RunRequest request;
  request.last = plan.grips();
  request.grips = [&](std::size_t v, std::uint64_t first, std::size_t count, GripInput* out) { plan.fill(v, first, count, out); };
  request.sink = [&](const PlaneChunk& c) { map.add(plan, c, backend.fields()); };
  backend.run(request);
  return map;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
  }
  return true;
}

TEST(HeatMap, HoldsTheLargestScoreOfEveryCell) {
  const Scene scene = fake_scene();
  const Plan plan(scene, false);
  const HeatMap map = gathered(scene, 37);
  ASSERT_EQ(map.heights().cells(), 7u);
  ASSERT_EQ(map.rolls().cells(), 4u);
  std::map<std::pair<double, double>, double> expected;
  for (std::uint64_t i = 0; i < plan.grips(); ++i) {
    const GripInput grip = plan.grip(0, i);
    if ((fake_uint(0, grip, FIELD_STATUS) & STATUS_REASON_MASK) != 0) continue;
    double& best = expected[{grip.height, grip.roll}];
    best = std::max(best, fake_real(0, grip, FIELD_SCORE, 0));
  }
  for (std::size_t h = 0; h < 7; ++h) {
    for (std::size_t r = 0; r < 4; ++r) {
      const auto cell = expected.find({scene.grips.height.values[h] * 0.11, scene.grips.roll.values[r]});
      if (cell == expected.end()) {
        EXPECT_TRUE(std::isnan(map.score(h, r)));
      } else {
        EXPECT_EQ(map.score(h, r), cell->second) << h << ", " << r;
      }
    }
  }
}

TEST(HeatMap, ChunksDoNotMatter) { EXPECT_TRUE(same(gathered(fake_scene(), 1).scores(), gathered(fake_scene(), 1000).scores())); }

TEST(HeatMap, InfeasibleCellsHaveNoScore) {
  Scene scene = fake_scene();
  scene.grips.azimuth.values = scene.grips.obliquity.values = scene.grips.offset.values = {0};
  const HeatMap map = gathered(scene, 100);  // one grip a cell: a fifth of them infeasible
  const auto missing = std::count_if(map.scores().begin(), map.scores().end(), [](double score) { return std::isnan(score); });
  EXPECT_GT(missing, 0);
  EXPECT_LT(missing, 14);
}

// Cells that no point fell into would look like grips that are not feasible.
TEST(HeatMap, EveryCellOfASobolRangeIsSampled) {
  for (const std::uint64_t count : {1u, 10u, 100u, 500u, 4096u, 20000u}) {
    Scene scene = fake_scene();
    scene.grips.sampling = Sampling::sobol;
    scene.grips.count = count;
    scene.grips.height = scene.grips.roll = range_axis(0.1, 0.9, 2);
    const Plan plan(scene, false);
    const HeatMap map(plan);
    std::set<std::pair<std::size_t, std::size_t>> sampled;
    std::vector<double> heights(count), rolls(count);
    plan.coordinates(PLACE_HEIGHT, 0, count, heights.data());
    plan.coordinates(PLACE_ROLL, 0, count, rolls.data());
    for (std::size_t i = 0; i < count; ++i) sampled.insert({map.heights().cell(heights[i]), map.rolls().cell(rolls[i])});
    EXPECT_EQ(sampled.size(), map.heights().cells() * map.rolls().cells()) << count << " points";
    EXPECT_LE(map.heights().cells(), MapAxis::LARGEST_SOBOL);
  }
}

MapAxis map_axis(const Axis& axis) { return {PlanAxis("roll", "rad", "", AXIS_ROLL, axis, false), 0}; }

TEST(HeatMap, CellsOfAGridAreBoundedHalfwayBetweenItsValues) {
  const MapAxis map = map_axis({{30, -90, 0}});  // in any order
  ASSERT_EQ(map.cells(), 3u);
  EXPECT_EQ(map.edge(0), -135);
  EXPECT_EQ(map.edge(1), -45);
  EXPECT_EQ(map.edge(2), 15);
  EXPECT_EQ(map.edge(3), 45);
  EXPECT_EQ(map.cell(-90), 0u);
  EXPECT_EQ(map.cell(0), 1u);
  EXPECT_EQ(map.cell(30), 2u);
  EXPECT_EQ(map.cell(-1000), 0u);
  EXPECT_EQ(map.cell(1000), 2u);
}

TEST(HeatMap, OneValueHasACellOfSomeWidth) {
  for (const double value : {0.0, 0.5, -2.0}) {
    const MapAxis map = map_axis({{value}});
    ASSERT_EQ(map.cells(), 1u);
    EXPECT_LT(map.edge(0), value);
    EXPECT_GT(map.edge(1), value);
    EXPECT_EQ(map.cell(value), 0u);
  }
}

TEST(HeatMap, ManyValuesShareCells) {
  const Axis axis = range_axis(0, 1, 1000);
  const MapAxis map = map_axis(axis);
  ASSERT_EQ(map.cells(), MapAxis::LARGEST_MAP);
  std::vector<int> values(map.cells());
  for (const double value : axis.values) ++values[map.cell(value)];
  for (const int count : values) EXPECT_TRUE(count == 7 || count == 8) << count;
}

TEST(HeatMap, SobolRangesAreCutEvenly) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 64 * 64 * 16;
  scene.grips.roll = range_axis(radians(30), radians(-90), 2);  // falling
  const HeatMap map = gathered(scene, 5000);
  EXPECT_EQ(map.heights().cells(), 64u);
  EXPECT_EQ(map.rolls().cells(), 64u);
  EXPECT_DOUBLE_EQ(map.rolls().edge(0), radians(-90));
  EXPECT_DOUBLE_EQ(map.rolls().edge(64), radians(30));
  for (const double score : map.scores()) EXPECT_FALSE(std::isnan(score)) << "sixteen points a cell, one in five infeasible";
}

TEST(HeatMap, GoesOnWhereItStood) {
  const HeatMap map = gathered(fake_scene(), 100);
  HeatMap other{Plan(fake_scene(), false)};
  other.restore(map.scores());
  EXPECT_TRUE(same(other.scores(), map.scores()));
  EXPECT_THROW(other.restore({1, 2, 3}), Error);
}

TEST(HeatMap, TakesWhatOthersFound) {
  const HeatMap map = gathered(fake_scene(), 100);
  HeatMap other{Plan(fake_scene(), false)};
  for (int times = 0; times < 2; ++times)  // twice is as once
    for (std::size_t cell = 0; cell < map.scores().size(); ++cell)
      if (!std::isnan(map.scores()[cell])) other.raise(cell, map.scores()[cell]);
  EXPECT_TRUE(same(other.scores(), map.scores()));
  for (std::size_t cell = 0; cell < map.scores().size(); ++cell)  // less than what is there changes nothing
    if (!std::isnan(map.scores()[cell])) other.raise(cell, -1);
  EXPECT_TRUE(same(other.scores(), map.scores()));
  EXPECT_THROW(other.raise(map.scores().size(), 1), std::out_of_range);
}

}  // namespace
}  // namespace wholehand::sweeps
