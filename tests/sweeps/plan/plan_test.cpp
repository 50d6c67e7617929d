// SPDX-License-Identifier: MIT
#include "sweeps/plan/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/text/error.h"
#include "base/text/text.h"
#include "core/reader/reader.h"
#include "shaders/layout.h"
#include "tests/support/fake_backend.h"
#include "tests/support/refusal.h"

namespace wholehand::sweeps {
namespace {

std::vector<GripInput> grips(const Plan& plan, std::size_t vessel, std::uint64_t first, std::size_t count) {
  std::vector<GripInput> out(count);
  plan.fill(vessel, first, count, out.data());
  return out;
}

bool same(const GripInput& a, const GripInput& b) {
  return a.height == b.height && a.azimuth == b.azimuth && a.obliquity == b.obliquity && a.roll == b.roll && a.offset == b.offset &&
         a.hand_scale == b.hand_scale;
}

std::string refusal(const Scene& scene, double bytes, double free, ExitCode code = ExitCode::usage) {
  return refusal_line([&] { check_sweep_size(scene, sweep_size(scene, bytes), free); }, code);
}

TEST(Plan, GridCountsWithAzimuthSlowestAndHeightFastest) {
  const Scene scene = fake_scene();
  const Plan plan(scene, true);
  ASSERT_EQ(plan.grips(), 3u * 7 * 5 * 4 * 2);
  EXPECT_EQ(plan.copies(), 1u);
  std::uint64_t index = 0;
  const GripsData& g = scene.grips;
  for (const double azimuth : g.azimuth.values)
    for (const double obliquity : g.obliquity.values)
      for (const double roll : g.roll.values)
        for (const double offset : g.offset.values)
          for (const double height : g.height.values) {
            const GripInput expected{height * 0.14, azimuth, obliquity, roll, offset, 1};
            EXPECT_TRUE(same(plan.grip(1, index), expected)) << index;
            ++index;
          }
}

TEST(Plan, AnyRangeIsThatPartOfTheWhole) {
  for (const Sampling sampling : {Sampling::grid, Sampling::sobol}) {
    Scene scene = fake_scene();
    scene.grips.sampling = sampling;
    scene.grips.count = 777;
    const Plan plan(scene, true);
    const auto all = grips(plan, 0, 0, plan.grips());
    for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{255}, std::size_t{300}, all.size() - 1}) {
      const auto part = grips(plan, 0, first, all.size() - first);
      for (std::size_t i = 0; i < part.size(); ++i) ASSERT_TRUE(same(part[i], all[first + i])) << first << " + " << i;
    }
  }
}

TEST(Plan, CoordinatesAreTheAxesOfTheGrips) {
  for (const Sampling sampling : {Sampling::grid, Sampling::sobol}) {
    Scene scene = fake_scene();
    scene.grips.sampling = sampling;
    scene.grips.count = 600;
    const Plan plan(scene, true);
    const auto all = grips(plan, 0, 0, plan.grips());
    std::vector<double> height(all.size()), roll(all.size());
    plan.coordinates(PLACE_HEIGHT, 0, all.size(), height.data());
    plan.coordinates(PLACE_ROLL, 0, all.size(), roll.data());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(height[i] * 0.11, all[i].height);
      EXPECT_EQ(roll[i], all[i].roll);
    }
  }
}

TEST(Plan, AbsoluteHeightsDoNotDependOnTheVessel) {
  Scene scene = fake_scene();
  scene.grips.height_is_fraction = false;
  const Plan plan(scene, true);
  EXPECT_EQ(plan.grip(0, 0).height, 0.1);
  EXPECT_EQ(plan.grip(1, 0).height, 0.1);
  EXPECT_EQ(plan.axes()[PLACE_HEIGHT].name, "height");
  EXPECT_EQ(plan.axes()[PLACE_HEIGHT].units, "m");
}

TEST(Plan, FractionsCountFromTheLowestPoint) {
  Scene scene = fake_scene();
  scene.vessels[1].base = -0.02;
  scene.vessels[1].height = 0.08;
  const Plan plan(scene, true);
  std::vector<double> fraction(plan.grips());
  plan.coordinates(PLACE_HEIGHT, 0, fraction.size(), fraction.data());
  for (std::uint64_t i = 0; i < plan.grips(); ++i) EXPECT_EQ(plan.grip(1, i).height, -0.02 + fraction[i] * 0.1);
}

TEST(Plan, AzimuthIsLeftOutWhereNothingDependsOnIt) {
  Scene scene = fake_scene();
  const Plan plan(scene, false);
  EXPECT_EQ(plan.copies(), 3u);
  EXPECT_EQ(plan.grips(), 7u * 5 * 4 * 2);
  EXPECT_EQ(plan.stored_grips(), 3u * 7 * 5 * 4 * 2);
  for (const GripInput& grip : grips(plan, 0, 0, plan.grips())) EXPECT_EQ(grip.azimuth, 0);

  EXPECT_EQ(Plan(scene, true).copies(), 1u) << "a kept vector turns with the azimuth";
  scene.vessels[1].mass = 0.2;
  scene.vessels[1].center_of_mass = {0, 0.05, 0};
  EXPECT_EQ(Plan(scene, false).copies(), 3u) << "a given mass on the axis";
  scene.vessels[1].center_of_mass = {0, 0.05, 1e-3};
  EXPECT_EQ(Plan(scene, false).copies(), 1u) << "a center of mass off the axis";
  scene.vessels[1].mass.reset();
  scene.vessels[1].mesh = MeshData{};
  EXPECT_EQ(Plan(scene, false).copies(), 1u) << "a mesh";
}

TEST(Plan, SobolFillsRangesPicksFromListsAndKeepsNumbers) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 1024;
  scene.grips.height.values = {0.4};
  scene.grips.height.is_range = false;
  scene.grips.offset.values = {1e-3, 2e-3, 3e-3, 4e-3};
  const Plan plan(scene, false);
  EXPECT_EQ(plan.copies(), 1u);
  ASSERT_EQ(plan.grips(), 1024u);
  std::vector<int> offsets(5), rolls(16);
  for (const GripInput& grip : grips(plan, 0, 0, 1024)) {
    EXPECT_EQ(grip.height, 0.4 * 0.11);
    ++offsets[std::lround(grip.offset * 1e3)];
    EXPECT_GT(grip.roll, radians(-90));
    EXPECT_LT(grip.roll, radians(30));
    ++rolls[static_cast<int>((grip.roll - radians(-90)) / radians(120) * 16)];
  }
  EXPECT_EQ(offsets, (std::vector<int>{0, 256, 256, 256, 256}));
  for (const int count : rolls) EXPECT_EQ(count, 64);
}

// Three values of an axis, ascending, in the unit of its key and in SI.
struct AxisValues {
  const char* key;
  int place;
  std::array<const char*, 3> written;
  std::array<double, 3> read;
};

const AxisValues AXES[] = {
    {"height_mm", PLACE_HEIGHT, {"20", "30", "50"}, {0.02, 0.03, 0.05}},
    {"height_fraction", PLACE_HEIGHT, {"0.25", "0.5", "0.75"}, {0.25, 0.5, 0.75}},
    {"azimuth_deg", PLACE_AZIMUTH, {"20", "45", "90"}, {radians(20), radians(45), radians(90)}},
    {"obliquity_deg", PLACE_OBLIQUITY, {"-20", "5", "10"}, {radians(-20), radians(5), radians(10)}},
    {"roll_deg", PLACE_ROLL, {"-90", "-30", "0"}, {radians(-90), radians(-30), radians(0)}},
    {"offset_mm", PLACE_OFFSET, {"-5", "2", "3"}, {-5e-3, 2e-3, 3e-3}},
    {"hand_scale", PLACE_HAND_SCALE, {"0.75", "1", "1.25"}, {0.75, 1, 1.25}},
};

// The values of the grips along each axis, of a scene with one vessel and these lines in [grips].
std::array<std::vector<double>, 6> gripped(const std::string& lines, bool is_mesh, bool is_sobol) {
  const Scene scene = parse_scene(
      fmt::format("[[vessel]]\nname = \"v\"\n{}density_kg_m3 = 2500\n[grips]\n{}{}\n",
                  is_mesh ? "mesh = \"v.obj\"\n" : "shape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 110\nwall_mm = 2\n",
                  is_sobol ? "sampling = \"sobol\"\ncount = 256\n" : "", lines),
      "axes.toml");
  const Plan plan(scene, true);
  std::array<std::vector<double>, 6> values;
  for (int place = 0; place < 6; ++place) {
    values[place].resize(plan.grips());
    plan.coordinates(place, 0, values[place].size(), values[place].data());
    const auto [low, high] = std::minmax_element(values[place].begin(), values[place].end());
    EXPECT_GE(*low, plan.axes()[place].low);
    EXPECT_LE(*high, plan.axes()[place].high);
    EXPECT_EQ(plan.varies(place), *low < *high) << lines << " place " << place;
  }
  return values;
}

std::vector<double> distinct(const std::vector<double>& values) {
  const std::set<double> each(values.begin(), values.end());
  return {each.begin(), each.end()};
}

// All of `values` lie from low to high, and between any two of 16 equal parts.
void expect_filled(const std::vector<double>& values, double low, double high) {
  std::set<int> parts;
  for (const double value : values) {
    EXPECT_GE(value, low);
    EXPECT_LE(value, high);
    parts.insert(static_cast<int>(16 * (value - low) / (high - low)));
  }
  EXPECT_EQ(parts.size(), 16u);
}

TEST(Plan, AnyAxisHasTheValuesThatTheSceneAsksFor) {
  for (const bool is_mesh : {false, true})
    for (const bool is_sobol : {false, true})
      for (const AxisValues& axis : AXES) {
        const auto& [a, b, c] = axis.written;
        SCOPED_TRACE(fmt::format("{}, mesh {}, sobol {}", axis.key, is_mesh, is_sobol));
        const auto along = [&](const std::string& form) {
          return gripped(fmt::format("{} = {}", axis.key, form), is_mesh, is_sobol)[axis.place];
        };
        EXPECT_EQ(distinct(along(b)), std::vector<double>{axis.read[1]});
        EXPECT_EQ(distinct(along(fmt::format("[{}]", c))), std::vector<double>{axis.read[2]});
        EXPECT_EQ(distinct(along(fmt::format("[{}, {}, {}]", c, a, b))), std::vector<double>(axis.read.begin(), axis.read.end()));
        const std::vector<double> range = along(fmt::format("{{ from = {}, to = {}, count = 5 }}", a, c));
        if (!is_sobol) {
          const std::vector<double> steps = distinct(range);
          ASSERT_EQ(steps.size(), 5u);
          for (int k = 0; k < 5; ++k) EXPECT_NEAR(steps[k], axis.read[0] + (axis.read[2] - axis.read[0]) * k / 4, 1e-15);
          continue;
        }
        expect_filled(range, axis.read[0], axis.read[2]);
        EXPECT_EQ(along(fmt::format("{{ from = {}, to = {} }}", a, c)), range);
        EXPECT_EQ(distinct(along(fmt::format("{{ from = {0}, to = {0} }}", b))), std::vector<double>{axis.read[1]});
      }
}

TEST(Plan, OnlyTheAzimuthOfAMeshGoesRoundWhereTheSceneSaysNothing) {
  for (const bool is_mesh : {false, true})
    for (const bool is_sobol : {false, true}) {
      const auto values = gripped("", is_mesh, is_sobol);
      for (int place = 0; place < 6; ++place) {
        const std::vector<double> each = distinct(values[place]);
        if (place != PLACE_AZIMUTH || !is_mesh) {
          EXPECT_EQ(each.size(), 1u) << place;
        } else if (is_sobol) {
          expect_filled(each, 0, 2 * PI);
        } else {
          ASSERT_EQ(each.size(), 24u);
          for (int k = 0; k < 24; ++k) EXPECT_NEAR(each[k], radians(15 * k), 1e-15);
        }
      }
    }
}

TEST(Plan, OpeningAnAxisLeavesTheOthersAsTheyWere) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 100;
  scene.grips.hand_scale.values = {1};
  const auto before = grips(Plan(scene, false), 0, 0, 100);
  scene.grips.hand_scale = range_axis(0.8, 1.2, 2);
  const auto after = grips(Plan(scene, false), 0, 0, 100);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(before[i].height, after[i].height);
    EXPECT_EQ(before[i].azimuth, after[i].azimuth);
    EXPECT_EQ(before[i].roll, after[i].roll);
    EXPECT_NE(before[i].hand_scale, after[i].hand_scale);
  }
}

TEST(Plan, SeedRepeats) {
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 10;
  scene.grips.seed = 42;
  EXPECT_EQ(Plan(scene, false).grip(0, 9).roll, Plan(scene, false).grip(0, 9).roll);
  const double roll = Plan(scene, false).grip(0, 9).roll;
  scene.grips.seed = 43;
  EXPECT_NE(Plan(scene, false).grip(0, 9).roll, roll);
}

TEST(Plan, TooManyGripsAreRefusedWithTheSizes) {
  Scene scene = fake_scene();
  scene.vessels.resize(1);
  scene.grips.azimuth = scene.grips.obliquity = scene.grips.roll = scene.grips.offset = range_axis(0, 1, 1000);
  scene.grips.height.values = {0.5};
  const std::string line = refusal(scene, 200, 1e30);
  EXPECT_NE(line.find("1.0e+12 grips"), std::string::npos) << line;
  EXPECT_NE(line.find("8.0e+12 states"), std::string::npos) << line;
  EXPECT_NE(line.find("200 TB"), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_THROW(Plan(scene, false), Error);
}

TEST(Plan, CountsThatOverflowIntegersAreRefused) {
  Scene scene = fake_scene();
  scene.grips.azimuth = scene.grips.height = scene.grips.obliquity = scene.grips.roll = scene.grips.offset =
      scene.grips.hand_scale = range_axis(0, 1, 10000);  // 1e24 a vessel
  EXPECT_NE(refusal(scene, 1e3, 1e300), "");
  EXPECT_THROW(Plan(scene, false), Error);
  scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = ~std::uint64_t{0};
  EXPECT_NE(refusal(scene, 1, 1e300), "");
  scene.grips.count = SOBOL_LARGEST_COUNT + 1;
  EXPECT_THROW(Plan(scene, false), Error) << "more than the sequence has";
  scene.grips.count = SOBOL_LARGEST_COUNT;
  EXPECT_EQ(Plan(scene, false).grips(), SOBOL_LARGEST_COUNT);
  scene.grips.count = 0;
  EXPECT_THROW(Plan(scene, false), Error);
}

TEST(Plan, ResultsThatDoNotFitTheDiskAreRefused) {
  const Scene scene = fake_scene();  // 1,680 grips
  EXPECT_EQ(refusal(scene, 100, 168000), "");
  const std::string line = refusal(scene, 100, 167999, ExitCode::failure);
  EXPECT_NE(line.find("1,680 grips"), std::string::npos) << line;
  EXPECT_NE(line.find("168 kB"), std::string::npos) << line;
}

}  // namespace
}  // namespace wholehand::sweeps
